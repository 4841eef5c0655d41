"""Tones, chirps and noise of known begin, level and length."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.signals.frames import frames
from pipeline.physics.signals.squeal_detector import Detector, detect, loudest

RATE = 100e3
TIME = np.arange(100000) / RATE
#: reference 1 nm/s; the threshold is 1 mm/s
DETECTOR = Detector((1250.0, 20000.0), 120.0, 1e-9, 0.01, 0.75, 10.0, 30.0, 100.0, 0.01, 0.02, 400.0, 0.05, 0.1, 0.33)


def tone(frequency, root_mean_square, start=0.0, end=1.0):
    shown = np.searchsorted(TIME, (start, end))
    signal = np.zeros(len(TIME))
    signal[slice(*shown)] = np.sqrt(2) * root_mean_square * np.sin(2 * np.pi * frequency * TIME[slice(*shown)])
    return signal


def events(signal, detector=DETECTOR):
    return detect(frames(signal, RATE, detector), detector)


@pytest.mark.exact
@pytest.mark.parametrize("frequency", [1777.0, 9234.5, 16600.0, 17849.9])
def test_steady_tone(frequency):
    (event,) = events(tone(frequency, 4e-3))
    assert event.frequency == pytest.approx(frequency, abs=0.1)
    assert event.level == pytest.approx(20 * np.log10(4e6), abs=0.01)
    assert (event.start, event.duration) == (0, pytest.approx(1))


def test_begin_and_length_of_a_tone():
    """6 dB above the threshold the half-covered frame decides: the begin is unbiased, to a hop."""
    (event,) = events(tone(6543.0, 2e-3, 0.3, 0.7))
    assert event.start == pytest.approx(0.3, abs=0.0026)
    assert event.duration == pytest.approx(0.4, abs=0.0051)
    (loud,) = events(tone(6543.0, 0.5, 0.3, 0.7))
    assert 0.3 - DETECTOR.window / 2 - 0.0026 <= loud.start < event.start


def test_two_at_once_and_one_after():
    signal = tone(3000.0, 3e-3, 0.1, 0.5) + tone(8000.0, 5e-3, 0.3, 0.8) + tone(3000.0, 2e-3, 0.7, 0.9)
    found = events(signal)
    assert [round(e.frequency, -2) for e in found] == [3000, 8000, 3000]
    np.testing.assert_allclose([e.start for e in found], [0.1, 0.3, 0.7], atol=0.006)
    np.testing.assert_allclose([e.duration for e in found], [0.4, 0.5, 0.2], atol=0.012)


def test_growing_tone_begins_where_it_passes_the_threshold():
    growth = np.exp((TIME - 0.5) * 10)
    (event,) = events(1e-3 * np.sqrt(2) * growth * np.sin(2 * np.pi * 5000 * TIME))
    assert event.start == pytest.approx(0.5, abs=0.003)


def test_chirp_is_one_event():
    (event,) = events(3e-3 * np.sqrt(2) * np.sin(2 * np.pi * (4000 * TIME + 500 * TIME**2)))
    assert event.frequency == pytest.approx(4500, abs=30)
    assert event.duration == pytest.approx(1)


def test_short_gap_belongs_to_the_event_and_a_long_one_does_not():
    assert len(events(tone(5000, 3e-3, 0.2, 0.5) + tone(5000, 3e-3, 0.505, 0.8))) == 1
    assert len(events(tone(5000, 3e-3, 0.2, 0.5) + tone(5000, 3e-3, 0.55, 0.8))) == 2


def test_noise_below_the_threshold_gives_none():
    """Null test: each line of the noise is far below the threshold, though its total is not far."""
    noise = np.random.default_rng(0).standard_normal(len(TIME))
    assert events(1e-3 * noise) == []
    assert events(np.zeros(len(TIME))) == []


def test_tone_in_noise():
    noise = 1e-3 * np.random.default_rng(0).standard_normal(len(TIME))
    (event,) = events(noise + tone(7000, 2e-3, 0.2, 0.6))
    assert event.frequency == pytest.approx(7000, abs=5)
    assert event.start == pytest.approx(0.2, abs=0.006)


def test_tones_below_the_threshold_outside_the_band_or_too_short_give_none():
    assert events(tone(5000, 0.98e-3)) == []
    assert events(tone(1000, 5e-3)) == []
    assert events(tone(5000, 3e-3, 0.5, 0.505)) == []


def test_loudest_tone_is_told_below_the_threshold_too():
    signal = tone(5020.0, 1e-5) + tone(500.0, 1e-2)
    peak, frequency = loudest(frames(signal, RATE, DETECTOR), DETECTOR)
    assert peak == pytest.approx(80, abs=0.1)
    assert frequency == pytest.approx(5020, abs=1)


def related(signal):
    """{rounded frequency: (order, rounded fundamental)} of the events of a signal."""
    return {round(e.frequency): (e.order, round(e.fundamental)) for e in events(signal)}


@pytest.mark.exact
def test_harmonics_of_a_saturated_motion_with_its_fundamental_below_the_band():
    """sin + its first five harmonics, phase-locked, falling as a saturated motion's do; 812.5 Hz is no line."""
    order = np.arange(1, 6)
    signal = sum(20e-3 / n * np.sqrt(2) * np.sin(2 * np.pi * 812.5 * n * TIME + 0.3 * n**2) for n in order)
    found = {e.order: e for e in events(signal)}
    assert sorted(found) == [2, 3, 4, 5]
    for n, event in found.items():
        assert event.frequency == pytest.approx(812.5 * n, abs=0.5)
        assert event.fundamental == pytest.approx(812.5, abs=0.5)


