"""Two modes that a rotation couples."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.physics.virtual_rig.force_residual import equation_residual
from pipeline.physics.virtual_rig.response import respond
from pipeline.physics.virtual_rig.roots import roots
from tests.effects.benches import round_disc, rubbing, struck

ORDER, SPEED, ROOT = 3.0, 1.5, 20.0
WAVES = np.sqrt(ROOT**2 + (ORDER * SPEED) ** 2) + ORDER * SPEED * np.array([-1, 1])


def turning(order=ORDER):
    return named("gyroscopic").on(round_disc(), "disc", {"order": order})


@pytest.mark.exact
@pytest.mark.parametrize("order", [ORDER, -ORDER])
def test_the_waves_with_and_against_the_rotation(order):
    for speed, exact in ((SPEED, WAVES), (0.0, ROOT)):
        np.testing.assert_allclose(np.sort(abs(roots(turning(order), struck(speed)).imag))[::2], exact, rtol=1e-9)


@pytest.mark.exact
@pytest.mark.parametrize("order", [ORDER, -ORDER])
def test_a_blow_turns_round_as_on_foucaults_pendulum(order):
    """x + i y = v (exp(i W1 t) - exp(-i W2 t)) / (i (W1 + W2)), its plane turning at n W."""
    run = struck(SPEED)
    slow, fast = WAVES
    exact = 0.1 * (np.exp(1j * fast * run.time) - np.exp(-1j * slow * run.time)) / (1j * (slow + fast))
    found = respond(turning(order), run)
    np.testing.assert_allclose(found["x"], exact.real, atol=1e-8)
    np.testing.assert_allclose(found["y"], np.sign(order) * exact.imag, atol=1e-8)


def test_its_own_motion_leaves_nothing():
    run = struck(SPEED)
    seen = respond(turning(), run)
    left, missed = (abs(equation_residual(b, run, seen, trim=5)).max() for b in (turning(), round_disc()))
    assert left < 1e-4 * missed


def test_coriolis_forces_do_no_work_whatever_the_masses():
    bench = named("gyroscopic").on(rubbing(), "tilt", {"order": 2.0})
    added = bench.model.gyroscopic
    np.testing.assert_array_equal(added, -added.T)
    assert added[1, 2] == pytest.approx(2 * 2.0 * np.sqrt(1.0 * 0.5))
