"""CPU time counts the processes that a stage starts: by itself, in a task, in a worker of the pool."""

import subprocess
import sys
import time

import pytest

from pipeline.contract import Context, case, runner, store
from pipeline.contract.executors import LocalProcesses, run_task
from pipeline.contract.executors.cpu_time import cpu_seconds
from tests.contract.toy import CHAINS, load

SPENT = 0.3     # s
BUSY = f"import time\nwhile time.process_time() < {SPENT}: pass"


def in_a_child(item=None):
    """A task that leaves its work to a process of its own."""
    subprocess.run([sys.executable, "-c", BUSY], check=True)


def in_this_process(item):
    """A task that works here."""
    end = time.process_time() + SPENT
    while time.process_time() < end:
        pass


def test_a_child_that_has_ended_is_counted():
    before, here = cpu_seconds(), time.process_time()
    in_a_child()
    assert cpu_seconds() - before >= SPENT > time.process_time() - here


@pytest.mark.parametrize("task", [in_a_child, in_this_process])
def test_tasks_tell_their_time_wherever_they_run(task):
    assert run_task(task, None)[1] >= SPENT
    pool = LocalProcesses(2)
    try:
        pool.map(task, range(2), lambda: None)
        assert pool.spent_elsewhere >= 2 * SPENT
    finally:
        pool.close()


class Elsewhere(Context):
    """A context that starts a process for its tasks, and says that workers spent 100 s on them."""

    mapped = []

    def map(self, function, items, label=""):
        in_a_child()
        self.mapped.append(label)
        return super().map(function, items, label)

    def spent_elsewhere(self):
        return 100.0 * len(self.mapped)


def test_the_time_of_a_product_holds_child_processes_and_workers(tmp_path):
    config = tmp_path / "toy.yaml"
    config.write_text("chain: toy")
    runner.ChainRun(case.load(config, CHAINS, load), tmp_path, "superlu").execute(Elsewhere())
    seconds = {name: store.provenance(tmp_path / f"{name}.h5")["cpu_seconds"] for name in ("source", "doubled")}
    assert seconds["source"] < SPENT
    assert 100.0 + SPENT <= seconds["doubled"] < 101.0 + SPENT
