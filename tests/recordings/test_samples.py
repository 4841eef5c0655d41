"""Channels in SI units on even grids."""

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.recordings.samples import channel, even_rate, interpolated, on_grid, stretch, stretches


def test_channels_are_in_si_and_know_what_is_missing():
    made = channel([1.0, np.nan, np.inf, 4.0], "mm/s", "velocity", 100.0, 0.5, "a", direction=(0, 0, 2))
    assert made.samples.tolist() == [1e-3, 0, 0, 4e-3] and str(made.unit) == "m/s"
    assert made.missing.tolist() == [[1, 3]] and made.direction.tolist() == [0, 0, 1]


@pytest.mark.parametrize("change, message", [
    ({"unit": "furlong per"}, "a: unit: expected a unit such as"), ({"values": [np.nan]}, "a: expected samples"),
    ({"direction": (0, 0, 0)}, "a: direction: expected three numbers that are not all 0"),
])
def test_refuses(change, message):
    given = {"values": [1.0], "unit": "m", "measures": "displacement", "rate": 1.0, "begin": 0.0, "where": "a"}
    with pytest.raises(ConfigError, match=message):
        channel(**{**given, **change})


def test_stretches_of_true():
    assert stretches(np.array([True, False, True, True])).tolist() == [[0, 1], [2, 4]]
    assert stretches(np.zeros(3, bool)).shape == (0, 2)


def test_times_give_the_rate_or_are_refused():
    assert even_rate(0.3 + np.arange(5) / 8, "t") == pytest.approx((8.0, 0.3))
    with pytest.raises(ConfigError, match="expected times at one even interval"):
        even_rate(np.array([0.0, 1.0, 2.0, 4.0]), "t")


def test_lost_samples_are_found_from_the_times():
    time = np.array([1.0, 1.1, 1.31, 1.4])
    columns, begin = on_grid({"x": np.array([5.0, 6.0, 7.0, 8.0])}, time, 10.0, "t")
    assert begin == 1.0 and np.isnan(columns["x"][2]) and columns["x"][[0, 1, 3, 4]].tolist() == [5, 6, 7, 8]
    for wrong in ([0.0, 0.14, 0.2], [0.0, 0.1, 0.1]):
        with pytest.raises(ConfigError, match="t: expected rising times on a grid of 10 Hz"):
            on_grid({}, np.array(wrong), 10.0, "t")
    for wrong in ([0.0, 0.1], [0.0, 0.1, np.nan], []):
        with pytest.raises(ConfigError, match="t: expected a finite time of every sample"):
            on_grid({"x": np.arange(3.0)}, np.array(wrong), 10.0, "t")


def test_neighbouring_stretches_share_no_sample():
    whole = channel([0.0, 1.0, np.nan, 3.0, 4.0], "m", "displacement", 10.0, 2.0, "a", place="pad")
    first, last = stretch(whole, None, 2.2, "a"), stretch(whole, 2.2, None, "a")
    assert first.samples.tolist() == [0, 1] and last.samples.tolist() == [0, 3, 4]
    assert last.missing.tolist() == [[0, 1]] and float(last.begin) == pytest.approx(2.2) and str(last.place) == "pad"
    with pytest.raises(ConfigError, match="expected a stretch within 2 s to 2.4 s, found 5 s"):
        stretch(whole, 5.0, 6.0, "a")


@pytest.mark.parametrize("lost", [2, 3])
def test_gaps_are_counted_in_whole_intervals_however_times_are_rounded(lost):
    """Two lost samples are joined, three are missing, and those beside them are not."""
    time = np.round(np.delete(np.arange(40) / 2048, slice(10, 10 + lost)), 6)
    spread, _ = interpolated({"x": 3 * time}, time, 2048.0, "a")
    assert np.flatnonzero(np.isnan(spread["x"])).tolist() == ([] if lost == 2 else [10, 11, 12])


def test_straight_lines_join_uneven_samples():
    time = np.array([0.0, 0.012, 0.019, 0.031, 0.04])
    spread, rate = interpolated({"x": 3 * time}, time, 100.0, "a")
    assert rate == 100 and spread["x"] == pytest.approx([0, 0.03, 0.06, 0.09, 0.12])
