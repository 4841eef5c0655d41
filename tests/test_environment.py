"""The environment: compiled code lies in a folder of the user; the locks of users and developers, their licences."""

import os
import re
import subprocess
import sys
import tomllib
from importlib.metadata import distributions
from pathlib import Path

from packaging.requirements import Requirement

from pipeline.environment import CACHE, LOCATORS, use_compiled_cache
from tests import licences


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
    lock = (licences.ROOT / "requirements-dev.lock").read_text()
    pinned = {line.name: line.extras for line in map(Requirement, re.findall(r"^([\w.\[\],-]+==[^ ;]+)", lock, re.M))}
    assert pinned.keys() > {"numpy", "coverage"}
    installed = [one for one in distributions() if one.name.lower() in pinned]
    for one in (Requirement(text) for each in installed for text in each.requires or ()):
        if one.marker is None or one.marker.evaluate({"extra": ""}):
            assert one.extras <= pinned.get(one.name, one.extras), one


def pins(name):
    """{package with its version: text of its hashes} of a lock file."""
    text = (licences.ROOT / name).read_text()
    return {pin: set(re.findall(r"sha256:\w{64}", hashes))
            for pin, hashes in re.findall(r"^([\w.\[\],-]+==[^ ;]+)[^\n]*\n((?: {4}--hash[^\n]*\n)+)", text, re.M)}


def test_what_users_install_is_a_part_of_what_developers_do():
    users, developers = pins("requirements.lock"), pins("requirements-dev.lock")
    assert len(users) > 50 and users.items() < developers.items()


def test_users_install_all_that_the_program_needs_and_nothing_for_tests():
    project = tomllib.loads((licences.ROOT / "pyproject.toml").read_text())["project"]
    extras = {name: {Requirement(text).name.lower() for text in texts}
              for name, texts in project["optional-dependencies"].items()}
    users = licences.locked("requirements.lock")
    needed = {Requirement(text).name.lower() for text in project["dependencies"]} | extras["bench"] | extras["build"]
    assert needed <= users and not users & (extras["test"] - needed)


def test_no_package_of_users_is_under_a_strong_copyleft_licence():
    """'make licences' prints them all."""
    users = licences.locked("requirements.lock")
    kinds = {package.name: package.kind for package in licences.installed()}
    assert kinds["numpy"] == "permissive" and kinds["nptdms"] == "weak copyleft"
    assert {name for name, kind in kinds.items() if kind == "strong copyleft"} <= {"tamaas"}
    assert not [name for name, kind in kinds.items() if name in users and kind in ("unknown", "strong copyleft")]


def test_files_beside_the_sources_are_packaged():
    settings = tomllib.loads((Path(__file__).parents[1] / "pyproject.toml").read_text())
    patterns = settings["tool"]["setuptools"]["package-data"]["pipeline"]
    package = Path(__file__).parents[1] / "pipeline"
    files = [file.relative_to(package) for file in package.rglob("*.*")
             if file.suffix != ".py" and "__pycache__" not in file.parts]
    assert files and [file for file in files if not any(file.match(pattern) for pattern in patterns)] == []


def test_tests_set_the_number_of_threads_before_anything_loads_linear_algebra():
    """Later it would change nothing: BLAS starts its threads as it is loaded."""
    told = "import sys, os, tests.conftest; print('numpy' in sys.modules, os.environ['OPENBLAS_NUM_THREADS'])"
    done = subprocess.run([sys.executable, "-c", told], env=os.environ | {"PYTHONPATH": str(licences.ROOT)},
                          capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False", "1"]
