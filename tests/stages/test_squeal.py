"""Squeal events and levels of tones of known size."""

import io

import numpy as np
import pytest
import scipy

from pipeline.contract import ConfigError, Context, store
from pipeline.physics.signals.spectra import power_spectrum
from pipeline.products import Response
from stages.squeal import Settings, squeal
from tests.stages.two_processes import TwoProcesses
from tests.views.products_for_views import filled

RATE = 50e3
TIME = np.arange(10000) / RATE


def response(velocity):
    """Response with the sensors ``velocity`` (operating point, sensor, time)."""
    velocity = np.asarray(velocity, dtype=np.float32)
    frequency, spectrum = power_spectrum(velocity.astype(float), RATE, 50.0)
    return filled(Response, pressure=[1e6] * len(velocity), speed=[8.5] * len(velocity), coupling="disc", time=TIME,
                  velocity=velocity, frequency=frequency, velocity_spectrum=spectrum,
                  sensor_name=[str(s) for s in range(velocity.shape[1])])


def find(velocity, **settings):
    """Squeal of one operating point with the sensors ``velocity`` (sensor, time)."""
    return squeal(response([velocity]), settings=Settings.model_validate({"settling": "20 ms", **settings}))


def tone(frequency, root_mean_square, start=0.0):
    return np.where(start <= TIME, np.sqrt(2) * root_mean_square * np.sin(2 * np.pi * frequency * TIME), 0)


def test_tones_at_two_sensors():
    found = find([tone(16600, 2e-3), tone(4000, 1e-5) + tone(9000, 5e-3, 0.1)])
    assert found.threshold == pytest.approx(20 * np.log10(0.7e-3 / 1e-9))
    assert list(found.event_sensor) == [0, 1] and found.coupling == "disc"
    np.testing.assert_allclose(found.event_frequency, [16600, 9000], atol=5)
    np.testing.assert_allclose(found.event_level, 20 * np.log10([2e6, 5e6]), atol=0.1)
    np.testing.assert_allclose(found.event_start, [0.02, 0.1], atol=0.006)
    np.testing.assert_allclose(found.peak_level[0], found.event_level, atol=1e-9)
    band = found.band_level[0, 0, np.argmin(np.abs(found.band - 16000))]
    assert band == pytest.approx(20 * np.log10(2e6), abs=0.1)


def test_the_number_of_workers_changes_no_bit():
    points = response([[tone(16600, 2e-3)], [tone(9000, 5e-3, 0.1)], [tone(5000, 1e-5)]])
    one, two = (squeal(points, settings=Settings(), context=context) for context in (Context(), TwoProcesses()))
    assert len(one.event_level) == 2 and store.content_hash(one) == store.content_hash(two)


def test_a_harmonic_names_its_fundamental_below_the_band():
    """Fundamental of 810 Hz at one sensor; an own tone at the other."""
    found = find([tone(810, 10e-3) + tone(1620, 3e-3), tone(4000, 2e-3)])
    np.testing.assert_array_equal(found.event_order, [2, 1])
    np.testing.assert_allclose(found.event_fundamental, [810, 4000], atol=2)
    alone = find([tone(810, 10e-3) + tone(1620, 3e-3)], lowest_fundamental="1 kHz")
    assert alone.event_order == [1] and alone.event_fundamental == alone.event_frequency


def test_quiet_brake_has_levels_but_no_event():
    """Null test: below the threshold nothing squeals, and the loudest tone is still told."""
    found = find([tone(5000, 1e-5)])
    assert found.event_level.size == 0
    assert found.peak_frequency[0, 0] == pytest.approx(5000, abs=1)
    assert found.peak_level[0, 0] == pytest.approx(80, abs=0.1)


def test_settling_is_not_searched():
    burst = np.where(TIME < 0.015, tone(5000, 5e-3), 0)
    assert find([burst], shortest="5 ms").event_level.size == 0
    assert find([burst], shortest="5 ms", settling="0 s").event_level.size == 1


@pytest.mark.parametrize("settings, said", [({"settling": "1 s"}, "settling"), ({"window": "1 s"}, "at least"),
                                            ({"highest_frequency": "30 kHz"}, "half the sampling rate"),
                                            ({"lowest_frequency": "20 kHz"}, "lowest_frequency"),
                                            ({"lowest_fundamental": "2 kHz"}, "lowest_fundamental")])
def test_settings_that_do_not_fit_the_signals(settings, said):
    with pytest.raises(ConfigError, match=said):
        find([tone(5000, 1e-5)], **settings)


def heard(product):
    """(frequency of the strongest line in Hz, effective value in m/s) of what squeal.wav plays."""
    rate, samples = scipy.io.wavfile.read(io.BytesIO(squeal.companions(product)["squeal.wav"]))
    spectrum = np.abs(np.fft.rfft(samples * np.hanning(len(samples)), 2**20))
    middle = samples[len(samples) // 4:-len(samples) // 4]
    return spectrum.argmax() * rate / 2**20, middle.std() * product.listen["squeal"].full_scale / 32767


@pytest.mark.exact
def test_the_loudest_squeal_is_written_to_listen_to():
    """A motion of 0.2 s: its tones are held for 2 s at their levels, frequency within 1 Hz."""
    found = find([tone(4000, 2e-3), tone(2000, 3e-3) + tone(9000, 5e-3)])
    frequency, effective = heard(found)
    assert frequency == pytest.approx(found.event_frequency[found.event_level.argmax()], abs=1.0)
    assert frequency == pytest.approx(9000, abs=2) and effective == pytest.approx(np.hypot(3e-3, 5e-3), rel=0.02)
    assert found.listen["squeal"].content == "tones of the velocity at sensor 1, held for 2 s"
    assert squeal.companions(find([tone(5000, 1e-5)])) == {}


@pytest.mark.exact
def test_a_long_motion_is_listened_to_as_it_is(monkeypatch):
    monkeypatch.setattr("stages.squeal._HEARD", 0.05)
    found = find([tone(9000, 5e-3, 0.1)])
    frequency, effective = heard(found)
    assert frequency == pytest.approx(9000, abs=1.0) and effective == pytest.approx(5e-3, rel=0.02)
    assert 0.09 < found.listen["squeal"].begin < 0.11 and "from 0.0" in str(found.listen["squeal"].content)
