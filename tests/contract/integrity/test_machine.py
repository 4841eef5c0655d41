"""What the machine refuses: a folder that cannot be written, a disk that is full, files that may not grow."""

import os
import resource
import signal

import numpy as np
import pytest

from pipeline.contract import Context, ProductError, case, runner, store
from tests.contract.toy import CHAINS, load
from tests.contract.toy.products import Inner


@pytest.fixture
def job(tmp_path):
    (tmp_path / "toy.yaml").write_text("chain: toy\n")
    return runner.ChainRun(case.load(tmp_path / "toy.yaml", CHAINS, load), tmp_path / "run", "superlu")


def test_an_up_to_date_folder_on_a_read_only_mount(job, monkeypatch):
    assert job.execute(Context()) == 2

    def refused(path, flags, *rest, before=os.open):
        if flags & (os.O_WRONLY | os.O_RDWR):
            raise OSError(30, "Read-only file system", path)
        return before(path, flags, *rest)

    monkeypatch.setattr(os, "access", lambda path, mode: not mode & os.W_OK)
    monkeypatch.setattr(os, "open", refused)
    reported = []
    assert job.execute(Context(), report=lambda state, seconds: reported.append(seconds)) == 0
    assert reported == [None, None]
    with pytest.raises(ProductError, match="a run folder that can be written, found"):
        job.execute(Context(), force={"source"})


def test_a_limit_of_file_sizes_leaves_no_partial_file(tmp_path):
    """``ulimit -f`` and a full disk: one sentence, and the old product stays."""
    path, limits = tmp_path / "inner.h5", resource.getrlimit(resource.RLIMIT_FSIZE)
    store.write(Inner(position=np.ones((3, 3))), path, {})
    whole, before = path.read_bytes(), signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, limits[1]))
    try:
        with pytest.raises(ProductError, match="expected a file that can be written"):
            store.write(Inner(position=np.ones((100_000, 3))), path, {})
        with pytest.raises(ProductError, match="expected a file that can be written"):
            store.write_companion(tmp_path / "a.csv", "x" * 200_000)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        signal.signal(signal.SIGXFSZ, before)
    assert path.read_bytes() == whole and [p.name for p in tmp_path.iterdir()] == ["inner.h5"]
