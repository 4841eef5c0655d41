"""Fan-out of independent tasks: this process, local processes, or a Dask cluster. Same bits each way.

Every task runs with one BLAS thread; results come back in the order of the items.
"""

import multiprocessing
import os
import signal
import threading
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool

from threadpoolctl import threadpool_limits

from pipeline import __version__
from pipeline.contract.cpu_time import cpu_seconds
from pipeline.contract.errors import BrakechainError, ConfigError
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


class InProcess:
    """One task after the other, here."""

    spent_elsewhere = 0.0   # CPU seconds of tasks in other processes
    sees_files = True       # tasks read and write files of this machine

    def map(self, function, items, done):
        """Results in the order of ``items``; ``done()`` is called after each."""
        results = []
        for item in items:
            results.append(run_task(function, item)[0])
            done()
        return results

    def close(self):
        """Nothing to release."""


def _begin(parent):
    """Begin of a worker: it ends with its parent, and leaves Ctrl-C, which every process of a terminal gets, to it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    follow(parent)


class LocalProcesses:
    """``workers`` processes on this machine, started when first needed."""

    sees_files = True

    def __init__(self, workers):
        self.workers, self._pool, self.spent_elsewhere = workers, None, 0.0

    def map(self, function, items, done):
        """Results in the order of ``items``; ``done()`` is called after each."""
        if self._pool is None:
            os.environ.update(ONE_THREAD | SAFE)
            spawn = multiprocessing.get_context("spawn")
            self._pool = ProcessPoolExecutor(self.workers, spawn, _begin, (os.getpid(),))
        futures = [self._pool.submit(run_task, function, item) for item in items]
        try:
            for future in as_completed(futures):
                self.spent_elsewhere += future.result()[1]
                done()
        except BrokenProcessPool:
            raise BrakechainError("local processes", "workers that run to the end", "one that was killed",
                                  "usually memory ran out: try --workers 1") from None
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


#: expression whose value is the digest of the brakechain where it is evaluated; to ask needs no brakechain there
_CODE_THERE = "__import__('pipeline.contract.fingerprint', fromlist=['project_digest']).project_digest()"


class DaskCluster:
    """The workers of the Dask scheduler at ``address``; all must run the same brakechain as this process."""

    sees_files = False

    def __init__(self, address):
        self.spent_elsewhere, self._code = 0.0, project_digest()
        try:
            from distributed import Client
        except ImportError:
            raise ConfigError("--scheduler", "the package 'distributed'", "none",
                              "install it: python -m pip install distributed") from None
        try:
            self._client = Client(address, timeout=10, set_as_default=False)
        except (OSError, ValueError, TimeoutError) as error:
            raise ConfigError("--scheduler", "a Dask scheduler that answers", f"{address} ({error})",
                              "start one with 'dask scheduler' and 'dask worker ADDRESS'") from None
        try:
            self._client.wait_for_workers(1, timeout=20)
        except TimeoutError:
            self._client.close()
            raise ConfigError("--scheduler", "at least one worker", f"none at {address}",
                              f"start one with 'dask worker {address}'") from None
        try:
            self._check_code()
        except ConfigError:
            self._client.close()
            raise

    def _check_code(self):
        """Refuse a cluster with other code or none: Dask itself would wait for its workers forever."""
        answers = self._client.run(eval, _CODE_THERE, on_error="return")
        try:
            answers["the scheduler"] = self._client.run_on_scheduler(eval, _CODE_THERE)
        except Exception as error:      # whatever the code there raises
            answers["the scheduler"] = error
        wrong = [f"{answer if isinstance(answer, Exception) else 'other code'} ({machine})"
                 for machine, answer in answers.items() if answer != self._code]
        if wrong:
            raise ConfigError("--scheduler", f"brakechain {__version__} with the same code on the scheduler and its"
                              " workers as here", "; ".join(wrong), "install it in their environments and restart them")

    def map(self, function, items, done):
        """Results in the order of ``items``; ``done()`` is called after each."""
        from distributed import KilledWorker
        from distributed import as_completed as completed

        self._check_code()      # workers may have joined
        futures = [self._client.submit(run_task, function, item, self._code, pure=False) for item in items]
        try:
            with self._client.as_current():
                for future in completed(futures):
                    self.spent_elsewhere += future.result()[1]
                    done()
        except (KilledWorker, ModuleNotFoundError) as error:
            raise BrakechainError("--scheduler", "workers that run brakechain until the end", str(error),
                                  "install this version there, with enough memory, and restart the worker") from None
        except BaseException:
            self._client.cancel(futures)
            raise
        return [result for result, _ in self._client.gather(futures)]

    def close(self):
        self._client.close()


def choose(workers, scheduler):
    """The executor that the command line asks for."""
    if scheduler:
        return DaskCluster(scheduler)
    return LocalProcesses(workers) if workers > 1 else InProcess()
