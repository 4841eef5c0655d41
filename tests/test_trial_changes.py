"""What the tests of trial and studies depend on: found by imports, and seen when it changes."""

from pathlib import Path

import pytest

from pipeline import sources
from tests import trial_changes

GENERATORS, STUDIES = trial_changes.GROUPS


def test_files_are_tests_what_they_import_and_what_that_imports():
    one, other = ({path.as_posix() for path in trial_changes.files(group)} for group in (GENERATORS, STUDIES))
    assert {"tests/blind_trial/generators/test_systems.py", "pipeline/blind_trial/generators/case_files.py",
            "tests/conftest.py", "configs/belt.yaml", "requirements-dev.lock"} <= one
    assert {"tests/studies/test_forced.py", "tests/studies/forced.py", "pipeline/inference/procedure.py",
            "pipeline/effects/joint/cubic_stiffness.py", "stages/diagnosis.py"} <= other
    assert "tests/cli/test_main.py" not in one | other


@pytest.mark.parametrize("changed, groups", [
    ("tests/studies/ledger.py", {STUDIES}), ("pipeline/inference/rules.py", {STUDIES}),
    ("tests/blind_trial/generators/test_systems.py", {GENERATORS}),
    ("configs/belt.yaml", {GENERATORS, STUDIES}), ("README.md", set())])
def test_a_change_counts_where_something_depends_on_it(monkeypatch, changed, groups):
    before, told = {group: trial_changes.digest(group) for group in trial_changes.GROUPS}, sources.digest
    monkeypatch.setattr(sources, "digest", lambda path: "other" if Path(path) == trial_changes.ROOT / changed
                        else told(path))
    found = {group for group, digest in before.items() if trial_changes.digest(group) != digest}
    assert found >= groups and bool(found) == bool(groups) and (STUDIES in groups or STUDIES not in found)


def test_what_has_passed_is_not_run_again_unless_asked(monkeypatch, tmp_path):
    calls = []
    monkeypatch.setattr(trial_changes, "PASSED", tmp_path / "passed.json")
    monkeypatch.setattr(trial_changes.subprocess, "call", lambda command, cwd: calls.append(command) or len(calls) == 2)
    assert trial_changes.main([]) == 1 and [call[-1] for call in calls] == [GENERATORS, STUDIES], "studies fail"
    assert trial_changes.main(["-x"]) == 0 and [call[-1] for call in calls[2:]] == [STUDIES] and "-x" in calls[2]
    assert trial_changes.main([]) == 0 and len(calls) == 3
    assert trial_changes.main(["--always"]) == 0 and len(calls) == 5
