"""Scans that cannot be what their file states are asked back."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.rough.plausible_scan import in_true_unit, refuse_holes

WAVE = np.sqrt(2) * np.tile(np.sin(2 * np.pi * np.arange(32) / 32), (4, 1))


@pytest.mark.parametrize("height, guess", [(3e-3, "0.001 m"), (3.0, "1e-06 m"), (3e-10, "1000 m"), (1e3, "1 m")])
def test_heights_of_an_implausible_size_are_asked_back(height, guess):
    with pytest.raises(ConfigError, match=f"pad: expected an rms height Sq of 1 nm .* height_unit: {guess};"):
        in_true_unit(height * WAVE, None, "pad")


@pytest.mark.exact
def test_a_stated_unit_is_believed():
    np.testing.assert_array_equal(in_true_unit(3e-3 * WAVE, 1e-3, "pad"), 3e-3 * WAVE * 1e-3)
    np.testing.assert_array_equal(in_true_unit(3e-3 * WAVE, 1.0, "pad"), 3e-3 * WAVE)
    np.testing.assert_array_equal(in_true_unit(3e-6 * WAVE, None, "pad"), 3e-6 * WAVE)


def test_more_holes_than_heights_are_refused():
    missing = np.zeros((4, 4), bool)
    missing[:2] = True
    refuse_holes(missing, "pad")
    missing[2, 0] = True
    with pytest.raises(ConfigError, match="pad: expected measured heights on at least 50% .* found holes on 56%"):
        refuse_holes(missing, "pad")
