"""Motion by the exponential over a step, against its integration and closed forms."""

import numpy as np
import pytest

from pipeline.blind_trial.generators.spring_mass.hidden_laws import HIDDEN, Spot
from pipeline.blind_trial.generators.spring_mass.inserted_effect import Planted, built
from pipeline.blind_trial.generators.spring_mass.linear_motion import coarse, driven, linear, linear_world
from pipeline.blind_trial.generators.spring_mass.motion import World, moved
from pipeline.blind_trial.generators.spring_mass.rig import drawn


@pytest.mark.exact
@pytest.mark.parametrize("masses", [1, 3])
def test_the_exponential_moves_a_rig_as_its_integration_does(masses):
    random = np.random.default_rng(masses)
    rig, force = drawn(random, masses), random.standard_normal(100)
    found, other = linear(rig, force, 0.01, 40.0), moved(World(rig), force, 0.01, 40.0)
    np.testing.assert_allclose(found, other, atol=2e-5 * abs(other).max())


@pytest.mark.exact
@pytest.mark.parametrize("name", ["viscoelastic_pad", "shim_damping", "joint_damping", "moving_base", "coulomb"])
def test_a_world_that_is_linear_moves_as_its_integration_does(name):
    random = np.random.default_rng(4)
    rig, force = drawn(random, 3), random.standard_normal(100)
    spot = Spot(rig, 0, 0.01, 0.2, 3.0, 1.0, (0.3, 0.6, 0.9))
    world, _ = built(rig, (Planted(HIDDEN[name], "link_0", spot, 0.4),))
    found, other = linear_world(world, [force], 0.01, 40.0), moved(world, force, 0.01, 40.0)
    if name == "coulomb":
        assert found is None
    else:
        np.testing.assert_allclose(found[0], other, atol=2e-5 * abs(other).max())


@pytest.mark.exact
def test_a_double_root_moves_as_its_closed_form_does():
    """x'' + 2 x' + x = 1 from rest: x = 1 - (1 + t) exp(-t), the shapes of its two motions being one."""
    matrix, push = np.array([[0.0, 1.0], [-1.0, -2.0]]), np.array([0.0, 1.0])
    found = driven(matrix, push, np.ones(6), 0.5)[:, 0]
    time = np.linspace(0, 2.5, len(found))
    np.testing.assert_allclose(found, 1 - (1 + time) * np.exp(-time), atol=1e-12)


@pytest.mark.exact
def test_a_step_of_one_sample_is_off_by_the_square_of_the_sample():
    """Straight lines are off by x'' h^2 / 12 in the mean, behind a filter whose corner is far above the motion."""
    rig, errors = drawn(np.random.default_rng(2), 1), []
    for parts in (1, 2):
        force = np.sin(2 * np.pi * 1.5 * np.arange(200 * parts + 1) / (100 * parts))
        fine = linear(rig, force, 0.01 / parts, 15.0)[0]
        errors.append(np.sqrt(np.mean((coarse(rig, force, 0.01 / parts, 15.0)[0] - fine) ** 2) / np.mean(fine**2)))
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.1) and errors[0] > 1e-4
