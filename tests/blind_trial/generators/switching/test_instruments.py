"""Sensors: the stated filter is that of the Bessel filter to third order; faults, noise, gaps and units."""

import numpy as np
import pytest

from pipeline.blind_trial.generators.switching.event_motion import Motion
from pipeline.blind_trial.generators.switching.instruments import Sensor, filtered, gaps, noise, written

FINE = np.linspace(0, 3, 30_001)
TIME = np.linspace(0, 3, 301)


@pytest.mark.exact
def test_the_filter_delays_a_tone_as_bessel_says_and_as_it_is_stated():
    tau, angular = 2e-3, 2 * np.pi * 5
    s = 1j * angular * tau
    answer = 3 / (3 + 3 * s + s**2)
    shown = filtered(np.sin(angular * FINE), FINE[1], tau)[20_000:]
    np.testing.assert_allclose(shown, np.imag(answer * np.exp(1j * angular * FINE[20_000:])), atol=1e-6)
    sensor = Sensor("ch1", 0, "displacement", "mm", tau)
    stated = np.exp(-1j * angular * sensor.stated_delay) / (1 + 1j * angular / (2 * np.pi * sensor.stated_corner))
    assert abs(stated - answer) < 0.1 * abs(s) ** 3


def test_a_sensor_shows_its_body_with_gain_delay_limit_and_drift():
    course = np.sin(2 * np.pi * 2 * FINE)
    motion = Motion(course[None], 0 * course[None], 0 * course[None], 0)
    plain = Sensor("ch1", 0, "displacement", "um", 1e-4)
    np.testing.assert_allclose(plain.shown(motion, FINE, TIME)[50:], np.sin(4 * np.pi * (TIME[50:] - 1e-4)), atol=1e-4)
    late = Sensor("ch1", 0, "displacement", "um", 1e-4, gain=2.0, delay=0.01, offset=0.5, drift=0.1)
    np.testing.assert_allclose(late.shown(motion, FINE, TIME)[50:],
                               2 * np.sin(4 * np.pi * (TIME[50:] - 0.0101)) + 0.5 + 0.1 * TIME[50:], atol=2e-4)
    assert abs(Sensor("ch1", 0, "displacement", "m", 1e-4, limit=0.6).shown(motion, FINE, TIME)).max() == 0.6
    assert Sensor("a", 0, "acceleration", "g", 1e-4).per_unit == 9.80665 and plain.si == "m"


@pytest.mark.exact
def test_noise_has_its_size_and_colour():
    drawn = noise(np.random.default_rng(1), 200_000, 0.3)
    assert np.std(drawn) == pytest.approx(1.0, rel=0.01)
    assert np.corrcoef(drawn[1:], drawn[:-1])[0, 1] == pytest.approx(0.3, abs=0.01)


def test_what_is_written_has_steps_units_and_gaps():
    random = np.random.default_rng(3)
    samples = random.standard_normal(1000)
    missing = gaps(random, 1000, "uneven")
    shown = written(samples, 1e-3, missing)
    assert np.isnan(shown[missing]).all() and 0.25 < missing.mean() < 0.6
    np.testing.assert_allclose(shown[~missing] * 1e-3, samples[~missing], atol=1.3 * abs(samples).max() / 2**16)
    assert not gaps(random, 100, "").any() and 0 < gaps(random, 1000, "bursts").sum() <= 120
