"""The response of a brake of three coordinates, and of a turning ring."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from pipeline.contract import ConfigError
from pipeline.physics.fem.force_mapping import resultant, spread_rows
from pipeline.physics.fem.mesh import revolve
from pipeline.products import Body, Incidence, Multibody, ReducedModel, Structure
from stages.reduced_model import Settings as ReducedSettings
from stages.reduced_model import reduced_model
from stages.response import Settings, response
from tests.stages.small_structure import small_structure
from tests.views.products_for_views import filled

STEP, SAMPLES = 2e-5, 500
TIME = STEP * np.arange(SAMPLES)
PRESSURE = np.array([1e6, 3e6])
CONTACT_STIFFNESS = np.array([[2e7], [5e7]])
QUICK = {"highest_frequency": "20 kHz", "settling": "1 ms", "resolution": "500 Hz"}


def brake():
    """Disc and pad along z, pad along sliding, each on a spring; one contact between disc and pad."""
    return filled(
        ReducedModel, mass=np.diag([1.0, 0.4, 0.4]), stiffness=np.diag([3e8, 0.0, 0.0]), damping=np.diag([60.0, 0, 0]),
        joint_rows=np.eye(3)[1:], joint_stiffness=[1e7, 4e7], joint_damping=[30.0, 50.0],
        contact_normal=[[-1.0, 1.0, 0.0]], contact_tangent=[[0.0, 0.0, 1.0]], pressure=PRESSURE,
        contact_stiffness=CONTACT_STIFFNESS, sensor_name=["disc", "pad"], sensor_rows=[[1.0, 0, 0], [0, 0.6, 0.8]])


def motion(normal, friction, pressure=PRESSURE, speed=(8.5, 12.0)):
    """Multi-body forces, the same at every operating point: (contact, time)."""
    repeat = np.ones((len(pressure), 1, 1))
    return filled(Multibody, pressure=pressure, speed=list(speed), time=TIME, normal_force=repeat * normal,
                  friction_force=repeat * friction)


def sensors(names):
    return filled(Structure, sensor_name=names, sensor_position=np.zeros((len(names), 3)))


def respond(normal, friction, structure=None, **settings):
    multibody = motion(np.atleast_2d(normal), np.atleast_2d(friction))
    return response(structure or sensors(["disc", "pad"]), brake(), multibody,
                    settings=Settings.model_validate({**QUICK, "coupling": "assembly", **settings}))


def test_against_the_equations_of_motion():
    """The whole second-order system by DOP853; damping is small, so that its off-diagonal part does little."""
    normal, friction = np.sin(9000 * TIME), 3 * np.cos(4000 * TIME) - 3
    found = respond(normal, friction, forces="friction_and_normal").velocity[1]
    model = brake()
    stiffness = model.stiffness + model.joint_rows.T @ (model.joint_stiffness[:, None] * model.joint_rows)
    stiffness = stiffness + CONTACT_STIFFNESS[1] * model.contact_normal.T @ model.contact_normal
    damping = model.damping + model.joint_rows.T @ (model.joint_damping[:, None] * model.joint_rows)

    def rate(t, state):
        push = np.interp(t, TIME, normal) * model.contact_normal[0]
        push = push + np.interp(t, TIME, friction) * model.contact_tangent[0]
        q, v = state[:3], state[3:]
        return np.concatenate([v, np.linalg.solve(model.mass, push - damping @ v - stiffness @ q)])

    state = solve_ivp(rate, (0, TIME[-1]), np.zeros(6), "DOP853", TIME, rtol=1e-8, atol=1e-14, max_step=STEP).y
    exact = model.sensor_rows @ state[3:]
    np.testing.assert_allclose(found, exact, atol=0.01 * np.abs(exact).max())


def test_friction_alone_leaves_the_normal_direction_at_rest():
    found = respond(np.sin(9000 * TIME), np.sin(4000 * TIME), forces="friction").velocity
    assert np.abs(found[:, 0]).max() < 1e-9 * np.abs(found[:, 1]).max()


def test_constant_forces_are_equilibrium():
    """Null test: the fluctuation of a constant load is zero, whatever the load."""
    found = respond(np.full(SAMPLES, 500.0), np.full(SAMPLES, 200.0))
    assert not found.velocity.any()
    assert respond(np.full(SAMPLES, 500.0), np.full(SAMPLES, 200.0), load="whole", ramp="2 ms").velocity.any()


def test_modes_depend_on_the_preload_of_the_pressure():
    found = respond(np.sin(TIME), np.sin(TIME))
    first, second = (np.sort(found.mode_frequency[found.mode_operating == o]) for o in (0, 1))
    assert second[-1] > first[-1]
    angular = 2 * np.pi * np.sqrt(4e7 / 0.4) / (2 * np.pi)
    at = np.argmin(np.abs(found.mode_frequency - angular / (2 * np.pi)))
    assert found.mode_damping[at] == pytest.approx(50 / 0.4 / (2 * angular), rel=1e-9)


def test_modes_above_the_limit_are_left_out():
    assert np.all(respond(TIME, TIME, highest_frequency="2 kHz").mode_frequency < 2000)


@pytest.mark.parametrize("settings, said", [({"highest_frequency": "30 kHz"}, "record the multi-body forces"),
                                            ({"settling": "1 s"}, "settling")])
def test_settings_that_do_not_fit_the_signals(settings, said):
    with pytest.raises(ConfigError, match=said):
        respond(TIME, TIME, **settings)


def test_pressure_without_preload():
    multibody = motion(TIME[None], TIME[None], pressure=np.array([2e6]), speed=(8.5,))
    with pytest.raises(ConfigError, match="preload"):
        response(sensors(["disc", "pad"]), brake(), multibody,
                 settings=Settings.model_validate({**QUICK, "coupling": "assembly"}))


def ring_structure(shapes, contact_angles=(0.3, 0.3), sides=(1, 2), place=0.3):
    """A ring with given axial shapes of the angle; contacts outer and inner; a sensor on the disc, one elsewhere."""
    mesh = revolve(np.linspace(0.08, 0.15, 4), np.linspace(0, 2 * np.pi, 37), np.array([-0.004, 0.004]))
    shape = np.zeros((len(shapes), len(mesh.node), 3))
    shape[..., 2] = [s(np.arctan2(mesh.node[:, 1], mesh.node[:, 0])) for s in shapes]
    disc = filled(Body, node=mesh.node, element=mesh.element, kind=mesh.kind, shape=shape, damping_ratio=0.01,
                  frequency=500.0 * np.ones(len(shapes)))
    rows = filled(Incidence, rows=2, row=[0, 1], body=[0, 1], node=[0, 0], axis=[2, 2], weight=[1.0, 1.0])
    position = [[0.12 * np.cos(a), 0.12 * np.sin(a), 0.004 if s == 1 else -0.004]
                for a, s in zip(contact_angles, sides, strict=True)]
    seen = [0.14 * np.cos(place), 0.14 * np.sin(place), 0.004]
    return filled(Structure, body_name=["disc", "pad_outer", "pad_inner", "caliper"], disc=disc,
                  contact_body=list(sides), contact_position=position, sensor_name=["disc_face", "pad"],
                  sensor_position=[seen, seen], sensor_direction=[[0, 0, 1.0]] * 2, sensor_rows=rows)


def turn(structure, normal, speed=(0.0, 12.0), **settings):
    multibody = motion(normal, 0 * normal, speed=speed)
    chosen = Settings.model_validate({**QUICK, "coupling": "disc", "load": "whole", "ramp": "1 ms", **settings})
    return response(structure, brake(), multibody, settings=chosen)


def test_pads_push_the_disc_away():
    """The outer pad (above) pushes the disc down, the inner one up; both together leave it at rest."""
    structure = ring_structure([np.ones_like])
    push = np.minimum(TIME / 1e-3, 1)
    outer, inner, both = (turn(structure, np.outer(sides, push)) for sides in ((1, 0), (0, 1), (1, 1)))
    assert list(outer.sensor_name) == ["disc_face"]
    assert outer.velocity[0, 0, :50].min() < 0 <= outer.velocity[0, 0, :50].max()
    np.testing.assert_allclose(inner.velocity, -outer.velocity, atol=1e-9)
    assert np.abs(both.velocity).max() < 1e-6 * np.abs(outer.velocity).max()


def test_turning_is_seen_by_shapes_that_vary_around_only():
    force = np.stack([np.sin(3000 * TIME), 0 * TIME])
    even = turn(ring_structure([np.ones_like]), force).velocity
    np.testing.assert_allclose(even[1], even[0], atol=1e-6 * np.abs(even).max())
    waves = turn(ring_structure([lambda a: np.cos(3 * a), lambda a: np.sin(3 * a)]), force).velocity
    assert np.abs(waves[1] - waves[0]).max() > 0.01 * np.abs(waves[0]).max()


def three_diameters(speed, drive, place):
    """Velocity at the angle ``place`` of a ring that turns at ``speed``, with shapes cos 3a and sin 3a and a force
    -sin(drive t) at the angle 0.3: the pair of modes is one complex oscillator, driven at drive -+ 3 speed."""
    omega, loss, motion = 2 * np.pi * 500.0, 0.02 * 2 * np.pi * 500.0, 0
    slow, fast = np.roots([1, loss, omega**2])
    for sign in (1, -1):
        pace = 1j * (sign * drive - 3 * speed)
        size = -sign / 2j * np.exp(0.9j) / (pace**2 + loss * pace + omega**2)
        first, second = np.linalg.solve([[1, 1], [slow, fast]], [-size, -size * pace])
        motion = motion + size * pace * np.exp(pace * TIME) + sum(
            part * root * np.exp(root * TIME) for part, root in ((first, slow), (second, fast)))
    return (np.exp(-3j * (place - speed * TIME)) * motion).real


@pytest.mark.exact
def test_the_disc_turns_forwards_under_points_at_rest():
    structure = ring_structure([lambda a: np.cos(3 * a), lambda a: np.sin(3 * a)], place=0.5)
    force = np.stack([np.sin(3000 * TIME), 0 * TIME])
    found = turn(structure, force, speed=(40.0, -40.0), load="fluctuation").velocity[:, 0]
    forwards, backwards = (three_diameters(speed, 3000.0, 0.5) for speed in (40.0, -40.0))
    size = np.abs(forwards).max()
    np.testing.assert_allclose(found, [forwards, backwards], atol=0.02 * size)
    assert np.abs(forwards - backwards).max() > 0.2 * size


def test_disc_without_a_sensor_is_refused():
    structure = ring_structure([np.ones_like])
    elsewhere = filled(Incidence, rows=2, row=[0, 1], body=[1, 1], node=[0, 0], axis=[2, 2], weight=[1.0, 1.0])
    values = {name: getattr(structure, name) for name in structure.__dataclass_fields__}
    with pytest.raises(ConfigError, match="sensor on the disc"):
        turn(Structure(**{**values, "sensor_rows": elsewhere}), np.zeros((2, SAMPLES)))


@pytest.fixture(scope="module")
def elastic():
    """The structure of a few elements with contacts of no stiffness, and its reduced model."""
    base = small_structure()
    values = {name: getattr(base, name) for name in base.__dataclass_fields__}
    structure = Structure(**{**values, "contact_stiffness": np.zeros((2, 8))})
    return structure, reduced_model(structure, settings=ReducedSettings())


@pytest.mark.exact
def test_contact_rows_push_pad_and_disc_with_opposite_forces_and_moments(elastic):
    structure, _ = elastic
    force = np.random.default_rng(1).standard_normal(8)
    for rows in (structure.contact_normal, structure.contact_tangent):
        total = np.zeros((2, 3))
        for index, name in enumerate(structure.body_name):
            own, node = rows.body == index, getattr(structure, name).node
            nodal = spread_rows(rows.row[own], rows.node[own], rows.axis[own], rows.weight[own], force, len(node))
            total += resultant(node, nodal)
        np.testing.assert_allclose(total, 0, atol=1e-12)


@pytest.mark.exact
def test_with_open_contacts_the_forces_are_all_that_passes_between_pads_and_disc():
    """Forces of an oscillating pad on a rigid disc: the pad repeats its motion, the disc moves as if it were alone."""
    rate, size = 3000.0, 1e-9
    turn = rate * TIME
    pad = size * (1.5 - 2 * np.cos(turn) + 0.5 * np.cos(2 * turn))
    speed = size * rate * (2 * np.sin(turn) - np.sin(2 * turn))
    acceleration = size * rate**2 * (2 * np.cos(turn) - 2 * np.cos(2 * turn))
    normal = 0.4 * acceleration + 30 * speed + 1e7 * pad
    disc, moved = respond(normal, 0 * normal, coupling="released").velocity[0]
    np.testing.assert_allclose(moved, 0.6 * speed, atol=2e-3 * 0.6 * abs(speed).max())
    alone = solve_ivp(lambda t, y: (y[1], -np.interp(t, TIME, normal) - 60 * y[1] - 3e8 * y[0]), (0, TIME[-1]),
                      np.zeros(2), "DOP853", TIME, rtol=1e-9, atol=1e-16, max_step=STEP).y[1]
    np.testing.assert_allclose(disc, alone, atol=0.01 * abs(alone).max())
    twice = respond(normal, 0 * normal, coupling="assembly").velocity[0, 1]
    assert abs(twice - moved).max() > 0.2 * abs(moved).max()


@pytest.mark.parametrize("coupling", ["assembly", "released"])
def test_couplings_agree_where_they_must(elastic, coupling):
    """Without contact stiffness the disc of the assembly is the disc alone: rows of the structure against circles."""
    structure, model = elastic
    rise = np.minimum(TIME / 1e-3, 1)
    tones = np.sin(np.outer(np.linspace(3e3, 3e4, 16), TIME)) * rise
    multibody = motion(tones[:8], tones[8:], pressure=np.array([1e6]), speed=(0.0,))
    brake, disc = (response(structure, model, multibody, settings=Settings.model_validate(
        {**QUICK, "highest_frequency": "12 kHz", "coupling": given})).velocity for given in (coupling, "disc"))
    np.testing.assert_allclose(disc, brake, atol=1e-4 * np.abs(brake).max())
