"""Every kernel and every peer runs at its smallest size; results files are written, merged and compared."""

import json

import numpy as np
import pytest

from tests.benchmarks import kernels, peers, results
from tests.benchmarks.measuring import measured


@pytest.mark.parametrize("kernel", kernels.KERNELS, ids=lambda k: k.__name__)
def test_a_kernel_runs_at_its_smallest_size(kernel):
    call, amount, unit = kernel(**kernels.SMALLEST[kernel])
    assert amount > 0 and unit
    result = call()
    if isinstance(result, np.ndarray):
        assert result.size > 0 and np.isfinite(result).all()
    else:
        assert result is not None


@pytest.mark.parametrize(("peer", "kernel", "tolerance"), peers.PEERS, ids=lambda p: getattr(p, "__name__", ""))
def test_a_peer_does_the_same_work(peer, kernel, tolerance):
    try:
        call, *amount = peer(**kernels.SMALLEST[kernel])
    except peers.NotInstalled as missing:
        pytest.skip(f"{missing} is not installed, or does not start")
    ours, *ours_amount = kernel(**kernels.SMALLEST[kernel])
    assert amount == ours_amount
    assert peers.difference(ours(), call()) < tolerance


def test_pairs_are_kernels():
    assert {kernel for pair in kernels.PAIRS for kernel in pair} <= set(kernels.KERNELS)


def test_a_timing_counts_every_call():
    calls = []
    timing = measured(lambda: calls.append(sum(range(100_000))), 3)
    assert len(calls) == 4 and len(timing.wall) == len(timing.cpu) == 3
    assert min(timing.wall) > 0 and timing.first > 0


def _row(seconds):
    return {"work": "5 steps", "cpu_seconds": seconds}


def test_tables_of_one_commit_join_in_one_file_and_compare_with_another(tmp_path, monkeypatch):
    monkeypatch.setattr(results, "git_commit", lambda: "aaaa")
    results.save({"kernels": {"one": _row(4.0), "other": _row(1.0)}}, tmp_path)
    results.save({"stages": {"surface": _row(2.0)}}, tmp_path)
    old = results.load("aa", tmp_path)
    assert old["stages"]["surface"]["cpu_seconds"] == 2.0 and old["kernels"]["one"]["cpu_seconds"] == 4.0
    monkeypatch.setattr(results, "git_commit", lambda: "bbbb")
    new = results.load(str(results.save({"kernels": {"one": _row(1.0), "other": {**_row(1.0), "work": "6 steps"}}},
                                        tmp_path)))
    lines = results.comparison(old, new)
    assert len(lines) == 2 and lines[1].split() == ["one", "4.0000", "1.0000", "4.00"]     # other work: not compared


def test_a_results_file_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(SystemExit, match="expected one results file, found 0"):
        results.load("cccc", tmp_path)
    (tmp_path / "dddd.json").write_text(json.dumps({"format": 0}))
    with pytest.raises(SystemExit, match="expected format 1, found 0"):
        results.load("dddd", tmp_path)
