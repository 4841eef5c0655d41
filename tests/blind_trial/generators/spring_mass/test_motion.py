"""Motion of rigs: closed forms of a linear mass, of dry friction, of an impact and of a law with a state."""

import numpy as np
import pytest

from pipeline.blind_trial.generators.spring_mass.motion import PARTS, Law, World, moved
from pipeline.blind_trial.generators.spring_mass.rig import Link, Rig

INTERVAL, SAMPLES = 0.01, 200
TIME = INTERVAL / PARTS * np.arange(PARTS * (SAMPLES - 1) + 1)
#: a filter so fast that it shows the motion itself, 1e-5 s late
OPEN = 1e5 / (2 * np.pi)


def pushed(rig, force, **world):
    return moved(World(rig, **world), force, INTERVAL, OPEN)[0]


@pytest.mark.exact
def test_a_step_on_a_damped_mass():
    rate, ratio = 12.0, 0.05
    damped = rate * np.sqrt(1 - ratio**2)
    found = pushed(Rig((2.0,), (Link(0, -1, 2 * rate**2, 4 * ratio * rate),)), np.ones(SAMPLES))
    decay = np.exp(-ratio * rate * TIME)
    exact = (1 - decay * (np.cos(damped * TIME) + ratio * rate / damped * np.sin(damped * TIME))) / (2 * rate**2)
    np.testing.assert_allclose(found, exact, atol=3e-4 * exact.max())


@pytest.mark.exact
def test_a_free_mass_against_dry_friction():
    law = Law(np.ones(1), lambda t, e, v, z: 0.4 * np.tanh(v / 1e-4))
    found = pushed(Rig((2.0,), ()), np.ones(SAMPLES), laws=(law,))
    np.testing.assert_allclose(found, 0.5 * 0.3 * TIME**2, atol=1e-3 * 0.15 * TIME[-1] ** 2)


@pytest.mark.exact
def test_a_branch_that_relaxes_pulls_as_a_damper_once_it_is_stretched():
    """z' = k v - z / tau under a steady push: z -> k tau v, a damper of k tau."""
    law = Law(np.ones(1), lambda t, e, v, z: z[0], 1, lambda t, e, v, z: np.array([500.0 * v - z[0] / 0.01]))
    found = pushed(Rig((0.1,), ()), np.ones(SAMPLES), laws=(law,))
    assert np.gradient(found, TIME)[-1] == pytest.approx(1 / 5.0, rel=1e-3)


@pytest.mark.exact
def test_a_mass_that_bounces_comes_back_with_its_share_of_speed():
    def jump(x, v):
        return -0.7 * v if x[0] > 0.05 and v[0] > 0 else v

    force = np.where(np.arange(SAMPLES) < 10, 1.0, 0.0)
    speed = np.gradient(pushed(Rig((1.0,), ()), force, jump=jump), TIME)
    before = speed[30 * PARTS]
    assert speed[-1] == pytest.approx(-0.7 * before, rel=1e-6) and before == pytest.approx(0.095, rel=1e-2)


def test_mass_over_time():
    found = pushed(Rig((1.0,), ()), np.ones(SAMPLES), mass=lambda t: np.array([1 + t]))
    exact = (1 + TIME) * np.log1p(TIME) - TIME
    np.testing.assert_allclose(found, exact, atol=1e-4)
