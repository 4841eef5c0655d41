"""The stencil of a contact against the inverse compliance, and what a turn owes to it."""

import numpy as np
import pytest

from pipeline.physics.rough.contact.contact_steps import Path, stencil, weigh
from pipeline.physics.rough.contact.normal_contact import apply
from pipeline.physics.rough.layered_solid import half_space_compliance

SHAPE = (24, 20)
COMPLIANCE = half_space_compliance(SHAPE, (1.0, 1.2), 1.0, 0.3).normal


def everywhere(near, values):
    """What the stencil makes of a periodic map, node by node."""
    result = np.empty(values.size, values.dtype)
    around = np.zeros([n + 4 for n in values.shape], values.dtype)
    weigh(near.astype(values.dtype), values, np.arange(values.size), around, result)
    return result.reshape(values.shape)


@pytest.mark.exact
def test_stencil_is_the_kernel_of_the_inverse_compliance():
    waves = COMPLIANCE.copy()
    waves[0, 0] = waves.ravel()[1:].max()
    kernel = np.fft.irfft2(1.0 / waves, s=SHAPE)
    near = stencil(COMPLIANCE, SHAPE)
    offsets = [(y, x) for y in range(-2, 3) for x in range(-2, 3) if (y, x) != (0, 0)]
    assert [near[y + 2, x + 2] for y, x in offsets] == pytest.approx([min(kernel[o], 0.0) for o in offsets], abs=1e-15)
    assert near[2, 2] == pytest.approx(max(kernel[0, 0], 1.001 * (near[2, 2] - near.sum())))


@pytest.mark.exact
@pytest.mark.parametrize("shape", [SHAPE, (4, 32), (3, 3)])
def test_stencil_wraps_and_is_positive_definite(shape):
    compliance = half_space_compliance(shape, (1.0, 1.0), 1.0, 0.3).normal
    near, point = stencil(compliance, shape), np.zeros(shape)
    point[0, 0] = 1.0
    response = everywhere(near, point)
    assert response.sum() == pytest.approx(near.sum())
    assert np.fft.fft2(response).real.min() > 0.0
    assert response == pytest.approx(np.roll(response[::-1, ::-1], (1, 1), (0, 1)))
    moved = everywhere(near, np.roll(point, (-1, 1), (0, 1)))
    assert moved == pytest.approx(np.roll(response, (-1, 1), (0, 1)))


@pytest.mark.exact
def test_a_turn_is_downhill_without_a_mean_and_conjugate_to_the_one_before():
    random = np.random.default_rng(3)
    free = np.flatnonzero(random.random(COMPLIANCE.shape[0] * SHAPE[1]) < 0.3)
    path, distance = Path(stencil(COMPLIANCE, SHAPE), np.zeros(SHAPE)), random.standard_normal(free.size)
    slope = path.turn(free, distance)
    first, image = path.direction.copy(), apply(COMPLIANCE, path.direction)
    assert slope > 0.0
    assert abs(first.sum()) < 1e-12
    assert np.flatnonzero(first).tolist() == free.tolist()
    path.turn(free, distance - slope / np.vdot(image, first) * image.ravel()[free])
    assert abs(np.vdot(image, path.direction)) < 1e-12 * np.linalg.norm(image) * np.linalg.norm(path.direction)
