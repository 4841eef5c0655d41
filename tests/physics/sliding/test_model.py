"""The sliding model: rows, friction terms against hand calculations, null points, symmetry, derived models."""

from dataclasses import fields, is_dataclass, replace

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.modal.quadratic_eigenproblem import quadratic_roots
from pipeline.physics.sliding.model import Contacts, FrictionState, Joints, SlidingModel, congruent, sliding_model
from pipeline.physics.system import system as systems
from pipeline.physics.system.forms import spread
from pipeline.physics.system.system import runs
from tests.stages.small_brake import small_brake, stiffening_brake


def two_masses(speed=2.0, preload=50.0, damping=0.0):
    """A belt (coordinate 0: normal) and a block (1: normal, 2: along sliding, 3: sideways) with one contact."""
    one = np.ones(1)
    contacts = Contacts(
        normal=np.array([[-1.0, 1.0, 0.0, 0.0]]), tangent=np.array([[0.0, 0.0, 1.0, 0.0]]),
        lateral=np.array([[0.0, 0.0, 0.0, 1.0]]), position=np.zeros((1, 3)), area=1e-4 * one, lever=one,
        preload=preload * one, stiffness=1e6 * one, damping=damping * one)
    joints = Joints(("tie_oblique", "tie_back"), np.array([[0.0, 0.6, 0.8, 0.0], [0.0, 0.0, 1.0, 1.0]]),
                    np.array([5e5, 2e5]), np.array([3.0, 0.0]))
    gyroscopic = np.zeros((4, 4))
    gyroscopic[1, 2], gyroscopic[2, 1] = 0.5, -0.5
    mass, damping = np.diag([3.0, 1.0, 1.0, 1.0]), np.diag([1.0, 0, 0, 0])
    return SlidingModel(("belt", "block"), np.array([0, 1, 1, 1]), mass, damping, gyroscopic,
                        np.diag([4e5, 1e5, 1e5, 1e5]), np.diag([10.0, 0, 0, 0]), joints, contacts,
                        ("press",), np.array([[0.0, -1.0, 0.0, 0.0]]), ("tip",), np.eye(4)[2:3], speed)


def friction_force(model, velocity, displacement, law):
    """Force (n,) of the contact on the coordinates, nonlinear, for one contact."""
    contacts, slide = model.contacts, model.sliding_speed[0]
    normal = (contacts.preload[0] - contacts.stiffness[0] * (contacts.normal @ displacement)[0]
              - contacts.damping[0] * (contacts.normal @ velocity)[0])
    slip = np.array([slide - (contacts.tangent @ velocity)[0], -(contacts.lateral @ velocity)[0]])
    size = np.hypot(*slip)
    pull = law(normal / contacts.area[0], size) * normal * slip / size
    return contacts.normal[0] * normal + contacts.tangent[0] * pull[0] + contacts.lateral[0] * pull[1]


@pytest.mark.exact
@pytest.mark.parametrize("speed", [2.0, -3.0])
def test_linearised_terms_are_the_derivatives_of_the_contact_force(speed):
    """The formulas (1)-(3) against complex-free central differences of the nonlinear force: second order, so exact."""
    model = two_masses(speed, damping=7.0)
    base, step = model.contacts.pressure[0], 1e-6

    def law(pressure, slip):
        return 0.4 + 2e-7 * (pressure - base) - 0.03 * (slip - abs(speed))

    state = FrictionState(0.4, 2e-7, -0.03)
    _, damping, stiffness = model.linearised(state)
    _, bare_damping, bare_stiffness = model.supported()
    rest = np.zeros(4)
    for axis, unit in enumerate(np.eye(4)):
        by_place = (friction_force(model, rest, step * unit, law) - friction_force(model, rest, -step * unit, law))
        by_rate = (friction_force(model, step * unit, rest, law) - friction_force(model, -step * unit, rest, law))
        np.testing.assert_allclose((stiffness - bare_stiffness)[:, axis], -by_place / (2 * step), rtol=1e-6, atol=1e-2)
        np.testing.assert_allclose((damping - bare_damping)[:, axis], -by_rate / (2 * step), rtol=1e-6, atol=1e-6)


