"""Steady sliding: closed forms of a rubbed block, null tests, and the linearisation against the nonlinear forces."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.contact.static_preload import solve_preload
from pipeline.physics.friction.friction_table import FrictionLaw
from pipeline.physics.pads.pad_system import pad_system
from pipeline.physics.pads.sliding_pads import linearised
from pipeline.physics.sliding.equilibrium import (
    ClosureResponse,
    closure_response,
    displacement,
    falling_with_speed,
    from_map,
    given_state,
    model_about,
    steady_sliding,
)
from pipeline.physics.sliding.model import Contacts, FrictionState, Joints, SlidingModel

pytestmark = pytest.mark.exact
AREA, LOAD, HALF, HEIGHT = 1e-4, 100.0, 0.02, 0.01
CURVED = np.linspace(0, 4e-6, 30), 2e11 * np.linspace(0, 4e-6, 30) + 1e17 * np.linspace(0, 4e-6, 30) ** 2


def sliding_model_of(stiffness, damping, normal, tangent, lateral, inputs, speed, names=("pad",), body=None):
    """A SlidingModel of unit masses with one joint that does nothing and contacts on the circle of radius 1."""
    size, count = len(stiffness), len(normal)
    none, ones = np.zeros((size, size)), np.ones(count)
    angle = np.linspace(-0.5, 0.5, count)
    contacts = Contacts(normal, tangent, lateral, np.column_stack((np.cos(angle), np.sin(angle), 0 * angle)),
                        AREA * ones, ones, LOAD / count * ones, 1e7 * ones, 0 * ones)
    return SlidingModel(names, np.zeros(size, int) if body is None else body, np.eye(size), damping, none, stiffness,
                        none, Joints(("idle",), np.zeros((1, size)), np.zeros(1), np.zeros(1)), contacts, ("press",),
                        inputs, (), np.empty((0, size)), speed)


def rubbed_block(speed=1.0, tilt=0.0):
    """Rigid block on two contacts at +-HALF, pressed by LOAD and tied along sliding at HEIGHT above them.

    Coordinates: along sliding, away from the disc, rotation (radians) on a spring ``tilt``.
    """
    normal = np.array([[0.0, 1.0, HALF], [0.0, 1.0, -HALF]])
    tangent = np.array([[1.0, 0.0, HEIGHT]] * 2)
    return sliding_model_of(np.diag([1e6, 0.0, tilt]), np.zeros((3, 3)), normal, tangent, 0 * tangent,
                            np.array([[0.0, -1.0, 0.0]]), speed)


def slide(model, friction, law=CURVED, load=LOAD):
    return steady_sliding(model, closure_response(model), np.array([load]), *law, friction)


@pytest.mark.parametrize("speed", [1.0, -1.0])
def test_friction_couple_moves_the_load_to_one_contact(speed):
    """Moments about the tie: HALF (N1 - N2) + HEIGHT mu LOAD = 0, whatever the normal law."""
    moved = np.sign(speed) * 0.6 * LOAD * HEIGHT / HALF
    state = slide(rubbed_block(speed), 0.6)
    np.testing.assert_allclose(state.contact.force, [(LOAD - moved) / 2, (LOAD + moved) / 2], rtol=1e-9)
    np.testing.assert_allclose(np.interp(state.contact.closure, *CURVED) * AREA, state.contact.force, rtol=1e-12)


def test_friction_that_rises_with_pressure_moves_more():
    """mu = m + a p: HALF D + HEIGHT (m LOAD + a / AREA (LOAD^2 + D^2) / 2) = 0 for D = N1 - N2."""
    m, a = 0.3, 2e-7
    state = slide(rubbed_block(), lambda p, v: FrictionState(m + a * p, a + 0 * p))
    square, constant = HEIGHT * a / AREA / 2, HEIGHT * (m * LOAD + a / AREA * LOAD**2 / 2)
    exact = (-HALF + np.sqrt(HALF**2 - 4 * square * constant)) / (2 * square)
    assert state.contact.force @ [1, -1] == pytest.approx(exact, rel=1e-9)


def test_a_contact_opens_where_friction_tips_the_block():
    """Beyond mu = HALF / HEIGHT one contact carries all and a spring holds the rest of the couple."""
    state = slide(rubbed_block(tilt=1e3), 2.5)
    assert list(state.contact.closed) == [False, True]
    np.testing.assert_allclose(state.contact.force, [0.0, LOAD], rtol=1e-9)
    turn = (2.5 * HEIGHT - HALF) * LOAD / 1e3
    assert state.contact.closure @ [1, -1] == pytest.approx(-2 * HALF * turn, rel=1e-9)
    assert state.contact.stiffness[0] == 0


def test_a_block_that_tips_has_no_state():
    with pytest.raises(ConvergenceError, match="steady sliding"):
        slide(rubbed_block(), 2.5)


def strut(friction):
    """Steady sliding of a shoe on an oblique strut, which locks where the friction digs it in: near 0.67."""
    way, row = np.array([0.55, 0.835]), np.array([[0.0, 1.0]])
    model = sliding_model_of(1e7 * np.outer(way, way), np.zeros((2, 2)), row, row[:, ::-1], 0 * row, -row, 1.0)
    return slide(model, friction, law=(np.array([0.0, 1e-3]), np.array([0.0, 5e4 / AREA])), load=100.0)


@pytest.mark.exact
@pytest.mark.parametrize("friction", [0.0, 0.3, 0.6])
def test_a_strut_that_digs_in_carries_more(friction):
    """Along sliding the strut bears mu N, hence across it mu N times the slope of its direction, and N the load too."""
    carried = 100.0 / (1 - friction * 0.835 / 0.55)
    assert strut(friction).contact.force == pytest.approx([carried], rel=1e-9)


@pytest.mark.parametrize("friction", [0.7, 0.8, 1.0])
def test_a_strut_that_locks_has_no_state(friction):
    with pytest.raises(ConvergenceError, match="steady sliding"):
        strut(friction)


def test_bodies_that_nothing_holds():
    loose = rubbed_block()
    with pytest.raises(ConfigError, match="hold"):
        closure_response(replace(loose, stiffness=0 * loose.stiffness))


def random_model(speed=1.3):
    """Disc (4 coordinates) and pads (8) with five contacts, all random but positive definite."""
    rng = np.random.default_rng(2)
    basis, _ = np.linalg.qr(rng.normal(size=(12, 12)))
    stiffness = (basis * np.geomspace(1e6, 1e9, 12)) @ basis.T
    rows = rng.normal(size=(3, 5, 12)) / 4
    rows[0] = abs(rows[0])
    return sliding_model_of(stiffness, 1e-6 * stiffness, *rows, -rows[0].sum(axis=0)[None], speed, ("disc", "pads"),
                            np.repeat([0, 1], [4, 8]))


def rising_friction():
    """Friction over pressure, speed and distance; no state lies on a corner of the table."""
    pressure, speed, distance = np.array([0.0, 7e7]), np.array([0.1, 3.0]), np.array([0.0, 1.0])
    table = 0.2 + 2e-9 * pressure[:, None, None] - 0.03 * speed[:, None] + 0.05 * distance
    return FrictionLaw(pressure, speed, distance, table)


def test_without_friction_it_is_the_static_preload():
    model = random_model()
    normal = model.contacts.normal
    compliance = normal @ np.linalg.solve(model.stiffness, normal.T)
    free = -normal @ np.linalg.solve(model.stiffness, LOAD * model.input_rows[0])
    preload = solve_preload(compliance, free, model.contacts.area, *CURVED)
    np.testing.assert_allclose(slide(model, 0.0).contact.force, preload.force, rtol=1e-8)
    assert abs(slide(model, 0.3).contact.force - preload.force).max() > 0.01 * preload.force.max()


def contact_forces(model, place, friction):
    """Nonlinear forces (n,) of the contacts on the bodies in steady sliding at the displacement ``place``."""
    contacts = model.contacts
    force = AREA * np.interp(-contacts.normal @ place, *CURVED)
    return contacts.normal.T @ force + contacts.tangent.T @ (
        friction(force / AREA, model.sliding_speed).coefficient * force)


def test_linearisation_is_the_difference_of_the_nonlinear_forces_in_balance():
    model, friction = random_model(), partial(from_map, rising_friction(), 0.5)
    state = slide(model, friction)
    forces = (model.contacts.normal.T @ state.contact.force
              + model.contacts.tangent.T @ (state.friction.coefficient * state.contact.force))
    load = LOAD * model.input_rows[0]
    place = np.linalg.solve(model.stiffness, load + forces)
    np.testing.assert_allclose(contact_forces(model, place, friction), forces, rtol=1e-7)
    stiffness = model_about(model, state.contact).linearised(state.friction)[2]
    for axis, unit in enumerate(1e-10 * np.eye(12)):
        change = contact_forces(model, place + unit, friction) - contact_forces(model, place - unit, friction)
        np.testing.assert_allclose((stiffness - model.stiffness)[:, axis], -change / 2e-10, rtol=1e-4, atol=1e2)


def test_the_bodies_are_displaced_by_the_closures():
    """Whatever the springs that the bodies were condensed with."""
    model, friction = random_model(), partial(from_map, rising_friction(), 0.5)
    state = slide(model, friction)
    forces = (model.contacts.normal.T @ state.contact.force
              + model.contacts.tangent.T @ (state.friction.coefficient * state.contact.force))
    place = displacement(model, state.contact, state.friction.coefficient, np.array([LOAD]))
    np.testing.assert_allclose(-model.contacts.normal @ place, state.contact.closure, rtol=1e-9)
    np.testing.assert_allclose(model.stiffness @ place, LOAD * model.input_rows[0] + forces, rtol=1e-8)


def test_pads_on_a_held_disc_are_those_of_the_multibody_analysis():
    model, law = random_model().held("disc"), rising_friction()
    state = slide(model, partial(from_map, law, 0.5))
    _, damping, stiffness = model_about(model, state.contact, 2.0).linearised(state.friction)
    system = pad_system(model, np.array([LOAD]), *CURVED, law, np.full(4, 0.5), 0.0, 16, 0.0, 1e-3, 2.0)
    forces = (model.contacts.normal.T @ state.contact.force
              + model.contacts.tangent.T @ (state.friction.coefficient * state.contact.force))
    place = np.linalg.solve(model.stiffness, system.load + forces)
    by_pads = linearised(system, place)
    np.testing.assert_allclose(by_pads[0], stiffness, rtol=1e-9, atol=1e-3)
    np.testing.assert_allclose(by_pads[1], damping, rtol=1e-8, atol=1e-8)


@pytest.mark.parametrize("gap", [2e-6, -2e-6])
def test_gaps_are_closed_before_anything_presses(gap):
    """Two contacts alike on a block tied to ground by a spring: spring * lift = N - LOAD, lift + gap = -closure."""
    spring, model = 1e7, rubbed_block()
    tied = replace(model, stiffness=np.diag([1e6, spring, 0.0]),
                   contacts=replace(model.contacts, gap=np.full(2, gap)))
    state = slide(tied, 0.0)
    np.testing.assert_allclose(spring * (-state.contact.closure - gap), state.contact.force.sum() - LOAD, rtol=1e-8)
    assert (state.contact.force.sum() > LOAD) == (gap < 0)


def test_a_friction_joint_keeps_its_preload_and_loads_the_bodies():
    """Its friction mu N0, at HEIGHT above the pads, tilts the block as any force there would."""
    model, extra = rubbed_block(tilt=50.0), 25.0
    rows = {name: np.vstack((getattr(model.contacts, name), row)) for name, row in (
        ("normal", [0.0, 0.0, 0.0]), ("tangent", [1.0, 0.0, -HEIGHT]), ("lateral", [0.0, 0.0, 0.0]))}
    more = {name: np.append(getattr(model.contacts, name), value) for name, value in (
        ("area", AREA), ("lever", 1.0), ("preload", extra), ("stiffness", 0.0), ("damping", 0.0))}
    joined = replace(model, contacts=replace(model.contacts, **rows, **more, position=np.zeros((3, 3))))
    pushed = replace(model, input_rows=np.vstack((model.input_rows, rows["tangent"][-1])))
    state = slide(joined, 0.4)
    same = steady_sliding(pushed, closure_response(pushed), np.array([LOAD, 0.4 * extra]), *CURVED, 0.4)
    assert state.contact.force[-1] == extra and state.contact.stiffness[-1] == 0.0
    np.testing.assert_allclose(state.contact.force[:2], same.contact.force, rtol=1e-9)


def test_contacts_without_a_law_stay_as_given():
    model = rubbed_block(speed=2.0)
    state = given_state(model, partial(falling_with_speed, 0.3, 0.5, 1.0))
    assert state.contact.force is model.contacts.preload and state.contact.stiffness is model.contacts.stiffness
    np.testing.assert_allclose(state.friction.coefficient, 0.3 + 0.2 * np.exp(-2.0))
    step = 1e-6
    ahead, behind = (falling_with_speed(0.3, 0.5, 1.0, 0.0, 2.0 + s).coefficient for s in (step, -step))
    np.testing.assert_allclose(state.friction.speed_slope, (ahead - behind) / (2 * step), rtol=1e-8)


def test_more_contacts_than_coordinates_have_the_same_state():
    """Six contacts on a block of three coordinates, one of which friction tips open: beside the whole matrices."""
    place = np.linspace(-HALF, HALF, 6)
    model = rubbed_block()
    rows = np.column_stack((0 * place, 1 + 0 * place, place)), np.tile(model.contacts.tangent[0], (6, 1))
    model = sliding_model_of(model.stiffness, model.damping, *rows, 0 * rows[0], model.input_rows, 1.0)
    few = closure_response(model)
    whole = ClosureResponse(few.rows @ few.normal, few.rows @ few.tangent, few.inputs, few.stiffness)
    made, expected = (steady_sliding(model, each, np.array([LOAD]), *CURVED, 1.5).contact for each in (few, whole))
    assert (expected.force == 0).any()
    np.testing.assert_allclose(made.force, expected.force, rtol=1e-9, atol=1e-9 * LOAD)
