"""Fan-out over a Dask cluster, which may lose workers, all of them, or its scheduler.

Certificates of ``tls://`` addresses are those of Dask's own configuration (``distributed.comm.tls``).
"""

import time

from pipeline import __version__
from pipeline.contract.errors import BrakechainError, ConfigError
from pipeline.contract.executors.local import run_task
from pipeline.contract.fingerprint import project_digest

#: how long a scheduler may take to answer, how often the cluster is looked at while nothing finishes, and how long
#: tasks wait for a first worker [s]
_ANSWER, _LOOK, _PATIENCE = 10.0, 2.0, 60.0
#: characters shown of what Dask says
_LONGEST = 200
#: expression whose value is the digest of the brakechain where it is evaluated; to ask needs no brakechain there
_CODE_THERE = "__import__('pipeline.contract.fingerprint', fromlist=['project_digest']).project_digest()"


def _check_certificates(address):
    """Refuse a ``tls://`` address without certificates, or with ones that cannot be read."""
    from distributed import Security

    try:
        if not address.startswith("tls://") or Security().get_connection_args("client")["ssl_context"]:
            return
        found = "none"
    except OSError as error:
        found = str(error)
    raise ConfigError("--scheduler", f"certificates for {address} in Dask's configuration", found,
                      "set DASK_DISTRIBUTED__COMM__TLS__CA_FILE, ...__CLIENT__CERT and ...__CLIENT__KEY")


class DaskCluster:
    """The workers of the Dask scheduler at ``address``; all must run the same brakechain as this process."""

    sees_files = spares = False

    def __init__(self, address):
        self.spent_elsewhere, self._code, self._address = 0.0, project_digest(), address
        try:
            from distributed import Client
        except ImportError:
            raise ConfigError("--scheduler", "the package 'distributed'", "none",
                              "install it: python -m pip install distributed") from None
        _check_certificates(address)
        try:
            self._client = Client(address, timeout=_ANSWER, set_as_default=False)
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
                 for machine, answer in answers.items()
                 if answer != self._code and not isinstance(answer, OSError)]       # lost while it was asked
        if wrong:
            raise ConfigError("--scheduler", f"brakechain {__version__} with the same code on the scheduler and its"
                              " workers as here", "; ".join(wrong), "install it in their environments and restart them")

    def map(self, function, items, done):
        """Results in the order of ``items``; ``done()`` is called after each."""
        from distributed import CancelledError, KilledWorker
        from distributed.comm import CommClosedError

        self._check_code()      # workers may have joined
        futures = [self._client.submit(run_task, function, item, self._code, pure=False) for item in items]
        try:
            with self._client.as_current():
                for future in self._finished(futures):
                    self.spent_elsewhere += future.result()[1]
                    done()
                return [result for result, _ in self._client.gather(futures)]
        except (KilledWorker, ModuleNotFoundError) as error:
            raise BrakechainError("--scheduler", "workers that run brakechain until the end", str(error),
                                  "install this version there, with enough memory, and restart the worker") from None
        except (CancelledError, CommClosedError) as error:      # the scheduler is gone, and its tasks with it
            raise self._gone(error) from None
        except BaseException:
            self._client.cancel(futures)
            raise

    def _finished(self, futures):
        """The futures as they finish. Tasks of a lost worker go to the others; BrakechainError where none is left."""
        from distributed import wait

        pending, alone = list(futures), None
        while pending:
            try:
                finished, pending = wait(pending, timeout=_LOOK, return_when="FIRST_COMPLETED")
            except TimeoutError:
                alone = self._alone(alone, len(pending))
                continue
            alone = None
            yield from finished

    def _alone(self, since, pending):
        """Since when no worker is there [s], or None. BrakechainError after too long, or without a scheduler."""
        if self._client.status != "running":
            raise self._gone(f"connection {self._client.status}")
        if self._client.nthreads():
            return None
        since = time.monotonic() if since is None else since
        waited = time.monotonic() - since
        if waited > _PATIENCE:
            raise BrakechainError("--scheduler", "a worker", f"none at {self._address} for {waited:.0f} s,"
                                  f" with {pending} tasks to do", f"start one with 'dask worker {self._address}' and"
                                  " run the same command again: finished stages are kept")
        return since

    def _gone(self, error):
        return BrakechainError("--scheduler", "a Dask scheduler that answers until the end",
                               f"{self._address} lost ({error})"[:_LONGEST], "start it and its workers anew, then run"
                               " the same command again: finished stages are kept")

    def close(self):
        self._client.close()
