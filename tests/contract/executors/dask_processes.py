"""Scheduler and workers of Dask in processes of their own, on the loopback interface."""

import os
import re
import signal
import subprocess
import sys
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]


@contextmanager
def process(*args, code=ROOT):
    """A Dask process of our own on the loopback interface, with the project in ``code``; ended with the test."""
    started = subprocess.Popen([sys.executable, "-m", "dask", *map(str, args)], stderr=subprocess.PIPE, text=True,
                               cwd=code, start_new_session=True, env={**os.environ, "PYTHONPATH": str(code)})
    try:
        yield started
    finally:
        started.terminate()
        started.wait(20)
        started.stderr.close()


def address_of(scheduler):
    for line in scheduler.stderr:
        found = re.search(r"Scheduler at:\s+((?:tcp|tls)://\S+)", line)
        if found:
            return found[1]
    pytest.fail("the scheduler did not tell its address")


def scheduler(code=ROOT):
    return process("scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard", code=code)


def worker(address, count, folder, code=ROOT):
    alone = ("--no-nanny",) if count == 1 else ()       # a process less, where there is no other to look after
    return process("worker", address, "--nthreads", "1", "--nworkers", count, "--no-dashboard", *alone,
                   "--local-directory", folder, code=code)


@contextmanager
def cluster(folder):
    """Address of a scheduler with two workers, ended with the test."""
    with scheduler() as started:
        address = address_of(started)
        with worker(address, 2, folder):
            yield address


def kill(started):
    """End a Dask process and all of its children as a lost machine would."""
    with suppress(ProcessLookupError):
        os.killpg(started.pid, signal.SIGKILL)
