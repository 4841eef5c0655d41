"""A Context that maps over two processes, for tests that the number of workers changes no bit."""

from pipeline.contract import Context
from pipeline.contract.executors import LocalProcesses


class TwoProcesses(Context):
    """Each map starts two processes and ends them."""

    def map(self, function, items, label=""):
        pool = LocalProcesses(2)
        try:
            return pool.map(function, list(items), lambda: None)
        finally:
            pool.close()
