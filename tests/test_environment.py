"""The environment: compiled code belongs to one state of its sources."""

from pathlib import Path

from pipeline.environment import CACHE, own_compiled_code, state_of


def test_compiled_code_gets_a_folder_of_this_state(tmp_path):
    environment = {"XDG_CACHE_HOME": str(tmp_path)}
    own_compiled_code(environment)
    folder = Path(environment[CACHE])
    assert folder.is_dir() and folder.parent == tmp_path / "brakechain"
    assert folder.name.endswith(state_of(Path(__file__).parents[1] / "pipeline"))


def test_the_state_follows_files_with_compiled_functions_and_no_others(tmp_path):
    compiled, plain = tmp_path / "a.py", tmp_path / "b.py"
    compiled.write_text("@njit\ndef f(): return 1\n")
    plain.write_text("x = 1\n")
    before = state_of(tmp_path)
    plain.write_text("x = 2\n")
    assert state_of(tmp_path) == before
    compiled.write_text("@njit\ndef f(): return 2\n")
    assert state_of(tmp_path) != before


def test_a_folder_of_the_user_is_kept_and_one_that_cannot_be_made_is_left_out(tmp_path):
    environment = {CACHE: "mine"}
    own_compiled_code(environment)
    assert environment == {CACHE: "mine"}
    (tmp_path / "file").write_text("")
    blocked = {"XDG_CACHE_HOME": str(tmp_path / "file")}
    own_compiled_code(blocked)
    assert CACHE not in blocked
