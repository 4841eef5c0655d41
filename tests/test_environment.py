"""The environment: compiled code lies in a folder of the user; the lock installs with later releases about."""

import re
from importlib.metadata import distributions
from pathlib import Path

from packaging.requirements import Requirement

from pipeline.environment import CACHE, LOCATORS, use_compiled_cache


def test_compiled_code_gets_a_folder_and_a_locator(tmp_path):
    environment = {"XDG_CACHE_HOME": str(tmp_path)}
    use_compiled_cache(environment)
    assert Path(environment[CACHE]) == tmp_path / "brakechain" / "compiled" and Path(environment[CACHE]).is_dir()
    assert environment[LOCATORS].startswith("pipeline.physics.numerics.compiled_cache.SourceLocator,")


def test_a_folder_of_the_user_is_kept_and_one_that_cannot_be_made_is_left_out(tmp_path):
    environment = {CACHE: "mine", LOCATORS: "InTreeCacheLocator"}
    use_compiled_cache(environment)
    assert environment == {CACHE: "mine", LOCATORS: "InTreeCacheLocator"}
    (tmp_path / "file").write_text("")
    blocked = {"XDG_CACHE_HOME": str(tmp_path / "file")}
    use_compiled_cache(blocked)
    assert CACHE not in blocked


def test_the_lock_pins_extras_that_a_distribution_requires():
    """To pip, 'name[extra]' is not the pinned 'name': it would take a later release, which has no hash."""
    lock = (Path(__file__).parents[1] / "requirements.lock").read_text()
    pinned = {line.name: line.extras for line in map(Requirement, re.findall(r"^([\w.\[\],-]+==[^ ;]+)", lock, re.M))}
    assert pinned.keys() > {"numpy", "coverage"}
    installed = [one for one in distributions() if one.name.lower() in pinned]
    for one in (Requirement(text) for each in installed for text in each.requires or ()):
        if one.marker is None or one.marker.evaluate({"extra": ""}):
            assert one.extras <= pinned.get(one.name, one.extras), one
