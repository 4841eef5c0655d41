"""Uneven time stamps: buses that jitter, loggers that lose samples, clocks that drift."""

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.recordings.runs.even_times import on_even_times
from pipeline.recordings.waveform import Waveform

RANDOM = np.random.default_rng(4)


def course(time):
    return 2.0 + np.sin(time)


def even(times, rate=None, **more):
    return on_even_times(Waveform(course(times), "bar", times=times, **more), rate, "a: line")


@pytest.mark.parametrize("interval, jitter, begin", [(0.01, 4e-4, 1.0), (0.02, 6e-3, -2.5), (0.1, 0.03, 1000.0)])
def test_a_bus_that_jitters_keeps_its_begin_and_its_values_at_every_instant(interval, jitter, begin):
    times = begin + interval * np.arange(400) + jitter * RANDOM.uniform(-1, 1, 400)
    made = even(times)
    assert made.times is None and made.begin == times[0] and made.rate == pytest.approx(1 / interval, rel=0.05)
    grid = made.begin + np.arange(len(made.values)) / made.rate
    assert grid[-1] == pytest.approx(times[-1], abs=1 / made.rate)
    inside = grid <= times[-1]
    np.testing.assert_allclose(made.values[inside], course(grid[inside]), atol=interval**2)
    assert inside.sum() >= len(grid) - 1 and "straight lines between them are read" in made.remark


def test_a_stated_rate_is_that_of_the_grid():
    times = 1.0 + np.cumsum(RANDOM.uniform(0.008, 0.012, 500))
    made = even(times, 50.0)
    assert made.rate == 50 and made.begin == times[0]
    np.testing.assert_allclose(made.values, course(made.begin + np.arange(len(made.values)) / 50), atol=1e-4)


def test_lost_samples_are_missing_and_none_moves():
    """Fast samples that were lost in packets, with stamps of a clock that drifts: what is there stays as it is."""
    kept = np.delete(np.arange(5000), np.r_[100:164, 3000:3064])
    times = 0.5 + kept / 25600 * (1 + 40e-6 * np.sin(kept / 2000)) + 2e-6 * RANDOM.uniform(-1, 1, len(kept))
    made = even(times)
    assert made.rate == pytest.approx(25600, rel=1e-4) and made.begin == times[0]
    np.testing.assert_array_equal(np.flatnonzero(np.isnan(made.values)), np.r_[100:164, 3000:3064])
    np.testing.assert_array_equal(made.values[kept], course(times))
    assert "128 of 5000 samples are missing" in made.remark and "s beside even ones at 25" in made.remark


def test_slow_samples_that_were_lost_are_missing_too():
    kept = np.delete(np.arange(300), [7, 8, 200])
    made = even(3 + kept / 100)
    assert np.flatnonzero(np.isnan(made.values)).tolist() == [7, 8, 200] and made.rate == pytest.approx(100)


def test_a_bus_that_was_silent_has_a_gap():
    times = np.cumsum(RANDOM.uniform(0.008, 0.012, 600))
    times[300:] += 0.7
    made = even(times)
    grid = made.begin + np.arange(len(made.values)) / made.rate
    silent = (grid > times[299] + 1e-3) & (grid < times[300] - 1e-3)
    assert np.isnan(made.values[silent]).all() and not np.isnan(made.values[~silent]).any()
    assert f"{silent.sum()} of {len(grid)} samples are missing" in made.remark


def test_precision_and_remarks_of_the_reader_stay():
    times = np.array([0.0, 0.01, 0.0202, 0.03, np.nan, 0.03, 0.0399])
    made = on_even_times(Waveform(np.arange(7, dtype=np.float32), times=times, remark="so"), None, "a")
    assert made.values.dtype == np.float32 and made.remark.startswith("so; 2 of 7 samples are left out")
    assert made.values[3] == pytest.approx(5)       # the last of those with one stamp


@pytest.mark.parametrize("times, told", [([0.0, 1.0, 0.5, 2.0], "1 that lie before the one before"), ([1.0], "found 1"),
                                         ([3.0, 3.0], "found 1")])
def test_times_that_tell_no_order_are_refused(times, told):
    with pytest.raises(ConfigError, match=f"a: line: expected two time stamps or more.*{told}"):
        even(np.array(times))


def test_even_samples_stay_as_they_are():
    one = Waveform(np.zeros(3), rate=10.0, begin=1.0)
    assert on_even_times(one, 20.0, "a") is one
    assert on_even_times(Waveform(np.zeros(3), begin=1.0), 20.0, "a").rate == 20
