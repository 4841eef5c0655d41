"""The fluid column of the brake: no stiffness at rest, a spring in vibration, in complex modes and transients alike."""

from dataclasses import fields
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.linalg import eigh

from pipeline.physics.sliding.model import loss_stiffness, sliding_model
from pipeline.products import ReducedModel
from pipeline.systems.fem_bodies import LINE
from stages.complex_modes import Settings as Modes
from stages.complex_modes import complex_modes
from stages.reduced_model import Settings, _with_fluid, reduced_model
from stages.transient import Settings as Motion
from stages.transient import transient
from tests.stages.small_oscillator import DAMPING, MASS, STIFFNESS, small_oscillator
from tests.stages.small_structure import INNER, small_friction_map, small_structure

pytestmark = pytest.mark.exact
COLUMN, INERTIA, LOSS = 3e8, 400.0, 0.02
FLUID = {"fluid_stiffness": [COLUMN], "fluid_loss_factor": [LOSS], "line_inertia": [INERTIA], "line_drag": [1e4]}


def changed(product, **values):
    return type(product)(**{**{f.name: getattr(product, f.name) for f in fields(product)}, **values})


@pytest.fixture(scope="module")
def models():
    """(Without fluid, with it): the small brake."""
    structure, settings = small_structure(), Settings(fixed_below="20 kHz")
    return tuple(reduced_model(changed(structure, **fluid), settings=settings) for fluid in ({}, FLUID))


def test_the_line_is_one_more_coordinate(models):
    dry, wet = models
    assert len(wet.mass) == len(dry.mass) + 1 and wet.mass[-1, -1] == INERTIA and wet.damping[-1, -1] == 1e4
    assert list(wet.body_name) == [*dry.body_name, LINE] and wet.coordinate_body[-1] == len(dry.body_name)
    assert wet.joint_name[-1] == "fluid_column" and wet.joint_loss_factor[-1] == LOSS
    for name in ("mass", "stiffness", "damping", "gyroscopic", "centrifugal", "loss"):
        assert np.array_equal(getattr(wet, name)[:-1, :-1], getattr(dry, name))
    assert not wet.recovery[..., -1].any() and not wet.contact_normal[:, -1].any()


def test_statics_do_not_feel_the_fluid(models):
    """Displacements under the piston and under friction are those without it; the column stays unstressed."""
    answers = []
    for model in models:
        rows = np.vstack((model.input_rows, model.contact_tangent))
        answers.append(np.linalg.solve(sliding_model(model, 0, 10.0).frictionless()[2], rows.T))
    dry, wet = answers
    np.testing.assert_allclose(wet[:-1], dry, rtol=0, atol=1e-9 * abs(dry).max())
    stretched = models[1].joint_rows[-1] @ wet
    assert abs(stretched).max() < 1e-9 * abs(models[1].input_rows @ wet).max()


def test_steady_sliding_is_that_without_fluid(models):
    dry, wet = (complex_modes(model, small_friction_map(), settings=Modes(
        speeds=("12 rad/s",), friction_steps=2, frequency_max="8 kHz")) for model in models)
    np.testing.assert_allclose(wet.operating_force, dry.operating_force, rtol=1e-8)


def test_in_vibration_it_is_the_spring_of_column_and_line(models):
    """Modes are those of the brake with a spring k m w^2 / (m w^2 - k), which tends to k."""
    dry, wet = (sliding_model(changed(m, joint_loss_factor=0 * m.joint_loss_factor), 0, 0.0) for m in models)
    mass, _, stiffness = wet.frictionless()
    square, bare, row = eigh(stiffness, mass, eigvals_only=True), dry.frictionless(), dry.input_rows[0]
    for one in square[1:30:3]:
        column = COLUMN * INERTIA * one / (INERTIA * one - COLUMN)
        sprung = eigh(bare[2] + column * np.outer(row, row), bare[0], eigvals_only=True)
        assert abs(sprung / one - 1).min() < 1e-7
    fixed = eigh(bare[2] + COLUMN * np.outer(row, row), bare[0], eigvals_only=True)
    fast = fixed[(fixed > (2 * np.pi * 1e3) ** 2) & (fixed < (2 * np.pi * 8e3) ** 2)]
    apart = abs(np.sqrt(square[:, None] / fast) - 1).min(axis=0)
    assert len(fast) > 5 and apart.max() < COLUMN / (INERTIA * fast[0])


