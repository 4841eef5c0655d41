"""Processes that end with their parent."""

import os
import subprocess
import sys
import time

import pytest

#: starts a child that follows it and would sleep for a minute, tells its id and waits
PARENT = """
import os, subprocess, sys, time
child = subprocess.Popen([sys.executable, "-m", "pipeline.contract.following", str(os.getpid()), "timeit", "-n", "1",
                          "-r", "1", "import time; time.sleep(60)"], start_new_session=True)
print(child.pid, flush=True)
time.sleep(60)
"""


def lives(process):
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


def test_a_process_ends_when_its_parent_is_killed():
    with subprocess.Popen([sys.executable, "-c", PARENT], stdout=subprocess.PIPE, text=True) as parent:
        child = int(parent.stdout.readline())
        time.sleep(1)
        assert lives(child)
        parent.kill()
        parent.wait()
        end = time.monotonic() + 30
        while lives(child) and time.monotonic() < end:
            time.sleep(0.1)
        assert not lives(child)


@pytest.mark.parametrize("code", [0, 3])
def test_a_module_runs_as_it_does_alone(tmp_path, code):
    (tmp_path / "own.py").write_text(f"import sys; print(sys.argv[1:], __name__); sys.exit({code})\n")
    done = subprocess.run([sys.executable, "-m", "pipeline.contract.following", str(os.getpid()), "own", "a", "-b"],
                          capture_output=True, text=True, timeout=60, env={**os.environ, "PYTHONPATH": str(tmp_path)})
    assert (done.returncode, done.stdout.split(), done.stderr) == (code, ["['a',", "'-b']", "__main__"], "")
