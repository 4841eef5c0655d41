"""What values cannot explain: the linear rig against its integration, d against closed forms."""

import numpy as np
import pytest

from pipeline.trial.detectable import Explained, coarse, linear, of_rig, whitened
from pipeline.trial.motion import World, moved
from pipeline.trial.planted import Recorder
from pipeline.trial.rig import drawn

NOISE = np.array([1e-3, 2e-3])


def explained(spread=0.25):
    random = np.random.default_rng(1)
    forces = tuple(random.standard_normal((2, 150)))
    rig = drawn(random, 2)
    recorder = Recorder(forces, 100.0, np.ones(2), 2.5e-3, 40.0)
    return of_rig(recorder, rig, 2, spread, 0.005), rig, recorder


@pytest.mark.exact
@pytest.mark.parametrize("masses", [1, 3])
def test_the_exponential_moves_a_rig_as_its_integration_does(masses):
    random = np.random.default_rng(masses)
    rig, force = drawn(random, masses), random.standard_normal(100)
    found, other = linear(rig, force, 0.01, 40.0), moved(World(rig), force, 0.01, 40.0)
    np.testing.assert_allclose(found, other, atol=2e-5 * abs(other).max())


@pytest.mark.exact
def test_a_step_of_one_sample_is_off_by_the_square_of_the_sample():
    """Straight lines are off by x'' h^2 / 12 in the mean, behind a filter whose corner is far above the motion."""
    rig, errors = drawn(np.random.default_rng(2), 1), []
    for parts in (1, 2):
        force = np.sin(2 * np.pi * 1.5 * np.arange(200 * parts + 1) / (100 * parts))
        fine = linear(rig, force, 0.01 / parts, 15.0)[0]
        errors.append(np.sqrt(np.mean((coarse(rig, force, 0.01 / parts, 15.0)[0] - fine) ** 2) / np.mean(fine**2)))
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.1) and errors[0] > 1e-4


@pytest.mark.exact
def test_a_change_that_nothing_explains_keeps_its_size():
    own, _, _ = explained()
    change = np.ones((2, 2, 150)) * NOISE[:, None]
    assert Explained(0 * own.directions).left(change, NOISE) == pytest.approx(np.sqrt(600))


@pytest.mark.exact
def test_a_change_by_one_value_is_left_as_far_as_its_prior_holds_it():
    """r = J u alone: d^2 = |r|^2 / (1 + |J|^2)."""
    own, _, _ = explained()
    own = Explained(own.directions[:1])
    whole = np.sum(whitened(own.directions, NOISE, 0.0) ** 2)
    assert own.left(2 * own.directions[0], NOISE) == pytest.approx(np.sqrt(4 * whole / (1 + whole)))


def test_another_stiffness_is_explained_and_another_motion_is_not():
    own, _, _ = explained()
    stiffer = own.directions[2] * 0.1
    assert own.left(stiffer, NOISE) < 0.11
    odd = np.random.default_rng(3).standard_normal(stiffer.shape) * np.sqrt(np.mean(stiffer**2))
    assert own.left(odd, NOISE) > 0.9 * np.sqrt(np.sum((odd / NOISE[:, None]) ** 2))


@pytest.mark.exact
def test_coloured_noise_is_white_after_whitening():
    colour, random = 0.6, np.random.default_rng(0)
    samples = [random.standard_normal()]
    for _ in range(20000):
        samples.append(colour * samples[-1] + np.sqrt(1 - colour**2) * random.standard_normal())
    white = whitened(np.array([samples]), [1.0], colour)[0]
    assert white.std() == pytest.approx(1, abs=0.02) and abs(white[1:] @ white[:-1] / (white @ white)) < 0.02
