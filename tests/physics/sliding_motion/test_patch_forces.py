"""Forces of patches: those of the laws as they are written down, with their derivatives."""

import numpy as np
import pytest

from pipeline.physics.friction.dry_friction import Friction
from pipeline.physics.sliding_motion.patch_forces import beyond_linear, linear_forces
from tests.physics.sliding.test_equilibrium import random_model, rising_friction
from tests.physics.sliding_motion.small_motion import LAW, contact_force, sliding, steady_friction

pytestmark = pytest.mark.exact


@pytest.fixture(scope="module", params=[1.3, -1.3])
def moving(request):
    return random_model(request.param), *sliding(random_model(request.param))


def forces(system, y):
    """(forces beyond the linear ones (3, p), their derivatives (3, 4, p)) at ``y`` (4, p)."""
    rest, slope = np.zeros((3, y.shape[1])), np.zeros((3, 4, y.shape[1]))
    beyond_linear(system.patches, y, rest, slope)
    return rest, slope


@pytest.mark.parametrize("size", [1e-8, 1e-7, 1e-6])
def test_patches_of_one_contact_have_the_forces_of_the_laws(moving, size):
    model, about, system = moving
    contacts, pressed = model.contacts, about.contacts.preload
    steady = contacts.normal.T @ pressed + contacts.tangent.T @ (
        about.direction() * steady_friction(about).coefficient * pressed)
    rest = np.linalg.solve(model.stiffness, 100.0 * model.input_rows[0] + steady)
    rng = np.random.default_rng(1)
    place, velocity = size * rng.standard_normal(12), 5e3 * size * rng.standard_normal(12)
    order = np.argsort(np.abs(system.patches.load[:, None] - pressed).argmin(axis=1))
    rows = [each[np.abs(system.patches.load[:, None] - pressed).argmin(axis=1)]
            for each in (contacts.normal, contacts.tangent, contacts.lateral)]
    y = np.array([rows[0] @ place, *(each @ velocity for each in rows)])
    whole = forces(system, y)[0] + np.array([linear_forces(system.patches, i, y) for i in range(len(order))]).T
    direct = contact_force(model, LAW, Friction(rising_friction(), distance=0.5), rest + place, velocity) - steady
    np.testing.assert_allclose(sum(r.T @ f for r, f in zip(rows, whole, strict=True)), direct,
                               atol=2e-4 * abs(direct).max())


def test_derivatives_are_those_of_the_forces(moving):
    _, _, system = moving
    rng = np.random.default_rng(5)
    y = np.array([2e-7, 1e-2, 0.3, 0.3])[:, None] * rng.standard_normal((4, len(system.patches.load)))
    slope = forces(system, y)[1]
    for column, step in enumerate((1e-8, 1e-5, 1e-5, 1e-5)):
        more, less = y.copy(), y.copy()
        more[column] += step
        less[column] -= step
        numerical = (forces(system, more)[0] - forces(system, less)[0]) / (2 * step)
        scale = abs(numerical).max() + abs(system.patches.linear).max() * 1e-6
        np.testing.assert_allclose(slope[:, column], numerical, atol=0.01 * scale)