@pytest.mark.exact
def test_without_friction_and_rotation_the_system_is_symmetric_and_never_grows():
    model = two_masses(speed=0.0)
    _, damping, stiffness = model.linearised(0.0)
    np.testing.assert_allclose(stiffness, stiffness.T, rtol=1e-14)
    np.testing.assert_allclose(damping, damping.T, rtol=1e-14)
    assert quadratic_roots(*model.linearised(0.0)).real.max() < 1e-9
    undamped = replace(model, damping=np.zeros((4, 4)), joints=replace(model.joints, damping=np.zeros(2)))
    roots = quadratic_roots(*undamped.linearised(0.0))
    assert abs(roots.real).max() < 1e-6 * abs(roots).max()


@pytest.mark.exact
def test_rotation_vanishes_at_speed_zero_and_by_option():
    model = two_masses(speed=2.0)
    at_rest = model.at_speed(0.0).frictionless()
    without = model.frictionless(gyroscopic=False, centrifugal=False)
    assert all(np.array_equal(a, b) for a, b in zip(at_rest, without, strict=True))
    _, damping, stiffness = model.frictionless()
    np.testing.assert_array_equal(damping - without[1], 2.0 * model.gyroscopic)
    np.testing.assert_array_equal(stiffness - without[2], 4.0 * model.centrifugal)


@pytest.mark.exact
def test_friction_works_along_tangent_and_is_driven_by_normal():
    _, _, with_friction = two_masses().linearised(0.3, friction_damping=False)
    _, _, without = two_masses().frictionless()
    expected = np.zeros((4, 4))
    expected[2, :2] = 0.3 * 1e6 * np.array([-1.0, 1.0])
    np.testing.assert_allclose(with_friction - without, expected, atol=1e-9)


def test_friction_damping_needs_sliding():
    with pytest.raises(ConfigError, match="sliding speed of 0"):
        two_masses(speed=0.0).linearised(0.3)
    two_masses(speed=0.0).linearised(0.3, friction_damping=False)
    two_masses(speed=0.0, preload=0.0).linearised(0.3)


@pytest.mark.exact
def test_held_body_leaves_the_block_of_the_others():
    model = two_masses()
    held = model.held("belt")
    full, small = model.linearised(0.3), held.linearised(0.3)
    assert held.size == 3 and list(held.coordinate_body) == [1, 1, 1]
    assert all(np.array_equal(a[1:, 1:], b) for a, b in zip(full, small, strict=True))
    with pytest.raises(ConfigError, match="belt, block"):
        model.held("disc")


@pytest.mark.exact
def test_joint_groups_scale_alone():
    model = two_masses()
    scaled = model.with_joints_scaled("oblique", 3.0)
    np.testing.assert_array_equal(scaled.joints.stiffness, [1.5e6, 2e5])
    np.testing.assert_array_equal(scaled.joints.damping, [9.0, 0.0])
    assert np.array_equal(model.with_joints_scaled("tie", 1.0).joints.stiffness, model.joints.stiffness)
    with pytest.raises(ConfigError, match="tie_back"):
        model.with_joints_scaled("abutment", 2.0)


@pytest.mark.exact
def test_no_contact_and_free_masses_are_legal():
    none, empty = np.empty((0, 2)), np.empty(0)
    model = SlidingModel(("a", "b"), np.array([0, 1]), np.diag([1.0, 4.0]), *(np.zeros((2, 2)),) * 4,
                         Joints(("spring",), np.array([[1.0, -1.0]]), np.array([100.0]), np.zeros(1)),
                         Contacts(none, none, none, np.empty((0, 3)), *(empty,) * 5), (), none, (), none, 0.0)
    roots = quadratic_roots(*model.linearised(0.4))
    np.testing.assert_allclose(np.sort(roots.imag), [-np.sqrt(125), 0, 0, np.sqrt(125)], atol=1e-6)


def test_inputs_stay_untouched():
    model = two_masses()
    before = [np.array(a) for a in arrays(model)]
    model.linearised(FrictionState(0.3, 1e-8, -0.1))
    model.held("belt").at_speed(1.0).with_joints_scaled("tie", 2.0).linearised(0.2)
    assert all(np.array_equal(a, b) for a, b in zip(before, arrays(model), strict=True))


def arrays(thing):
    """All arrays of a nested dataclass."""
    for field in fields(thing):
        value = getattr(thing, field.name)
        if is_dataclass(value):
            yield from arrays(value)
        elif isinstance(value, np.ndarray):
            yield value


