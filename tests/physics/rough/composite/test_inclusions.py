"""Where particles are: their share, their size, a picture."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.rough.composite.inclusions import of_image, spheres

SHAPE, SPACING, DEPTH = (48, 64), (1.0, 1.0), np.arange(33.0)


@pytest.mark.parametrize("share", [0.1, 0.4])
def test_spheres_fill_their_share_of_the_volume(share):
    inside = [spheres(SHAPE, SPACING, DEPTH, share, 8.0, seed) for seed in range(8)]
    shares = np.array([each.mean() for each in inside])
    assert shares.mean() == pytest.approx(share, abs=4 * shares.std(ddof=1) / np.sqrt(8))
    faces = np.array([[each[0].mean(), each[-1].mean()] for each in inside])
    np.testing.assert_allclose(faces.mean(axis=0), share, atol=4 * faces.std(ddof=1) / np.sqrt(8))


def test_a_sphere_has_its_volume_and_goes_on_across_the_edges():
    seed = next(s for s in range(200) if spheres(SHAPE, SPACING, DEPTH, 0.004, 8.0, s)[4:-4].any(axis=(1, 2)).sum() > 0)
    inside = spheres(SHAPE, SPACING, DEPTH, 0.004, 8.0, seed)
    rolled = np.roll(inside, (7, 9), (1, 2))
    assert rolled.sum() == inside.sum() > 0
    np.testing.assert_array_equal(inside, spheres(SHAPE, SPACING, DEPTH, 0.004, 8.0, seed))
    for layer in inside:
        assert layer.sum() <= 1.2 * np.pi * 4**2 * 3


def test_particles_smaller_than_the_grid_and_beyond_count_are_refused():
    with pytest.raises(ConfigError, match="two nodes"):
        spheres(SHAPE, SPACING, DEPTH, 0.1, 1.5, 1)
    with pytest.raises(ConfigError, match="particles"):
        spheres((400, 400), SPACING, np.arange(401.0), 0.8, 2.0, 1)


def test_a_picture_is_stretched_over_the_patch():
    inside = of_image([[0, 200], [255, 10]], (4, 6), 5, 2)
    np.testing.assert_array_equal(inside[0], np.kron([[0, 1], [1, 0]], np.ones((2, 3))))
    assert inside[1].any() and not inside[2:].any()


@pytest.mark.parametrize("image", [np.ones((3, 3)), np.zeros((2, 2, 3)), [[0, np.nan]]])
def test_pictures_of_one_phase_are_refused(image):
    with pytest.raises(ConfigError, match="two phases"):
        of_image(image, (4, 4), 3, 1)
