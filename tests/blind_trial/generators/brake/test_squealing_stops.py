"""Squealing stops of the practice brake: growth of the linear model, a limit cycle behind it, channels and repeats."""

import numpy as np
import pytest

from pipeline.blind_trial.generators.brake import brake, brake_parts, squealing_brake, squealing_stops
from pipeline.blind_trial.generators.brake.squealing_stops import DURATION, FURTHER, POINTS, STOPS, _Points
from pipeline.contract.errors import ConfigError

#: s of a simulated stop
SHORT = 0.18
FALLING = {"falling_friction": {"rise": 0.05, "decay_speed": 0.1}}


def whole(**hidden):
    values = dict(brake_parts.NOMINAL)
    return squealing_brake.inclined(brake_parts.built(values, brake_parts.SHAPES[0], hidden=hidden), values)


def one(load=1500.0, speed=1.0):
    return _Points(np.array([load]), np.array([speed]), np.ones(1))


@pytest.mark.slow
@pytest.mark.parametrize("hidden", [FALLING, {"contact_stiffness_law": {"exponent": 0.4}}])
def test_a_stop_grows_as_the_linear_model_says_and_then_saturates(hidden):
    made = whole(**hidden)
    root = squealing_stops.growing(made, 1500.0, 1.0)
    motion, torque = squealing_stops.simulated(made, one(), np.random.default_rng(0), SHORT)
    level = np.sqrt(np.mean(motion[4, 0].reshape(-1, 512) ** 2, axis=1))       # of 2.5 ms
    time = (np.arange(len(level)) + 0.5) * 2.5e-3
    grows = (level > 1e-4 * level.max()) & (level < 0.02 * level.max()) & (time > 0.085)
    assert grows.sum() > 4
    assert np.polyfit(time[grows], np.log(level[grows]), 1)[0] == pytest.approx(root.real, rel=0.05)
    assert np.mean(level[-16:-8]) == pytest.approx(np.mean(level[-8:]), rel=0.5) and 0.05 < level[-1] < 2.0
    expected = 2 * 0.35 * 1500 * np.average(made.radius, weights=made.share)
    assert torque[0, round(0.09 / SHORT * torque.shape[1])] == pytest.approx(expected, rel=0.2)


def test_the_linear_forces_are_those_of_small_motions():
    """The Jacobian of the forces about rest and the matrices that the steps hold: no friction, closed contacts."""
    made = whole(contact_damping={"damping": 100.0})
    forces = squealing_stops._Forces(made, one())
    size = len(made.mass)
    rest = np.vstack((forces.quiet(), np.zeros((size, 1))))
    at, _ = forces.at(rest, 0.0)
    assert at == pytest.approx(forces.stiffness @ rest[:size], abs=1e-6 * abs(at).max())
    moved, _ = forces.at(rest + 1e-9 * np.random.default_rng(0).standard_normal(rest.shape), 0.0)
    assert moved == pytest.approx(at, abs=1e-6), "closed contacts are linear"


def test_a_step_of_the_linear_brake_is_exact():
    made = whole()
    forces, step = squealing_stops._Forces(made, one()), 1e-5
    propagate, first, second = squealing_stops._exponentials(forces, step)
    size = len(made.mass)
    matrix = np.block([[np.zeros((size, size)), np.eye(size)],
                       [np.linalg.solve(made.mass, -forces.stiffness), np.linalg.solve(made.mass, -forces.damping)]])
    value = np.linalg.eigvals(matrix)
    assert np.sort(abs(np.linalg.eigvals(propagate))) == pytest.approx(np.sort(abs(np.exp(value * step))), rel=1e-6)
    force = np.ones((size, 1))
    rest = np.vstack((np.linalg.solve(forces.stiffness, force), np.zeros((size, 1))))
    assert propagate @ rest + first @ force == pytest.approx(rest, abs=1e-9 * abs(rest).max()), "rest under a force"
    assert second.shape == first.shape


def test_records_name_their_points_and_repeats(monkeypatch):
    monkeypatch.setattr(squealing_stops, "DURATION", 0.002)
    monkeypatch.setattr(squealing_stops.simulated, "__defaults__", (0.002,))
    runs = squealing_stops.record(whole(), 1, POINTS[:2])
    assert len(runs) == 2 * STOPS and DURATION > 0.3
    first, again = runs["stop_700N_1_1"], runs["stop_700N_1_2"]
    assert first["repeat_of"] == "" and again["repeat_of"] == "stop_700N_1_1"
    assert set(first["channels"]) == {*brake.CHANNELS, *FURTHER}
    pressure = first["channels"]["pressure"][0]
    assert len(pressure) == 52 and first["conditions"]["press"] == (700.0, "N")


def test_physics_that_stops_do_not_have_is_refused():
    with pytest.raises(ConfigError, match="tap this brake instead"):
        squealing_stops._Forces(whole(contact_memory={"length": 5e-6}), one())


def test_falling_friction_grows_faster_where_slow_and_loaded():
    made = whole(**FALLING)
    slow, fast = (squealing_stops.growing(made, 1500.0, speed).real for speed in (1.0, 4.0))
    heavy, light = (squealing_stops.growing(made, load, 1.0).real for load in (3000.0, 700.0))
    assert slow > fast and heavy > light
