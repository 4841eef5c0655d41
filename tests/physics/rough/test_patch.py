"""Patches of a scan: periodic, with their variance, side by side."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.rough.generator import self_affine
from pipeline.physics.rough.patch import crops, periodic_patch, window


def test_a_patch_is_periodic_and_keeps_its_variance():
    long = self_affine(np.random.default_rng(6), 400, 400e-6, 10e-6, 40e-6, 0.8)
    patch = periodic_patch(long, (1e-6, 1e-6), 200e-6)
    assert patch.shape == (200, 200)
    inner = np.abs(np.diff(patch, axis=1)).max()
    assert np.abs(patch[:, 0] - patch[:, -1]).max() < 2.0 * inner
    assert patch[:20].std() == pytest.approx(patch[20:].std(), rel=0.3)
    np.testing.assert_array_equal(patch[60:, 60:], long[90 + 60:290, 90 + 60:290])


def test_a_patch_larger_than_the_scan_is_refused():
    with pytest.raises(ConfigError, match="shorten patch_length"):
        periodic_patch(np.zeros((96, 96)), (1e-6, 1e-6), 95e-6)


def test_a_window_is_where_the_patch_is_taken():
    heights = np.arange(100.0 * 80).reshape(100, 80)
    rows, columns = window(heights.shape, (1e-6, 2e-6), 40e-6, 0.1, (1.0, 0.0))
    assert rows == (56, 40, 4) and columns == (0, 20, 2)
    patch = periodic_patch(heights, (1e-6, 2e-6), 40e-6, 0.1, (1.0, 0.0))
    np.testing.assert_array_equal(patch[4:, 2:], heights[60:96, 2:20])


def test_crops_lie_side_by_side_or_in_the_middle():
    assert crops((100, 100), (1e-6, 1e-6), 80e-6, 1, "here") == [(0.5, 0.5)]
    assert crops((100, 100), (1e-6, 1e-6), 45e-6, 3, "here") == [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0)]
    with pytest.raises(ConfigError, match="here: expected at most 4, as many patches of 4.5e-05 m"):
        crops((100, 100), (1e-6, 1e-6), 45e-6, 5, "here")
