"""Friction that really sticks: closed forms, an event-driven reference, its order, its null."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.time_stepping.elements import Dry, Element, Polynomial
from pipeline.physics.time_stepping.simulate import Hard, History, Penalty, Start, simulate
from tests.physics.lumps import lumps
from tests.physics.time_stepping.event_driven import Masses

MASS, STIFFNESS, FRICTION = 1.0, 400.0, 0.5
ROWS = np.array([[1.0, 0.0], [-1.0, 1.0]])
PAIR = {"mass": [1.0, 0.6], "stiffness": [900.0, 500.0], "damping": [2.0, 1.0]}


def rubbing(model, *laws, rows=((1.0,),)):
    return replace(model, elements=tuple(Element(f"element_{k}", np.array(row), law)
                                         for k, (row, law) in enumerate(zip(rows, laws, strict=True))))


def oscillator(*laws, damping=0.0):
    return rubbing(lumps([MASS], [[1.0]], [STIFFNESS], [damping]), *laws, rows=np.ones((len(laws), 1)))


def at(place, speed=0.0):
    return Start(np.array([place]), np.array([speed]))


def coulomb(force):
    return Dry(forward=force, backward=force)


def free_decay(time, begin, way):
    """Half swings about +-way, the way F / k of friction: straight decay, until rest within the dead band."""
    angular, x, amplitude, side = np.sqrt(STIFFNESS / MASS), np.full_like(time, np.nan), begin, 1.0
    for half in range(int(time[-1] * angular / np.pi) + 1):
        turned = angular * time - np.pi * half
        if amplitude <= way:
            x[turned >= 0] = side * amplitude
            return x
        inside = (turned >= 0) & (turned < np.pi)
        x[inside] = side * (way + (amplitude - way) * np.cos(turned[inside]))
        amplitude, side = amplitude - 2 * way, -side
        if amplitude < 0:
            amplitude, side = -amplitude, -side
    return x


@pytest.mark.exact
@pytest.mark.parametrize("steps", [15, 30, 50.3])
def test_a_free_oscillator_decays_straight_and_sticks_to_rounding_whatever_the_step(steps):
    period, begin, way = 2 * np.pi / 20, 0.0305, FRICTION / STIFFNESS
    motion = simulate(oscillator(coulomb(FRICTION)), Hard(), step=period / steps, duration=8 * period, start=at(begin))
    np.testing.assert_allclose(motion.displacement[0], free_decay(motion.time, begin, way), atol=1e-13 * begin)
    assert motion.displacement[0, -1] == pytest.approx(begin - 24 * way)
    assert motion.velocity[0, -1] == pytest.approx(0, abs=1e-14) and motion.imbalance < 1e-12


@pytest.mark.exact
def test_friction_of_two_sizes_stops_a_free_mass_after_its_way():
    """m v^2 / (2 F), and there it stays under a force below the larger limit."""
    model = rubbing(lumps([2.0]), Dry(forward=4.0, backward=8.0))
    for speed, limit in ((0.1, 4.0), (-0.1, 8.0)):
        motion = simulate(model, Hard(), step=7e-3, duration=0.35, start=at(0.0, speed))
        assert motion.displacement[0, -1] == pytest.approx(np.sign(speed) * 0.1**2 / limit, rel=1e-9)
        assert abs(motion.velocity[0, -1]) < 1e-12


@pytest.mark.exact
def test_den_hartogs_forced_oscillator_without_stops():
    """Amplitude of steady motion without viscous damping (Den Hartog, Trans. ASME 53 (1931) 107).

    x0 = (P0 / k) sqrt(V^2 - (U F / P0)^2), V = 1 / (1 - b^2), U = sin(pi / b) / (b (1 + cos(pi / b))), b = w / w_n.
    """
    ratio, push, friction = 0.8, 2.0, 0.5
    w = ratio * np.sqrt(STIFFNESS / MASS)
    period, steps, turns = 2 * np.pi / w, 40, 400
    force = History(push * np.cos(w * np.arange(steps * turns * 25 + 1) * period / steps / 25), period / steps / 25)
    motion = simulate(oscillator(coulomb(friction), damping=0.0), Hard(), step=period / steps / 5,
                      duration=turns * period, inputs=force, start=at(push / STIFFNESS / (1 - ratio**2)))
    v, u = 1 / (1 - ratio**2), np.sin(np.pi / ratio) / (ratio * (1 + np.cos(np.pi / ratio)))
    exact = push / STIFFNESS * np.sqrt(v**2 - (friction / push * u) ** 2)
    late = motion.displacement[0, -20 * 5 * steps:]
    assert abs(late).max() == pytest.approx(exact, rel=5e-4)


@pytest.mark.exact
def test_two_masses_that_stick_and_slide_in_two_joints_follow_an_event_driven_solver_to_order_three():
    knots = np.arange(61) * 0.01
    pushed = 3 * np.sin(8 * np.pi * knots) + np.sin(21.6 * np.pi * knots)
    load, limit = np.column_stack((0 * pushed, pushed)), (0.8, 0.5)
    masses = Masses(rows=ROWS, limit=np.array(limit), load=lambda t: np.array([0.0, np.interp(t, knots, pushed)]),
                    **{name: np.array(value) for name, value in PAIR.items()})
    exact = masses.motion(knots, np.zeros(4), breaks=knots)
    model = lumps(PAIR["mass"], ROWS, PAIR["stiffness"], PAIR["damping"])
    model = rubbing(model, *map(coulomb, limit), rows=ROWS)
    errors = []
    for parts in (1, 2, 4):
        motion = simulate(model, Hard(), step=0.01 / parts, duration=knots[-1], inputs=History(load, 0.01),
                          record_every=parts)
        errors.append(abs(motion.displacement - exact).max() / abs(exact).max())
    assert errors[0] < 1e-4 and errors[-1] < 2e-6
    assert np.all(np.log2(np.divide(errors[:-1], errors[1:])) > 2.5)
    rests = abs(motion.element_force) < 0.99 * np.reshape(limit, (2, 1))
    assert np.all(rests.mean(axis=1) > 0.03), "both joints stick at times"


@pytest.mark.exact
def test_friction_beside_a_cubic_spring_keeps_order_two():
    model = oscillator(coulomb(FRICTION), Polynomial(cubic=1e5))
    shown = [simulate(model, Hard(), step=0.01 / n, duration=0.6, start=at(0.05), record_every=n).displacement[0]
             for n in (1, 2, 4, 8, 200)]
    errors = [abs(x - shown[-1]).max() for x in shown[:-1]]
    np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), 2, atol=0.3)


@pytest.mark.exact
def test_more_friction_at_rest_than_at_speed_makes_a_pulled_mass_stick_and_slip():
    """A mass on a spring whose end moves at a small speed breaks away at F (1 + r)."""
    pull, law = History(np.array([0.0, 40.0]), 10.0), Dry(forward=2.0, backward=2.0, rise=0.5, decay_speed=0.01)
    motion = simulate(oscillator(law, damping=4.0), Hard(), step=5e-3, duration=3.0, inputs=pull)
    away = motion.time[np.flatnonzero(motion.displacement[0] > 1e-9)[0]]
    assert 0.75 < away < 0.755 + 1e-9
    assert motion.element_force.max() <= 3.0 * (1 + 1e-9)


@pytest.mark.exact
def test_a_force_that_jumps_sets_a_resting_mass_off_at_once():
    held = History(np.array([0.4, 0.9, 0.9]), 0.1, held=True)
    motion = simulate(rubbing(lumps([2.0]), coulomb(0.5)), Hard(), step=0.02, duration=0.2, inputs=held)
    gone = np.maximum(motion.time - 0.1, 0)
    np.testing.assert_allclose(motion.displacement[0], (0.9 - 0.5) / 2.0 * gone**2 / 2, atol=1e-15)


@pytest.mark.exact
@pytest.mark.parametrize("law", [Hard(), Penalty(4e4, 400.0)])
def test_beside_contacts_switches_are_taken_at_the_end_of_steps_and_the_order_is_one(law):
    """A mass on the ground, pressed on, that slides out along its other coordinate."""
    model = lumps([1.0, 1.0], [[1.0, 0.0]], [STIFFNESS], [0.0], [[0.0, 1.0]], [[0.0, 0.0]])
    model = rubbing(model, coulomb(FRICTION), rows=((1.0, 0.0),))
    period, way, errors = 2 * np.pi / 20, FRICTION / STIFFNESS, []
    for steps in (97, 970):
        motion = simulate(model, law, constant(0.0), step=period / steps, duration=6 * period, inputs=[0.0, -10.0],
                          start=Start(np.array([0.0305, 0.0]), np.zeros(2)))
        errors.append(abs(motion.displacement[0] - free_decay(motion.time, 0.0305, way)).max())
    assert errors[1] < 1e-4 * 0.0305 and errors[1] < 0.15 * errors[0]


@pytest.mark.exact
def test_friction_of_no_size_changes_no_bit():
    start = at(0.03)
    base, same = (simulate(oscillator(*laws, damping=1.0), Hard(), step=0.01, duration=1.0, start=start)
                  for laws in ((), (Dry(),)))
    np.testing.assert_array_equal(same.displacement, base.displacement)


def test_a_run_that_sticks_goes_on_where_another_ended():
    model, options = oscillator(coulomb(FRICTION)), {"step": 0.01, "start": at(0.004)}
    whole, half = (simulate(model, Hard(), duration=t, **options) for t in (0.8, 0.4))
    rest = simulate(model, Hard(), step=0.01, duration=0.4, start=half.end)
    np.testing.assert_allclose(rest.displacement[:, -1], whole.displacement[:, -1], atol=1e-15)
