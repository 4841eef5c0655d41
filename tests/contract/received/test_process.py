"""A reader has its time of the clock, however little of the processor it takes; large files have more."""

import time

import pytest

from pipeline.contract import ConfigError
from pipeline.contract.received import process

pytestmark = pytest.mark.apart


def sleep(path, folder):
    """A reader that waits for what never comes, such as one that the machine leaves no processor."""
    time.sleep(900)


def test_a_reader_that_waits_is_stopped_by_the_clock(tmp_path, monkeypatch):
    (tmp_path / "a").write_bytes(b"a")
    monkeypatch.setattr(process, "_CLOCK", 2)
    begin = time.monotonic()
    with pytest.raises(ConfigError, match="expected a file that is read within 2 s of the clock, found a reader that is"
                                          " not done; the file is damaged, or too large"):
        process.answered(f"{__name__}:sleep", tmp_path / "a", lambda folder: pytest.fail("read"))
    assert time.monotonic() - begin < 60


@pytest.mark.parametrize("size, processor, least, most", [
    (0, 15, 60, 60), (999_999, 15, 60, 60), (50_000_000, 25, 120, 200), (2_000_000_000, 415, 3600, 7200)])
def test_small_files_have_a_minute_and_large_ones_have_more(size, processor, least, most):
    limits = process.Limits.of(size)
    assert limits.processor == processor and least <= limits.clock <= most
