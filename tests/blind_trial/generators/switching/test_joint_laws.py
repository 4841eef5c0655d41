"""Known laws: what they dissipate and how they stretch a period, in closed form."""

import numpy as np
import pytest

from pipeline.blind_trial.generators.switching import joint_laws
from pipeline.blind_trial.generators.switching.event_motion import Mechanism, moved
from pipeline.blind_trial.generators.switching.joint_laws import Spot

SPOT = Spot(np.array([1.0]), 0.01, 0.2, 800.0, (0.3, 0.2, 0.6))
TIME = np.linspace(0, 2, 801)


def decay(laws, start=0.02, time=TIME):
    """Motion of 2 kg on 800 N/m, let go at ``start`` m."""
    rig = Mechanism(np.array([[2.0]]), np.zeros((1, 1)), np.array([[800.0]]), laws, 0.01, 0.2)
    return moved(rig, lambda t: np.zeros(1), time, np.array([start, 0.0]))


def reached(laws, instant, start=0.02):
    """Displacement at one instant."""
    return decay(laws, start, np.array([0.0, instant])).displacement[0, -1]


@pytest.mark.exact
@pytest.mark.parametrize("law, potential", [
    (joint_laws.cubic, lambda x: 0.4 * 8.0 * 0.01 * (x / 0.01) ** 4 / 4),
    (joint_laws.quadratic, lambda x: 0.4 * 8.0 * 0.01 * (x / 0.01) ** 3 / 3)])
def test_elastic_laws_keep_the_energy_of_their_potential(law, potential):
    motion = decay(law(SPOT, 0.4), 0.01)
    energy = motion.velocity[0] ** 2 + 400 * motion.displacement[0] ** 2 + potential(motion.displacement[0])
    np.testing.assert_allclose(energy, energy[0], rtol=1e-6)


@pytest.mark.exact
def test_quadratic_drag_shrinks_each_half_swing_by_its_first_integral():
    """With s = 2 c / M and E(x) = v^2: dE/dx = s E - 2 w^2 x on the way back: exact peaks."""
    motion = decay(joint_laws.drag(SPOT, 0.5), time=np.linspace(0, 0.2, 20_001))
    lost = 2 * (0.5 * 8.0 / 0.2**2) / 2.0
    peak = motion.displacement.min()

    def invariant(x):
        """(1 + s x) exp(-s x), equal at both ends of a swing to the left."""
        return (1 + lost * x) * np.exp(-lost * x)

    assert invariant(0.02) == pytest.approx(invariant(peak), rel=1e-6)


@pytest.mark.exact
def test_asymmetric_friction_takes_each_side_its_share():
    law, = joint_laws.asymmetric(SPOT, 0.1)
    forward, backward = law.limits(0, 0, ())[1], -law.limits(0, 0, ())[0]
    assert reached((law,), np.pi / 20) == pytest.approx(-(0.02 - 2 * backward / 800), rel=1e-7)
    assert forward / backward == pytest.approx((1 - 0.3 * (7 / 3) ** 0.3) ** -1 * (1 + 0.3 * (7 / 3) ** 0.3))


@pytest.mark.exact
def test_jenkins_elements_return_the_loop_of_masing():
    """Led through a cycle of amplitude X the loss is sum 4 f_i (X - f_i / k_i)+, and small strokes lose nothing."""
    law, = joint_laws.slipping(SPOT, 1.0)
    stiffness = 0.6 * 800 / 6
    limits = stiffness * 0.04 * (np.arange(6) + 0.5) / 6

    def led(amplitude, angular=20.0, mass=1e6):
        """A mass so heavy that its own spring alone sets the motion."""
        rig = Mechanism(np.array([[mass]]), np.zeros((1, 1)), np.array([[mass * angular**2]]), (law,), 0.01, 0.2)
        motion = moved(rig, lambda t: np.zeros(1), np.linspace(0, 2 * np.pi / angular, 4001),
                       np.array([0.0, amplitude * angular]))
        return motion.events, mass

    assert led(0.002)[0] == 0 and led(0.02)[0] > 4
    turns = np.linspace(0.03, -0.03, 1000)
    strokes = np.concatenate((np.linspace(0, 0.03, 500), turns, turns[::-1]))
    held, forces = np.zeros(6), []
    for step in np.diff(strokes):
        mode = tuple(int(np.sign(step)) if abs(h) >= f * (1 - 1e-9) and h * step > 0 else 0
                     for h, f in zip(held, limits, strict=True))
        held = np.clip(held + law.rates(0, 0, step, held, mode), -limits, limits)
        forces.append(held.sum())
    loop = np.sum(np.array(forces[499:]) * np.diff(strokes)[499:])
    expected = np.sum(4 * limits * np.maximum(0.03 - limits / stiffness, 0.0))
    assert loop == pytest.approx(expected, rel=1e-2)


@pytest.mark.exact
def test_a_maxwell_branch_relaxes_with_its_time():
    law, = joint_laws.relaxing(SPOT, 0.5)
    tau = SPOT.between(0, 0.5, 2.0) / SPOT.angular
    assert law.rates(0, 0.0, 0.0, np.array([3.0]), 1) == pytest.approx(-3.0 / tau)
    assert law.rates(0, 0.0, 0.2, np.zeros(1), 1) == pytest.approx(0.5 * 800 * 0.2)


@pytest.mark.exact
def test_bouc_wen_yields_at_its_displacement():
    law, = joint_laws.bouc_wen(SPOT, 1.0)
    assert law.rates(0, 0.0, 1.0, np.array([1.0]), 1) == pytest.approx(0.0)
    assert law.rates(0, 0.0, 1.0, np.zeros(1), 1) == pytest.approx(1 / 0.02)


@pytest.mark.exact
def test_a_moving_base_has_the_lower_mode_of_two_masses():
    law, = joint_laws.moving_base(SPOT, 0.5)
    held, heavy = 1600.0, 1600.0 / (20 * SPOT.between(0, 1.3, 2.2)) ** 2
    motion = decay((law,))
    stiffness, mass = np.array([[800.0, -800.0], [-800.0, 800.0 + held]]), np.array([2.0, heavy])
    squares, shapes = np.linalg.eig(stiffness / mass[:, None])
    expected = shapes @ np.diag(np.linalg.solve(shapes, [0.02, 0.0])) @ np.cos(np.sqrt(squares)[:, None] * TIME)
    np.testing.assert_allclose(motion.displacement[0], expected[0], atol=1e-7)


@pytest.mark.exact
def test_a_shaken_base_is_a_tone_and_viscous_friction_a_damper():
    law, = joint_laws.shaken_base(SPOT, 0.5)
    values = [law.force(t, 0, 0, (), 1) for t in np.linspace(0, 10, 2001)]
    assert max(values) == pytest.approx(4.0, rel=1e-3)
    motion = decay(joint_laws.viscous(SPOT, 0.1))
    rate = 0.1 * 8 / 0.2 / 4
    angular = np.sqrt(400 - rate**2)
    expected = 0.02 * np.exp(-rate * TIME) * (np.cos(angular * TIME) + rate / angular * np.sin(angular * TIME))
    np.testing.assert_allclose(motion.displacement[0], expected, atol=1e-8)