def test_the_column_moves_the_modes_and_loses_its_share(models):
    dry, wet = (np.sqrt(eigh(*(sliding_model(m, 0, 0.0).frictionless()[k] for k in (2, 0)), eigvals_only=True))
                for m in models)
    dry, wet = (f[(f > 2 * np.pi * 500) & (f < 2 * np.pi * 8e3)] for f in (dry, wet))
    assert abs(dry[:, None] / wet - 1).min(axis=0).max() > 0.01
    row = models[1].joint_rows[-1]
    added = loss_stiffness(models[1])
    added[:-1, :-1] -= loss_stiffness(models[0])
    np.testing.assert_allclose(added, LOSS * COLUMN * np.outer(row, row), atol=1e-6)
    assert row[-1] == -1 and np.array_equal(row[:-1], models[0].input_rows[0])
    assert set(models[0].coordinate_body[row[:-1] != 0]) >= {INNER}


def piston(column=4e6, inertia=400.0):
    """A mass on a spring to the ground, pushed by fluid that acts against the ground."""
    model = changed(small_oscillator(), input_name=["piston"], input_rows=[[1.0]], input_area=[1.0], pressure=[5.0],
                    input_joint=[""], input_scale=[1.0],
                    input_history=np.empty((0, 1)))
    parts = {f.name: getattr(model, f.name) for f in fields(model)}
    line = SimpleNamespace(fluid_stiffness=[column], fluid_loss_factor=[0.0], line_inertia=[inertia], line_drag=[0.0])
    return ReducedModel(**_with_fluid(parts, line))


def natural(column, inertia):
    """Angular frequencies of the two masses, lower and upper."""
    one, two = (STIFFNESS + column) / MASS, column / inertia
    middle, apart = (one + two) / 2, np.sqrt(((one - two) / 2) ** 2 + column**2 / (MASS * inertia))
    return np.sqrt([middle - apart, middle + apart])


@pytest.mark.parametrize("inertia", [400.0, 4.0])
def test_a_piston_on_fluid_in_complex_modes_and_in_motion(inertia):
    """Upper mode sqrt((k + K) / M) where the line is heavy; rest at p A / K, as if there were no fluid."""
    column = 4e6
    model = piston(column, inertia)
    expected = natural(column, inertia)[1]
    assert inertia < 100 or expected == pytest.approx(np.sqrt((STIFFNESS + column) / MASS), rel=5e-3)
    modes = complex_modes(model, None, settings=Modes(speeds=("1 rad/s",), friction=0.0, friction_steps=2))
    fast = max(modes.operating_root[0], key=abs)
    assert abs(fast) == pytest.approx(expected, rel=1e-4)
    # modal damping of the mass alone, which has nearly all of the motion
    assert fast.real == pytest.approx(-DAMPING / MASS / 2 / (1 + (column / (expected**2 * inertia - column)) ** 2
                                                             * inertia / MASS), rel=1e-3)
    motion = transient(model, None, settings=Motion(step="10 us", duration="0.3 s", window="0.1 s", record_every=5,
                                                    friction=0.0, kick="10 mm/s", lowest_frequency="100 Hz"))
    assert 2 * np.pi * motion.cycle_frequency[0, 0] == pytest.approx(expected, rel=2e-3)


def test_a_pressed_piston_stays_at_rest():
    """Started without a kick under 5 N, the mass does not move: the line holds its pressure."""
    motion = transient(piston(), None, settings=Motion(step="10 us", duration="50 ms", window="20 ms", record_every=5,
                                                       friction=0.0, kick="0 mm/s"))
    assert abs(motion.velocity).max() < 1e-9


def test_the_sides_of_a_fixed_caliper_have_a_line_each():
    """Two rows of pistons, each with its column; statics feel neither."""
    two = changed(small_structure(), **{name: values * 2 for name, values in FLUID.items()})
    rows = two.piston_rows
    sides = np.repeat([1.0, -1.0], len(rows.weight))
    both = changed(rows, rows=2, row=np.concatenate((rows.row, rows.row + 1)), weight=sides * np.tile(rows.weight, 2),
                   **{name: np.tile(getattr(rows, name), 2) for name in ("body", "node", "axis")})
    model = reduced_model(changed(two, piston_rows=both), settings=Settings(fixed_below="20 kHz"))
    assert list(model.joint_name[-2:]) == ["fluid_column_1", "fluid_column_2"]
    assert list(model.body_name).count(LINE) == 1
    assert list(model.input_name) == ["piston_1", "piston_2"] and (model.coordinate_body[-2:] == 4).all()
    np.testing.assert_array_equal(model.joint_rows[-2:, -2:], -np.eye(2))
    np.testing.assert_allclose(model.joint_rows[-2:, :-2], model.input_rows[:, :-2])
    moved = np.linalg.solve(sliding_model(model, 0, 10.0).frictionless()[2], model.input_rows.T)
    assert abs(model.joint_rows[-2:] @ moved).max() < 1e-9 * abs(model.input_rows @ moved).max()
