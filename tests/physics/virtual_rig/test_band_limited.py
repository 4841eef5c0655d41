"""Tones between their samples, and what straight lines through refined samples make of them."""

import numpy as np
import pytest

from pipeline.physics.virtual_rig.band_limited import refined

COUNT, ENDS = 600, 100


def tone(frequency, parts=1):
    """A tone of ``frequency`` per sample (parts (COUNT - 1) + 1,) at ``parts`` times the rate."""
    return np.cos(2 * np.pi * frequency * np.arange((COUNT - 1) * parts + 1) / parts + 0.7)


def away(values, parts):
    """Values but for ENDS samples at either end."""
    return values[ENDS * parts:-ENDS * parts]


@pytest.mark.exact
@pytest.mark.parametrize("parts", [1, 2, 7])
@pytest.mark.parametrize("frequency", [0.01, 0.1, 0.3, 0.43])
def test_straight_lines_through_the_refined_samples_hold_the_tone(frequency, parts):
    seen = away(refined(tone(frequency), parts), parts)
    held = np.sinc(frequency / parts) ** 2 * seen
    np.testing.assert_allclose(held, away(tone(frequency, parts), parts), atol=1e-4)


@pytest.mark.exact
def test_a_straight_line_stays_one_to_its_ends():
    np.testing.assert_allclose(refined(np.arange(50.0), 4), np.arange(197) / 4, atol=1e-3)


def test_one_value_stays_one_value():
    assert refined(3.0, 5) == 3.0
    np.testing.assert_array_equal(refined([2.0], 5), [2.0])