@pytest.mark.exact
def test_saturation_itself_makes_the_odd_harmonics():
    """A clipped sine, clipped at half its height: order 3 is 14 dB below order 1 and has no step between."""
    signal = 40e-3 * np.clip(np.sin(2 * np.pi * 1530 * TIME), -0.5, 0.5)
    found = related(signal)
    assert found[1530] == (1, 1530) and found[4590] == (3, 1530)
    assert all(order % 2 for order, _ in found.values())


@pytest.mark.exact
def test_two_unrelated_tones_are_their_own():
    assert related(tone(1850, 5e-3) + tone(4387, 3e-3)) == {1850: (1, 1850), 4387: (1, 4387)}


@pytest.mark.exact
@pytest.mark.parametrize("frequency, order", [(1800.0, 1), (2430.0, 1), (2400.0, 3), (2418.0, 3)])
def test_an_inharmonic_ratio_to_a_tone_below_the_band(frequency, order):
    """Order 3 of 800 Hz is met to (3 + 1) * 0.05 * 100 Hz = 20 Hz; 2430 Hz is 30 Hz away."""
    found = related(tone(800, 10e-3) + tone(frequency, 3e-3))
    assert found == {round(frequency): (order, 800 if order > 1 else round(frequency))}


@pytest.mark.exact
def test_a_fundamental_must_be_there_at_the_same_time_and_strong():
    assert related(tone(800, 10e-3, 0, 0.4) + tone(1600, 3e-3, 0.5, 1)) == {1600: (1, 1600)}
    assert related(tone(800, 0.9e-3) + tone(1600, 3e-3)) == {1600: (1, 1600)}


@pytest.mark.exact
def test_a_fundamental_may_not_be_lower_than_the_lowest():
    """390 Hz shows on the line of 400 Hz; 1560 Hz is its order 4, which a chance of 13 % lets pass."""
    signal = tone(390, 10e-3) + tone(1560, 3e-3)
    for lowest, order in ((400.0, 1), (380.0, 4)):
        (event,) = events(signal, replace(DETECTOR, chance=0.15, lowest_fundamental=lowest))
        assert event.order == order


@pytest.mark.exact
def test_more_than_a_third_of_the_frames_must_tell_the_order():
    assert related(tone(800, 10e-3, 0, 0.4) + tone(1600, 3e-3)) == {1600: (2, 800)}
    assert related(tone(800, 10e-3, 0, 0.3) + tone(1600, 3e-3)) == {1600: (1, 1600)}


@pytest.mark.exact
def test_harmonics_follow_a_fundamental_that_drifts():
    phase = 2 * np.pi * (780 * TIME + 20 * TIME**2)
    (event,) = events(np.sqrt(2) * (10e-3 * np.sin(phase) + 3e-3 * np.sin(2 * phase)))
    assert (event.order, event.fundamental) == (2, pytest.approx(800, abs=2))


def test_the_accuracy_holds_beside_a_tone_that_is_30_db_stronger():
    """A strong tone eight lines away moves a frequency by at most the accuracy told, and by a tenth of it or more."""
    detector = replace(DETECTOR, threshold=110.0, range=40.0, drift=20.0, shortest=0.002, gap=0.0)
    errors = []
    for apart in np.linspace(800, 900, 9):
        for phase in np.linspace(0, np.pi, 5):
            weak = 30e-3 / 10**(30 / 20) * np.sqrt(2) * np.sin(2 * np.pi * (755 + apart) * TIME + phase)
            found = events((tone(755, 30e-3) + weak)[:2000], detector)
            errors += [abs(e.frequency - 755 - apart) for e in found if e.frequency > 1400]
    assert 0.1 < max(errors) * DETECTOR.window / DETECTOR.accuracy <= 1


def test_bad_input():
    with pytest.raises(ConfigError, match="shorter|at least"):
        frames(np.zeros(10), RATE, DETECTOR)
    with pytest.raises(ConfigError, match="half the sampling rate"):
        frames(np.zeros(100000), 30e3, replace(DETECTOR, window=0.1))
