"""Mean depth worn off a face, whatever its tilt and offset."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.rough.generator import self_affine
from pipeline.physics.rough.worn_depth import without_plane, worn_depth

NODES = 64


@pytest.fixture(scope="module")
def faces():
    return [without_plane(3e-6 * self_affine(np.random.default_rng(s), NODES, 1e-3, 1e-4, 3e-4, 0.8)) for s in (1, 2)]


def tilted(heights, seed, noise=0.0):
    random = np.random.default_rng(seed)
    y, x = np.meshgrid(*(np.linspace(-1, 1, n) for n in heights.shape), indexing="ij")
    return heights + 1e-6 + 3e-7 * x - 2e-7 * y + noise * random.standard_normal(heights.shape)


@pytest.mark.exact
@pytest.mark.parametrize("sign", [1, -1])
def test_cut_tops_are_found_but_for_tilt_and_offset(faces, sign):
    """What both faces together lift above a level is worn (or has grown): its mean is known."""
    top = sign * 0.2 * np.maximum(sum(faces) - np.quantile(sum(faces), 0.9), 0)
    found, error = worn_depth(tilted(faces[0], 1), tilted(faces[0] - top, 2), tilted(faces[1], 3))
    assert found == pytest.approx(top.mean(), rel=1e-9) and error < 1e-15


def test_the_error_is_that_of_the_noise(faces):
    """Of 60 maps with noise of 20 nm the depths scatter as the error says, within 3 / sqrt(120) of it."""
    found = np.array([worn_depth(tilted(faces[0], 100 + k, 20e-9), tilted(faces[0], 200 + k, 20e-9), faces[1])
                      for k in range(60)])
    assert np.std(found[:, 0]) == pytest.approx(found[:, 1].mean(), rel=0.27)
    assert abs(found[:, 0].mean()) < 3 * found[:, 1].mean() / np.sqrt(60)


def test_a_stroke_widens_what_counts_as_touched(faces):
    """A face that passed over three nodes wore what lay under any of them; nodes far from all stay the reference."""
    height = faces[0] + np.max([np.roll(faces[1], k, 1) for k in range(-3, 4)], axis=0)
    top = 0.2 * np.maximum(height - np.quantile(height, 0.4), 0)
    found, _ = worn_depth(faces[0], faces[0] - top, faces[1], 3)
    assert found == pytest.approx(top.mean(), rel=1e-9)
    assert worn_depth(faces[0], faces[0] - top, faces[1])[0] < 0.99 * top.mean()


@pytest.mark.exact
def test_a_plane_is_nothing(faces):
    np.testing.assert_allclose(without_plane(tilted(faces[0], 1)), without_plane(faces[0]), atol=1e-18)


def test_maps_of_other_pixels_are_refused(faces):
    with pytest.raises(ConfigError, match="same pixels"):
        worn_depth(faces[0], faces[0][:32])


def test_maps_of_different_areas_are_refused(faces):
    with pytest.raises(ConfigError, match=r"untouched depths that both maps show alike, found .* do not overlap"):
        worn_depth(faces[0], np.roll(faces[0], 20, axis=1), faces[1])


def test_a_face_worn_flat_is_still_the_same_area(faces):
    assert worn_depth(faces[0], np.minimum(faces[0], faces[0].min()))[0] > 0
