"""The sensor chain: delay, gain, clipping, zero; noise of one size and colour; steps of the converter."""

import numpy as np
import pytest

from pipeline.blind_trial.generators.spring_mass.sensors import BITS, Chain, converted, noise

TIME = np.arange(100) / 100


def test_a_chain_shows_a_ramp_late_scaled_shifted_and_clipped():
    shown = Chain(delay=0.05, gain=2.0, offset=0.1, drift=1.0, limit=2.0).shown(TIME, TIME, TIME)
    np.testing.assert_allclose(shown, np.minimum(2 * np.maximum(TIME - 0.05, 0) + 0.1 + TIME, 2.0), atol=1e-12)


@pytest.mark.parametrize("colour", [0.0, 0.5])
def test_noise_has_its_size_and_colour(colour):
    made = noise(np.random.default_rng(0), 200000, colour)
    assert made.std() == pytest.approx(1.0, abs=0.02)
    assert made[1:] @ made[:-1] / (made @ made) == pytest.approx(colour, abs=0.02)


def test_the_converter_has_steps():
    shown = converted(TIME - 0.5, 1.0)
    step = 2 / 2**BITS
    assert np.abs(shown - (TIME - 0.5)).max() <= step / 2 and np.allclose(shown / step, np.round(shown / step))
