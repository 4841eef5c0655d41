"""A Dask cluster with a worker in another process gives the same content as local processes."""

import os
import re
import subprocess
import sys
from contextlib import contextmanager

import pytest

from tests.chain.conftest import QUICK, ROOT, brakechain, contents

pytest.importorskip("distributed")


@contextmanager
def process(*args):
    """A Dask process of our own on the loopback interface; ended with the test."""
    started = subprocess.Popen([sys.executable, "-m", "dask", *args], stderr=subprocess.PIPE, text=True, cwd=ROOT,
                               env={**os.environ, "PYTHONPATH": str(ROOT)})
    try:
        yield started
    finally:
        started.terminate()
        started.wait(20)
        started.stderr.close()


def address_of(scheduler):
    for line in scheduler.stderr:
        found = re.search(r"Scheduler at:\s+(tcp://\S+)", line)
        if found:
            return found[1]
    pytest.fail("the scheduler did not tell its address")


def test_the_same_bits_come_back(tmp_path, finished):
    with process("scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard") as scheduler:
        address = address_of(scheduler)
        with process("worker", address, "--nthreads", "1", "--nworkers", "2", "--no-dashboard", "--local-directory",
                     str(tmp_path)):
            brakechain("run", QUICK, "--run", tmp_path / "run", "--scheduler", address)
    assert contents(tmp_path / "run") == contents(finished)
