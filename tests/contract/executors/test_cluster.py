"""A cluster that loses workers or its scheduler: tasks move on, or one sentence says what is gone."""

import threading
import time
from types import SimpleNamespace

import pytest

from pipeline.contract import BrakechainError, ConfigError
from pipeline.contract.executors import InProcess, choose, cluster
from tests.contract.executors.dask_processes import address_of, kill, process, scheduler, worker
from tests.contract.executors.test_local import running, work

pytest.importorskip("distributed")
COUNT = 8


def slow(seed):
    """A task of a third of a second with bits of its own."""
    time.sleep(0.3)
    return work(seed)


def lost(victim, executor, after=1.0):
    """What ``executor`` returns of slow tasks while ``victim`` is killed."""
    timer = threading.Timer(after, kill, (victim,))
    timer.start()
    try:
        return executor.map(slow, range(COUNT), lambda: None)
    finally:
        timer.join()


def test_tasks_of_a_lost_worker_go_to_the_other(tmp_path):
    with scheduler() as started:
        address = address_of(started)
        with (worker(address, 1, tmp_path / "a"), worker(address, 1, tmp_path / "b") as victim,
              running(choose(1, address)) as executor):
            executor._client.wait_for_workers(2, timeout=60)
            there = lost(victim, executor)
    assert there == InProcess().map(work, range(COUNT), lambda: None)


def test_the_only_worker_lost_is_told_with_the_time_waited(tmp_path, monkeypatch):
    monkeypatch.setattr(cluster, "_LOOK", 0.2)
    monkeypatch.setattr(cluster, "_PATIENCE", 1.0)
    with scheduler() as started:
        address = address_of(started)
        with (worker(address, 1, tmp_path) as victim, running(choose(1, address)) as executor,
              pytest.raises(BrakechainError, match=rf"--scheduler: expected a worker, found none at {address} for"
                            r" \d+ s, with \d tasks to do; start one with 'dask worker")):
            lost(victim, executor)


@pytest.mark.slow
def test_a_worker_that_joins_in_time_goes_on(tmp_path):
    with scheduler() as started:
        address = address_of(started)
        with worker(address, 1, tmp_path / "a") as victim, running(choose(1, address)) as executor:
            joined = []

            def join():
                time.sleep(4.0)
                joined.append(worker(address, 1, tmp_path / "b"))
                joined[0].__enter__()

            later = threading.Thread(target=join)
            later.start()
            there = lost(victim, executor)
            later.join()
            joined[0].__exit__(None, None, None)
    assert there == InProcess().map(work, range(COUNT), lambda: None)


@pytest.mark.slow
def test_certificates_are_those_of_dasks_configuration(tmp_path, monkeypatch):
    import dask
    from distributed import Security

    made = Security.temporary()
    paths = {}
    for name in ("tls_ca_file", "tls_client_cert", "tls_client_key", "tls_scheduler_cert", "tls_scheduler_key",
                 "tls_worker_cert", "tls_worker_key"):
        paths[name] = tmp_path / f"{name}.pem"
        paths[name].write_text(getattr(made, name))

    def options(role):
        return ("--tls-ca-file", paths["tls_ca_file"], "--tls-cert", paths[f"tls_{role}_cert"],
                "--tls-key", paths[f"tls_{role}_key"])

    with process("scheduler", "--host", "tls://127.0.0.1", "--port", "0", "--no-dashboard",
                 *options("scheduler")) as started:
        address = address_of(started)
        assert address.startswith("tls://")
        with process("worker", address, "--nthreads", "1", "--no-dashboard", "--local-directory", tmp_path,
                     *options("worker")):
            with pytest.raises(BrakechainError, match="expected certificates for tls://.* found none"):
                choose(1, address)
            with (dask.config.set({"distributed.comm.tls.ca-file": str(paths["tls_ca_file"]),
                                   "distributed.comm.tls.client.cert": str(paths["tls_client_cert"]),
                                   "distributed.comm.tls.client.key": str(paths["tls_client_key"])}),
                  running(choose(1, address)) as executor):
                assert executor.map(work, range(2), lambda: None) == InProcess().map(work, range(2), lambda: None)


def test_a_worker_lost_while_its_code_is_asked_for_is_no_other_code():
    asked = object.__new__(cluster.DaskCluster)
    answers = {"tcp://a": OSError("Stream is closed"), "tcp://b": "mine"}
    asked._client = SimpleNamespace(run=lambda *_, **__: answers, run_on_scheduler=lambda *_: "mine")
    asked._code = "mine"
    asked._check_code()
    answers["tcp://b"] = "yours"
    with pytest.raises(ConfigError, match=r"found other code \(tcp://b\); install"):
        asked._check_code()


def test_a_scheduler_that_is_lost_is_told_in_one_sentence(tmp_path):
    with scheduler() as started:
        address = address_of(started)
        with (worker(address, 1, tmp_path), running(choose(1, address)) as executor,
              pytest.raises(BrakechainError, match="expected a Dask scheduler that answers until the end, found"
                            f" {address} lost")):
            lost(started, executor)
