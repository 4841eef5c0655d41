"""Offsets of two recorders of one stop, each with its own rate, begin, gain and noise."""

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.recordings.runs.offsets import offset_between
from pipeline.recordings.samples import channel

TRUE, BEGIN = 1.23456, 7.5
_WALK = np.cumsum(np.random.default_rng(2).standard_normal(5000)) / 50


def pulse(time):
    return ((time > 4.0) & (time < 4.021)).astype(float)


def pressure(time):
    return np.interp(time, [3.0, 3.4, 6.0, 6.3], [2.0, 20.0, 20.0, 2.0])


def rough_road(time):
    return np.interp(time, np.linspace(0, 10, 5000), _WALK)


def squeal(time):
    return np.sin(2 * np.pi * 1130 * time) * (abs(time - 4) < 0.5)


def knock(decay, frequency):
    def course(time):
        since = np.maximum(time - 4.0, 0.0)
        return np.exp(-decay * since) * np.sin(2 * np.pi * frequency * since)
    return course


def recorded(course, rate, begin, seconds, noise, gain=1.0, seed=0):
    time = begin + np.arange(round(seconds * rate)) / rate
    values = gain * (course(time) + noise * np.random.default_rng(seed).standard_normal(len(time)))
    return channel(values, "V", "voltage", rate, begin, "a"), values, time


@pytest.mark.parametrize("first, second, rates, noise, envelope", [
    (pulse, pulse, (8000, 100), 0.01, False), (pulse, pulse, (2000, 5120), 0.05, False),
    (pressure, pressure, (1000, 100), 0.1, False), (rough_road, rough_road, (1000, 500), 0.05, False),
    (squeal, squeal, (8000, 5120), 0.02, True), (knock(60, 900), knock(90, 1700), (8000, 10240), 0.01, True)])
def test_the_offset_is_found_within_its_uncertainty(first, second, rates, noise, envelope):
    """Pulses, ramps, noise-like loads, the same squeal, and a knock that two sensors answer in their own ways."""
    a, *_ = recorded(first, rates[0], 0.0, 8.0, noise)
    b, *_ = recorded(lambda t: second(t - BEGIN + 0.4 + TRUE), rates[1], BEGIN, 5.5, noise, gain=-30.0, seed=1)
    found = offset_between(a, b, "common")
    assert abs(found.offset - (TRUE + 0.4 - BEGIN)) < 3 * found.std and abs(found.correlation) > 0.6
    assert found.envelope == envelope and found.std < 0.6 / min(*rates, 1000 if envelope else np.inf)


def test_gaps_take_no_part():
    a, values, _ = recorded(pulse, 1000, 0.0, 8.0, 0.01)
    values[1000:2500] = np.nan
    holed = channel(values, "V", "voltage", 1000, 0.0, "a")
    b, values, time = recorded(lambda t: pulse(t + TRUE), 1000, 0.0, 6.0, 0.01, seed=1)
    values[time < 1.0] = np.nan
    found = offset_between(holed, channel(values, "V", "voltage", 1000, 0.0, "b"), "common")
    assert abs(found.offset - TRUE) < 3 * found.std


@pytest.mark.parametrize("first, second, noise, told", [
    (np.zeros_like, np.zeros_like, 1.0, "found a correlation of 0"),
    (lambda t: np.sin(20 * t), lambda t: np.sin(20 * t + 1), 0.01, "two offsets that fit alike"),
    (lambda t: pulse(t) + pulse(t + 2), pulse, 0.01, "two offsets that fit alike")])
def test_channels_that_do_not_tell_are_refused(first, second, noise, told):
    """Noise alone, a lasting tone, and a pulse that one of them saw twice."""
    a, *_ = recorded(first, 1000, 0.0, 8.0, noise)
    b, *_ = recorded(lambda t: second(t + 3.0), 500, 0.0, 1.5, noise, seed=1)
    with pytest.raises(ConfigError, match=f"common: .*{told}.*; name others under 'common', or state offset: SECONDS"):
        offset_between(a, b, "common")


@pytest.mark.parametrize("seconds", [120.0, 900.0])
def test_a_short_record_is_found_in_a_long_one(seconds):
    drive = np.random.default_rng(3).standard_normal(20_000)
    a, *_ = recorded(lambda t: np.interp(20 * t, np.arange(20_000), drive), 200, 0.0, seconds, 0.05)
    b, *_ = recorded(lambda t: np.interp(20 * (t + 70.0 + TRUE), np.arange(20_000), drive), 200, 0.0, 9.0, 0.05, seed=1)
    found = offset_between(a, b, "common")
    assert abs(found.offset - 70.0 - TRUE) < 3 * found.std


def test_long_records_are_averaged(monkeypatch):
    monkeypatch.setattr("pipeline.recordings.runs.offsets._MOST", 1 << 12)
    a, *_ = recorded(pressure, 2000, 0.0, 8.0, 0.1)
    b, *_ = recorded(lambda t: pressure(t + TRUE), 2000, 0.0, 6.0, 0.1, seed=1)
    found = offset_between(a, b, "common")
    assert abs(found.offset - TRUE) < 3 * found.std < 3 * 0.6 / 512
