"""Foreign laws: energy where they keep it, and what each does that no known law does."""

import numpy as np
import pytest

from pipeline.blind_trial.generators.switching import foreign_laws
from tests.blind_trial.generators.switching.test_joint_laws import SPOT, TIME, decay, reached


@pytest.mark.exact
def test_elastic_ones_keep_the_energy_of_their_potential():
    motion = decay(foreign_laws.quintic(SPOT, 0.3), 0.012)
    x = motion.displacement[0]
    energy = motion.velocity[0] ** 2 + 400 * x**2 + 0.3 * 8 * 0.01 * (x / 0.01) ** 6 / 6
    np.testing.assert_allclose(energy, energy[0], rtol=1e-6)
    motion = decay(foreign_laws.magnet(SPOT, 0.3), 0.012)
    x, pole, gap = motion.displacement[0], 0.3 * 8, 0.025
    energy = motion.velocity[0] ** 2 + 400 * x**2 + pole * (gap / (1 - x / gap) - x)
    np.testing.assert_allclose(energy, energy[0], rtol=1e-6)


@pytest.mark.exact
def test_a_line_of_lags_passes_a_step_with_its_delay():
    law, = foreign_laws.lagging(SPOT, 1.0)
    delay = SPOT.between(0, 0.5, 1.5) / SPOT.angular
    z, area, step = np.zeros(law.states), 0.0, delay / 2000
    for _ in range(20_000):
        area += (1 - z[-1]) * step
        z = z + step * law.rates(0, 1.0, 0.0, z, 1)
    assert area == pytest.approx(delay, rel=1e-3) and z[-1] == pytest.approx(1.0)


@pytest.mark.exact
def test_friction_with_dead_time_feeds_energy_while_it_waits():
    """It turns ``wait`` after the slip: a swing from rest, pushed on at first, reaches farther than with Coulomb's."""
    law, = foreign_laws.dead_time(SPOT, 0.05)
    kinds = law.crossings(1)
    assert kinds[0].then == 2 and law.crossings(2)[0].then == -1 and law.crossings(2)[1].then == 1
    assert law.force(0, 0, 0, (), 2) == law.force(0, 0, 0, (), 1) == pytest.approx(0.4)
    wait, turn = SPOT.between(0, 0.2, 0.5) / SPOT.angular, np.pi / 20
    shift = 0.4 / 800           # from x = 0.02 at rest: F = +0.4 N until ``wait``, -0.4 N from then on
    x = -shift + (0.02 + shift) * np.exp(1j * 20 * wait)
    later = shift + (x.real - shift + 1j * x.imag) * np.exp(1j * 20 * (turn / 2 - wait))
    assert reached((law,), turn / 2) == pytest.approx(later.real, abs=1e-9)


@pytest.mark.exact
def test_liquid_that_sloshes_keeps_its_energy_but_for_its_loss():
    law, = foreign_laws.slosh(SPOT, 0.2)
    assert law.rates(0, 0, 0, np.array([np.pi, 0.0]), 1) == pytest.approx([0.0, 0.0], abs=1e-10)
    small = law.rates(0, 0, 0, np.array([1e-6, 0.0]), 1)
    assert -small[1] / 1e-6 == pytest.approx(SPOT.angular * SPOT.between(0, 0.7, 1.3), rel=1e-9)
    motion = decay((law,))
    energy = motion.velocity[0] ** 2 + 400 * motion.displacement[0] ** 2
    assert energy.max() <= energy[0] * (1 + 1e-9) and energy[-1] < 0.9 * energy[0]


@pytest.mark.exact
def test_a_clutched_spring_loses_its_own_energy_at_every_turn():
    """Away the stiffness is K + k, back K: peaks shrink by sqrt(K / (K + k))."""
    turn = np.pi / 20 / 2 + np.pi / np.sqrt(600.0) / 2
    assert reached(foreign_laws.switched_spring(SPOT, 0.5), turn) == pytest.approx(-0.02 / np.sqrt(1.5), rel=1e-6)


@pytest.mark.exact
def test_a_stop_is_hit_exactly_and_left_with_its_restitution():
    law, = foreign_laws.rigid_stop(SPOT, 3.0)
    gap, restitution = 0.008, SPOT.between(0, 0.3, 0.8)
    motion = decay((law,), -0.02, np.linspace(0, 0.4, 40_001))
    assert motion.displacement.max() <= gap * (1 + 1e-9)
    speed = 20 * np.sqrt(0.02**2 - gap**2)
    farthest = np.hypot(gap, restitution * speed / 20)
    assert -motion.displacement[0, 15_000:].min() == pytest.approx(farthest, rel=1e-6)


@pytest.mark.exact
def test_drags_lifts_clamps_and_thresholds_have_their_forces():
    root, = foreign_laws.root_drag(SPOT, 1.0)
    assert root.force(0, 0, -0.05, (), 1) == pytest.approx(-4.0)
    up, = foreign_laws.lift(SPOT, 1.0)
    assert up.force(0, 0, -0.2, (), 1) == up.force(0, 0, 0.2, (), 1) == pytest.approx(8.0)
    clamp, = foreign_laws.clamped(SPOT, 0.25)
    assert clamp.force(0, -0.01, 0.1, (), 1) == pytest.approx(2.02) == -clamp.limits(0, 0.01, ())[0]
    # friction in proportion to the way, and a little of Coulomb's: energy of K - k inwards is that of K + k outwards
    inwards = 300 * 0.02**2 - 0.02 * 0.02
    outwards = (-0.02 + np.sqrt(0.02**2 + 2000 * inwards)) / 1000
    swing = decay((clamp,), time=np.linspace(0, 0.2, 20_001)).displacement
    assert swing.min() == pytest.approx(-outwards, rel=1e-6)
    branch, = foreign_laws.threshold_flow(SPOT, 0.5)
    assert branch.rates(0, 0, 0.0, np.array([2.0]), 1) == pytest.approx(0.0)
    assert branch.rates(0, 0, 0.0, np.array([4.0]), 1) < 0


def test_random_impacts_are_those_of_their_shape():
    first, again = (foreign_laws.impacts(SPOT, 1.0)[0] for _ in range(2))
    forces = [[law.force(t, 0, 0, (), 1) for t in TIME] for law in (first, again)]
    assert forces[0] == forces[1] and np.any(forces[0]) and np.mean(np.array(forces[0]) == 0) > 0.8
