"""Fan-out: order kept, errors passed on, the same results here, in processes and on a Dask cluster."""

import os
import re
import subprocess
import sys
import time
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from pipeline.contract import BrakechainError, ConfigError, ConvergenceError
from pipeline.contract.executors import DaskCluster, InProcess, LocalProcesses, choose, cluster, run_task


def work(seed):
    """A task whose bits depend on the number of threads."""
    a = np.random.default_rng(seed).standard_normal((300, 300))
    return (a @ a).tobytes()


def strides(item, whole):
    """How two arrays lie in a worker, and a column that it gives back."""
    return item.strides, whole.strides, np.ones((5, 3))[:, 0]


def fail(item):
    """A task that does not converge for one item."""
    if item == 2:
        raise ConvergenceError(f"point {item}", "residual below 1e-8", "1e-3", "shorten the step")
    return item


@contextmanager
def running(executor):
    try:
        yield executor
    finally:
        executor.close()


def test_local_processes_give_the_bits_of_this_process():
    counted = []
    with running(LocalProcesses(2)) as pool:
        there = pool.map(work, range(5), lambda: counted.append(1))
    assert there == InProcess().map(work, range(5), lambda: None) and len(counted) == 5


@pytest.mark.parametrize("executor", [InProcess(), LocalProcesses(2)], ids=["here", "processes"])
def test_arrays_with_gaps_are_gapless_wherever_a_task_runs(executor):
    """BLAS adds up a column of an array in another order than the same numbers side by side: other last bits."""
    column = np.ones((16, 3))[:, 1]
    with running(executor):
        (item, whole, given), = executor.map(partial(strides, whole=np.ones((4, 4))[:, 1]), [column], lambda: None)
    assert (item, whole, given.strides) == ((8,), (8,), (8,)) and column.strides == (24,)


def test_what_is_whole_is_not_copied_here():
    given, = InProcess().map(np.asfortranarray, [array := np.ones((200, 300), order="F")], lambda: None)
    assert np.shares_memory(given, array) and given.flags.f_contiguous and given.flags.writeable


@pytest.mark.parametrize("executor", [InProcess(), LocalProcesses(2)], ids=["here", "processes"])
def test_errors_arrive_as_they_were_raised(executor):
    with running(executor), pytest.raises(ConvergenceError, match="point 2: expected residual below 1e-8, found 1e-3"):
        executor.map(fail, range(4), lambda: None)


def test_a_worker_with_other_code_refuses():
    with pytest.raises(ConfigError, match="expected the same brakechain code as here, found other code"):
        run_task(work, 1, "other")


def end(item):
    """A task that memory ran out for."""
    os.kill(os.getpid(), 9)


def test_a_worker_that_dies_is_reported():
    with running(LocalProcesses(1)) as pool, pytest.raises(BrakechainError, match="usually memory ran out"):
        pool.map(end, [1], lambda: None)


def test_a_scheduler_that_does_not_answer(monkeypatch):
    pytest.importorskip("distributed")
    monkeypatch.setattr(cluster, "_ANSWER", 1.0)
    with pytest.raises(ConfigError, match="expected a Dask scheduler that answers"):
        choose(2, "tcp://127.0.0.1:9")


def test_choice():
    assert isinstance(choose(1, None), InProcess) and isinstance(choose(3, None), LocalProcesses)
    assert isinstance(DaskCluster, type)


def test_workers_end_with_their_parent(tmp_path):
    script = tmp_path / "parent.py"
    script.write_text("import os, time\nfrom pipeline.contract.executors import LocalProcesses\n"
                      "if __name__ == '__main__':\n    p = LocalProcesses(1)\n"
                      "    print(p.map(eval, ['__import__(\"os\").getpid()'], lambda: None)[0], flush=True)\n"
                      "    os.kill(os.getpid(), 9)\n")
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=60,
                          env={**os.environ, "PYTHONPATH": os.getcwd()})
    worker = int(re.search(r"\d+", done.stdout)[0])
    assert done.returncode == -9 and _gone(worker)


def _gone(pid, patience=10.0):
    end = time.monotonic() + patience
    while time.monotonic() < end:
        try:
            os.kill(pid, 0)
            with open(f"/proc/{pid}/stat") as stat:
                if stat.read().split()[2] == "Z":
                    return True
        except (ProcessLookupError, FileNotFoundError):
            return True
        time.sleep(0.1)
    return False


_INTERRUPTED = """
import os, signal, threading, time
from pathlib import Path
from pipeline.contract.executors import LocalProcesses

def begin(name):
    Path(name).touch()
    time.sleep(900)

def interrupt():
    while not (Path("a").exists() and Path("b").exists()):
        time.sleep(0.05)
    os.killpg(0, signal.SIGINT)

if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.default_int_handler)    # what shells start in the background ignores it
    work = LocalProcesses(2)
    threading.Thread(target=interrupt, daemon=True).start()
    try:
        work.map(begin, ["a", "b"], lambda: None)
    except KeyboardInterrupt:
        work.close()
        print("stopped")
"""


def test_ctrl_c_ends_two_workers_without_a_traceback(tmp_path):
    """The signal of a terminal goes to all processes of its group; tasks would take a quarter of an hour."""
    (tmp_path / "main.py").write_text(_INTERRUPTED)
    done = subprocess.run([sys.executable, "main.py"], cwd=tmp_path, capture_output=True, text=True, timeout=300,
                          start_new_session=True, env={**os.environ, "PYTHONPATH": str(Path(__file__).parents[3])})
    assert done.stdout == "stopped\n" and done.stderr == ""
