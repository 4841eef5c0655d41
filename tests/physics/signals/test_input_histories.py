"""Shapes of histories in closed form, and recordings brought to equal intervals."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.signals import input_histories

TIME = np.linspace(0, 2, 20001)


@pytest.mark.exact
def test_a_chirp_passes_its_frequencies_on_time():
    """Turns up to t are f0 t + (f1 - f0) t^2 / (2 T): 15 zero crossings upwards in (0, 1] from 10 to 20 Hz."""
    signal = input_histories.chirp(TIME, 10.0, 20.0, 1.0)
    upwards = TIME[1:][(signal[:-1] < 0) & (signal[1:] >= 0)]
    assert np.count_nonzero(upwards < 1.001) == 15 and np.count_nonzero(upwards > 1.001) in (19, 20)
    np.testing.assert_allclose(np.diff(upwards[upwards > 1.01]), 1 / 20.0, atol=2e-4)


@pytest.mark.exact
def test_harmonic_and_step():
    assert input_histories.harmonic(np.array([0.0, 0.25]), 1.0, np.pi / 2) == pytest.approx([1.0, 0.0], abs=1e-12)
    assert list(input_histories.step(np.array([0.0, 0.5, 0.9, 1.0]), 0.5)) == [0, 1, 1, 1]
    assert input_histories.step(np.array([0.5, 0.6, 0.7, 2.0]), 0.5, 0.2) == pytest.approx([0.0, 0.5, 1.0, 1.0])


@pytest.mark.exact
def test_a_recording_is_read_linearly():
    instants = np.array([0.0, 0.7, 2.0])
    resampled = input_histories.resampled(TIME, instants, 3 * instants - 1, "here")
    np.testing.assert_allclose(resampled, 3 * TIME - 1, atol=1e-12)


@pytest.mark.parametrize(("instants", "values", "said"), [
    ([0.0, 1.5], [1.0, 2.0], "samples from 0 to 2 s, found 0 to 1.5 s"), ([0.0, 2.0], [1.0, np.nan], "finite"),
    ([0.0, 0.0, 2.0], [1.0, 1.0, 1.0], "rising"), ([0.0], [1.0], "1 samples")])
def test_what_is_no_recording_is_refused(instants, values, said):
    with pytest.raises(ConfigError, match=said):
        input_histories.resampled(TIME, np.array(instants), np.array(values), "here")
