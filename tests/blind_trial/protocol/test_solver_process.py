"""The process that solves a case: it sees two files, and nothing else of the trial."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from pipeline.blind_trial.protocol import sealing, solver_process
from pipeline.contract.errors import BrakechainError
from tests.blind_trial.protocol.small_set import small_set

#: tells all that the process has, as an answer
SPY = """
import json, os, sys
from pathlib import Path
seen = {"cwd": os.getcwd(), "environment": dict(os.environ), "arguments": sys.argv, "home": str(Path.home()),
        "files": sorted(p.name for p in Path.cwd().rglob("*")),
        "around": sorted(p.name for p in Path.cwd().parent.iterdir()),
        "kept": sorted(p.name for p in Path.home().rglob("*")), "nominal": Path("nominal.yaml").read_text(),
        "opened": [os.readlink(f"/proc/self/fd/{n}") for n in os.listdir("/proc/self/fd") if n not in "012"
                   and os.path.exists(f"/proc/self/fd/{n}")] if os.path.isdir("/proc/self/fd") else []}
Path("products").mkdir()
Path("products/diagnosis.json").write_text(json.dumps({"verdict": "unknown", "effects": [], "seen": seen}))
"""


def running(monkeypatch, script):
    monkeypatch.setattr(solver_process, "command", lambda method: (sys.executable, "-c", script))


def test_a_solver_sees_two_files_a_clean_environment_and_no_path_of_the_set(tmp_path, monkeypatch):
    folder = small_set(tmp_path / "telling_name")
    key = sealing.new_key(tmp_path / "secret.key")
    monkeypatch.setenv("BRAKECHAIN_TRIAL_KEY", key.decode())
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    running(monkeypatch, SPY)
    answer = solver_process.answered(folder / "cases" / "002", "diagnosis", 60)
    seen = answer["seen"]
    assert seen["files"] == ["nominal.yaml", "recordings.h5"] and seen["nominal"] == "# 002\n"
    assert seen["around"] == ["home", "work"] and seen["kept"] == []
    assert set(seen["environment"]) <= {"PATH", "LANG", "NUMBA_CACHE_DIR", "HOME", "TMPDIR", "PYTHONPATH",
                                        "PYTHONDONTWRITEBYTECODE", "LC_CTYPE", "BRAKECHAIN_ONLY",
                                        *solver_process.ONE_THREAD, *solver_process.SAFE}
    assert seen["home"] != str(Path.home()) and Path(seen["cwd"]).parent == Path(seen["home"]).parent
    told = json.dumps(seen)
    assert key.decode() not in told and "telling_name" not in told and str(tmp_path) not in told and "002/" not in told
    assert not seen["opened"] and not Path(seen["cwd"]).exists(), "nothing is left behind"
    assert answer["cpu_seconds"] > 0


def test_the_diagnosis_is_the_released_command_and_a_baseline_has_its_own_door():
    led = (sys.executable, "-m", "pipeline.contract.following", str(os.getpid()))
    assert solver_process.command("diagnosis")[:7] == (*led, "pipeline", "run", "nominal.yaml")
    assert solver_process.command("largest_residual") == (*led, "pipeline.blind_trial.baselines", "largest_residual")


@pytest.mark.parametrize("script, reason", [
    ("import sys; sys.exit('error: the model diverges')", "error: the model diverges"),
    ("raise ValueError('inside')", "ValueError: inside"), ("import sys; sys.exit(3)", "it said nothing"),
    ("pass", "no readable answer: FileNotFoundError"),
    ("import time; time.sleep(60)", "no answer within 1 s")])
def test_a_case_that_is_not_answered_is_refused_with_the_reason(tmp_path, monkeypatch, script, reason):
    running(monkeypatch, script)
    case = small_set(tmp_path / "a") / "cases" / "001"
    answer = solver_process.answered(case, "diagnosis", 1 if "sleep" in script else 60)
    assert (answer["verdict"], answer["effects"], answer["reasons"]) == ("refused", [], [reason])


@pytest.mark.skipif(sys.platform != "linux", reason="other systems do not keep to a bound of the address space")
def test_a_process_that_grows_without_end_is_refused(tmp_path, monkeypatch):
    running(monkeypatch, f"print(len(bytes({2 * solver_process.MEMORY})))")
    answer = solver_process.answered(small_set(tmp_path / "a") / "cases" / "001", "diagnosis", 60)
    assert answer["verdict"] == "refused" and answer["reasons"] == ["MemoryError"]


def test_a_process_that_was_ended_from_outside_is_no_answer(tmp_path, monkeypatch):
    running(monkeypatch, f"import os; os.kill(os.getpid(), {int(signal.SIGTERM)})")
    with pytest.raises(BrakechainError, match="to run until its end, found signal 15"):
        solver_process.answered(small_set(tmp_path / "a") / "cases" / "001", "diagnosis", 60)


def test_the_environment_starts_the_program_from_anywhere(tmp_path):
    done = subprocess.run([sys.executable, "-m", "pipeline", "--version"], cwd=tmp_path, capture_output=True, text=True,
                          env=solver_process.environment(tmp_path), timeout=60)
    assert done.returncode == 0 and "brakechain" in done.stdout
    assert os.environ["PATH"] == solver_process.environment("")["PATH"]
