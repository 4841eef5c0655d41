"""Fan-out of independent tasks over this process or local processes.

Every task runs with one BLAS thread; results come back in the order of the items.
"""

import multiprocessing
import os
import pickle
import signal
import threading
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool

from threadpoolctl import threadpool_limits

from pipeline.contract.errors import BrakechainError, ConfigError
from pipeline.contract.executors.cpu_time import cpu_seconds
from pipeline.contract.executors.lent_arrays import Lender
from pipeline.contract.fingerprint import project_digest
from pipeline.contract.following import follow
from pipeline.environment import ONE_THREAD, SAFE

#: solvers have global state: one task at a time per process, also in a worker with several threads
_ONE_TASK = threading.Lock()


def run_task(function, item, code=None):
    """One task, as every executor runs it: its result and the CPU seconds it took, child processes included.

    ``code`` is the digest of the project that the task belongs to; a worker with another one refuses.
    """
    if code is not None and code != project_digest():
        raise ConfigError("--scheduler: a worker", "the same brakechain code as here", "other code",
                          "install the same version there and restart the worker")
    os.environ.update(ONE_THREAD)
    with _ONE_TASK, threadpool_limits(1):
        begin = cpu_seconds()
        return function(item), cpu_seconds() - begin


def _as_sent(value):
    """What a worker would get of a value: arrays with gaps, as a column is one, are gapless there.

    Sums over both may differ in the last bit. Arrays without gaps are not copied.
    """
    buffers = []
    return pickle.loads(pickle.dumps(value, protocol=5, buffer_callback=buffers.append), buffers=buffers)


class InProcess:
    """One task after the other, here; what it takes and gives is as if it had been sent."""

    spent_elsewhere = 0.0   # CPU seconds of tasks in other processes
    sees_files = True       # tasks read and write files of this machine
    spares = False          # a process for one long task

    def map(self, function, items, done):
        """Results in the order of ``items``; ``done()`` is called after each."""
        results, function = [], _as_sent(function)
        for item in items:
            results.append(_as_sent(run_task(function, _as_sent(item))[0]))
            done()
        return results

    def close(self):
        """Nothing to release."""

    stop = close


def killed():
    """The error of a process that was killed."""
    return BrakechainError("local processes", "workers that run to the end", "one that was killed",
                           "usually memory ran out: try --workers 1")


def _begin(parent):
    """Begin of a worker: it ends with its parent, and leaves Ctrl-C, which every process of a terminal gets, to it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    follow(parent)


def _run_packed(content):
    """``run_task`` of a packed (function, item)."""
    return run_task(*pickle.loads(content))


class LocalProcesses:
    """``workers`` processes on this machine, started when first needed."""

    sees_files = True

    def __init__(self, workers):
        self.workers, self._pool, self.spent_elsewhere, self._lender = workers, None, 0.0, Lender()

    def _submit(self, function, item):
        """The Future of a task, whose large arrays are lent until it is done."""
        if self._pool is None:
            os.environ.update(ONE_THREAD | SAFE)
            spawn = multiprocessing.get_context("spawn")
            self._pool = ProcessPoolExecutor(self.workers, spawn, _begin, (os.getpid(),))
        task = self._lender.packed((function, item))
        future = self._pool.submit(_run_packed, task.content)
        future.add_done_callback(lambda _: self._lender.take_back(task))
        return future

    @property
    def spares(self):
        return self.workers > 1

    def begin(self, function, item):
        """A Future of (``function(item)``, its CPU seconds), which takes one of several processes."""
        return self._submit(function, item)

    def map(self, function, items, done):
        """Results in the order of ``items``; ``done()`` is called after each."""
        futures = [self._submit(function, item) for item in items]
        try:
            for future in as_completed(futures):
                self.spent_elsewhere += future.result()[1]
                done()
        except BrokenProcessPool:
            raise killed() from None
        except BaseException as error:
            for future in futures:
                future.cancel()
            if isinstance(error, KeyboardInterrupt):
                self.stop()
            raise
        return [future.result()[0] for future in futures]

    def close(self):
        if self._pool is not None:
            self._pool.shutdown(cancel_futures=True)

    def stop(self):
        """End the workers now, without waiting for what they compute."""
        for process in list((getattr(self._pool, "_processes", None) or {}).values()):
            process.terminate()
