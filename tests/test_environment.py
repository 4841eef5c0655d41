"""The environment: compiled code lies in a folder of the user."""

from pathlib import Path

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
