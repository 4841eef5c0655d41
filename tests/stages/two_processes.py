"""A Context that maps over two processes, for tests that the number of workers changes no bit."""

import atexit
from functools import cache

from pipeline.contract import Context
from pipeline.contract.executors import LocalProcesses


@cache
def _pool():
    """Two processes that serve all tests of this one, and end with it."""
    pool = LocalProcesses(2)
    atexit.register(pool.close)
    return pool


class TwoProcesses(Context):
    """Each map goes to the same two processes."""

    def map(self, function, items, label=""):
        return _pool().map(function, list(items), lambda: None)
