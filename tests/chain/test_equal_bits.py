"""Every chain gives the same bits with one worker, with two, and on a Dask cluster."""

import pytest

from tests.contract.executors.dask_processes import cluster
from tests.studies.kills import CASES, undisturbed

pytest.importorskip("distributed")
#: chains of seconds; the others take minutes three times over
QUICK = ("two_mode_flutter", "wobbling_disc", "belt")


@pytest.mark.slow
@pytest.mark.parametrize("case", [pytest.param(c, marks=() if c in QUICK else pytest.mark.study) for c in CASES])
def test_workers_change_no_bit(case, tmp_path):
    one = undisturbed(case, tmp_path / "one").content
    assert "report.html" in one and None not in one.values()
    assert undisturbed(case, tmp_path / "two", ("--workers", "2")).content == one
    with cluster(tmp_path / "workers") as address:
        assert undisturbed(case, tmp_path / "there", ("--scheduler", address)).content == one