@pytest.mark.exact
def test_linings_stiffen_with_the_pressure_of_a_state():
    """At three times the pressure by the root of three, with what they lose; a state at their own pressure stays."""
    stiffening, stiffer = stiffening_brake(1.0), stiffening_brake(np.sqrt(3.0))
    for state, expected in ((0, replace(stiffening, lining_exponent=0.0)), (1, replace(stiffer, lining_exponent=0.0))):
        made, plain = (sliding_model(each, state, 10.0) for each in (stiffening, expected))
        np.testing.assert_allclose(made.stiffness, plain.stiffness, rtol=1e-14)
        np.testing.assert_allclose(made.damping, plain.damping, rtol=1e-12, atol=1e-9)
    assert np.abs(sliding_model(stiffening, 1, 10.0).damping - sliding_model(stiffening, 0, 10.0).damping).max() > 1e-3
    assert small_brake().lining_exponent == 0


@pytest.fixture
def by_body(monkeypatch):
    monkeypatch.setattr(systems, "_SHORT", 1)


def scattered(share=0.7):
    """A model of three bodies with random rows, each of them on two bodies, some contacts open."""
    random, body = np.random.default_rng(5), np.repeat([0, 1, 2], [4, 3, 5])
    beside = np.where(np.arange(6)[:, None] < 3, 1, 2)
    rows = [np.where((body == 0) | (body == beside), random.normal(size=(6, 12)), 0.0) for _ in range(3)]
    one = np.ones(6)
    contacts = Contacts(*rows, np.zeros((6, 3)), one, one, 1 + random.random(6),
                        1e3 * random.random(6) * (random.random(6) < share), random.random(6))
    joints = Joints(("tie", "rod"), random.normal(size=(2, 12)), np.array([3e2, 2e2]), np.array([3.0, 0.0]))
    inside = body[:, None] == body
    square = [np.where(inside, random.normal(size=(12, 12)), 0.0) for _ in range(4)]
    return SlidingModel(("disc", "pad", "other"), body, np.eye(12), *square, joints, contacts, ("press",), rows[0][:1],
                        (), rows[0][:0], 2.0)


def test_matrices_by_body_are_the_sums_over_all_rows(by_body):
    model, friction = scattered(), FrictionState(0.4, 1e-3, -0.02)
    contacts, joints, coupling = model.contacts, model.joints, model.coupling(friction)
    _, damping, stiffness = model.linearised(friction)
    expected = model.damping + 2.0 * model.gyroscopic + spread(joints.rows, joints.damping, joints.rows)
    for left, weight, right in ((contacts.normal, contacts.damping, contacts.normal),
                                (contacts.tangent, coupling * contacts.damping, contacts.normal),
                                (contacts.tangent, contacts.preload * friction.speed_slope, contacts.tangent),
                                (contacts.lateral, model.turning_drag(0.4), contacts.lateral)):
        expected = expected + spread(left, weight, right)
    np.testing.assert_allclose(damping, expected, rtol=0, atol=1e-13 * abs(expected).max())
    expected = model.stiffness + 4.0 * model.centrifugal + spread(joints.rows, joints.stiffness, joints.rows)
    expected = expected + spread(contacts.normal, contacts.stiffness, contacts.normal)
    expected = expected + spread(contacts.tangent, coupling * contacts.stiffness, contacts.normal)
    np.testing.assert_allclose(stiffness, expected, rtol=0, atol=1e-13 * abs(expected).max())
    parts = [a + b for a, b in zip(model.frictionless()[1:], model.friction_matrices(friction), strict=True)]
    for part, whole in zip(parts, (damping, stiffness), strict=True):
        np.testing.assert_allclose(part, whole, rtol=0, atol=1e-13 * abs(whole).max())


@pytest.mark.parametrize("complex_", [False, True])
def test_projection_by_body_is_the_whole_one(complex_, by_body):
    model, basis = scattered(), np.random.default_rng(2).normal(size=(12, 5))
    matrix = model.stiffness + 1j * model.damping if complex_ else model.stiffness
    for each in (matrix, matrix + matrix[::-1]):
        np.testing.assert_allclose(congruent(each, basis, runs(model.coordinate_body)), basis.T @ each @ basis, rtol=0,
                                   atol=1e-12)
    assert runs(model.coordinate_body) == [slice(0, 4), slice(4, 7), slice(7, 12)]


def test_short_runs_are_one():
    assert runs(np.array([0, 1, 0])) == [slice(0, 3)] and runs(np.arange(2).repeat(30)) == [slice(0, 30), slice(30, 60)]
