"""Spectra and bands keep the power of tones and noise."""

import numpy as np
import pytest

from pipeline.physics.signals.spectra import (
    LOWEST_LEVEL,
    a_weighting,
    band_power,
    level,
    power_spectrum,
    third_octave_bands,
)

RATE = 50e3
TIME = np.arange(50000) / RATE


@pytest.mark.exact
def test_tone_keeps_its_power():
    frequency, density = power_spectrum(3e-3 * np.sqrt(2) * np.sin(2 * np.pi * 2000 * TIME), RATE, 20.0)
    assert frequency[density.argmax()] == 2000
    assert density.sum() * (frequency[1] - frequency[0]) == pytest.approx(9e-6, rel=1e-6)


@pytest.mark.exact
def test_white_noise_is_flat():
    noise = np.random.default_rng(2).standard_normal((2, 50000))
    frequency, density = power_spectrum(noise, RATE, 50.0)
    np.testing.assert_allclose(density[:, 1:-1].mean(axis=1), 2 / RATE, rtol=0.02)


@pytest.mark.exact
def test_bands_of_noise_grow_with_their_width():
    frequency = np.arange(0, 25001, 20.0)
    middle = third_octave_bands(1250, 20000)
    power = band_power(frequency, np.ones((2, len(frequency))), middle)
    np.testing.assert_allclose(power, np.tile(middle * (10**0.05 - 10**-0.05), (2, 1)), rtol=1e-9)


def test_bands_are_those_of_the_standard():
    middle = third_octave_bands(1250, 20000)
    nominal = [1250, 1600, 2000, 2500, 3150, 4000, 5000, 6300, 8000, 10000, 12500, 16000, 20000]
    np.testing.assert_allclose(middle, nominal, rtol=0.015)


def test_short_signal_gives_one_segment():
    frequency, _ = power_spectrum(np.ones(100), RATE, 20.0)
    assert len(frequency) == 51


def test_levels():
    np.testing.assert_allclose(level(np.array([1e-18, 1e-6, 0]), 1e-9), [0, 120, LOWEST_LEVEL], atol=1e-12)


@pytest.mark.exact
@pytest.mark.parametrize("frequency, decibel", [(31.5, -39.4), (63, -26.2), (125, -16.1), (250, -8.6),
                                                (500, -3.2), (1000, 0.0), (2000, 1.2), (4000, 1.0),
                                                (8000, -1.1), (16000, -6.6)])
def test_a_weighting_is_that_of_the_standard(frequency, decibel):
    """Table 3 of IEC 61672-1 for the exact base-ten frequencies, rounded to .1 dB."""
    exact = 1000 * 10 ** (round(10 * np.log10(frequency / 1000)) / 10)
    assert 20 * np.log10(a_weighting(exact)) == pytest.approx(decibel, abs=0.05001)
