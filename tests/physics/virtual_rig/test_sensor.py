"""What a sensor writes, takes back and shows of small motions, against closed forms."""

import pickle

import numpy as np
import pytest
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.time_stepping.simulate import Hard
from pipeline.physics.virtual_rig.response import Bench, Run, respond
from pipeline.physics.virtual_rig.sensor import (
    ACCELERATION,
    DISPLACEMENT,
    JOINT_FORCE,
    MEASURANDS,
    NORMAL_FORCE,
    VELOCITY,
    Held,
    Sensor,
    at_instants,
    low_pass,
    measurand,
)
from tests.physics.lumps import lumps


def bench():
    """Two masses on two springs, k = 100 and 50 N/m, c = 3 and 4 N s/m."""
    return Bench(lumps([1.0, 2.0], [[1, 0], [1, -1]], [100.0, 50.0], [3.0, 4.0]), Hard(), constant(0.0), 1e-4, ())


@pytest.mark.exact
def test_means_over_steps_become_values_at_instants():
    edge = np.linspace(0, 3, 31)
    means = np.r_[0.0, np.diff(edge**2 / 2) / 0.1]
    np.testing.assert_allclose(at_instants(means), edge, atol=1e-14)


@pytest.mark.exact
def test_first_order_filter_of_a_sine_and_of_a_ramp():
    time = np.linspace(0, 20, 20001)
    gain = 1 / (1 + 1j * 3.0 / 0.7)
    exact = np.imag(gain * np.exp(3j * 2 * np.pi * time))
    np.testing.assert_allclose(low_pass(np.sin(3 * 2 * np.pi * time), 1e-3, 0.7)[10000:], exact[10000:], atol=1e-4)
    np.testing.assert_allclose(low_pass(time, 1e-3, 0.7)[10000:], time[10000:] - 1 / (2 * np.pi * 0.7), rtol=1e-12)
    np.testing.assert_array_equal(low_pass(np.full(5, 3.0), 1e-3, 0.7), low_pass(np.full(5, 3.0), 1e-3, 0.7))


@pytest.mark.exact
@pytest.mark.parametrize("corner", [0.7, np.inf])
def test_held_values_behind_a_filter_are_exact_between_steps(corner):
    held, time = np.array([2.0, 2.0, -1.0, 4.0]), np.linspace(-0.3, 1.9, 45)
    found = Held(held, 0.5).filtered(time, corner)

    def risen(since):
        return np.where(since < -1e-12, 0.0, 1 - np.exp(-2 * np.pi * min(corner, 1e9) * np.maximum(since, 0.0))
                        if np.isfinite(corner) else 1.0)

    exact = 2.0 - 3.0 * risen(time - 1.0) + 5.0 * risen(time - 1.5)
    np.testing.assert_allclose(found, exact, atol=1e-12)


@pytest.mark.exact
@pytest.mark.parametrize(("kind", "largest"), [("held", 1e-3), ("linear", 3e-3)])
def test_accelerations_are_of_second_order_though_forces_jump_or_bend(kind, largest):
    """1 kg on k = 40 N/m and c = 2 N s/m behind a filter and a delay, against the exact answer in state space."""
    rate, force = 50.0, np.repeat(np.random.default_rng(4).standard_normal(12), 9)
    sensor, pole = Sensor("x", ACCELERATION, "sensor_0", corner=11.0, delay=0.3 / rate), 2 * np.pi * 11.0
    run = Run("r", (len(force) - 1) / rate, rate, {"input_0": force}, held=("input_0",) if kind == "held" else ())
    system = scipy.signal.StateSpace([[0, 1, 0], [-40, -2, 0], [-40 * pole, -2 * pole, -pole]], [[0], [1], [pole]],
                                     [[0, 0, 1]], [[0]])
    fine = np.arange(100 * (len(force) - 1) + 1) / (100 * rate)
    given = np.interp(fine, run.time, force) if kind == "linear" else np.append(np.repeat(force[:-1], 100), force[-1])
    *_, states = scipy.signal.lsim(system, given, fine, [0.0, 0.0, force[0]], interp=kind == "linear")
    exact = np.interp(run.time - sensor.delay, fine, states[:, 2])

    def error(steps):
        mass = Bench(lumps([1.0], [[1.0]], [40.0], [2.0]), Hard(), constant(0.0), 1 / (steps * rate), (sensor,))
        return np.abs(respond(mass, run)["x"] - exact).max() / np.abs(exact).max()

    assert error(4) < largest
    assert error(16) < error(4) / 10


@pytest.mark.exact
def test_gain_offset_drift_delay_and_limit():
    time = np.linspace(0, 1, 101)
    sensor = Sensor("x", DISPLACEMENT, "sensor_0", gain=2.0, offset=0.3, drift=-0.1, delay=0.02, limit=1.9)
    found = sensor.written(time, 0.01)
    np.testing.assert_allclose(found, np.minimum(2 * np.maximum(time - 0.02, 0) + 0.3 - 0.1 * time, 1.9), atol=1e-12)
    values = np.random.default_rng(1).standard_normal(50)
    np.testing.assert_array_equal(Sensor("x", DISPLACEMENT, "sensor_0").written(values, 0.01), values)


@pytest.mark.exact
def test_a_measurement_is_taken_back_from_what_was_written():
    time = np.linspace(0, 1, 101)
    sensor = Sensor("x", DISPLACEMENT, "sensor_0", gain=2.0, offset=0.3, drift=-0.1, delay=0.02)
    back = sensor.measured(sensor.written(np.sin(7 * time), 0.01), time)
    np.testing.assert_allclose(back[:-2], np.sin(7 * time)[:-2], atol=1e-14)


@pytest.mark.exact
@pytest.mark.parametrize("quantity, source, exact", [
    (DISPLACEMENT, "sensor_1", lambda s, x: x[1]), (VELOCITY, "sensor_1", lambda s, x: s * x[1]),
    (ACCELERATION, "sensor_0", lambda s, x: s**2 * x[0]),
    (JOINT_FORCE, "joint_1", lambda s, x: (50 + 4 * s) * (x[0] - x[1])), (NORMAL_FORCE, "contact", lambda s, x: 0 * s)])
def test_response_to_small_motions(quantity, source, exact):
    rate, moves = 1j * np.array([3.0, 40.0]), np.array([[1.0, 2.0j], [0.5, -1.0]])
    shown = Sensor("x", quantity, source, gain=3.0, delay=0.01, corner=2.0).response(bench(), moves, rate)
    filtered = 3.0 * np.exp(-0.01 * rate) / (1 + rate / (4 * np.pi))
    np.testing.assert_allclose(shown, filtered * exact(rate, moves), rtol=1e-14)


def test_every_measurand_has_a_name_a_unit_and_sources():
    for name, one in MEASURANDS.items():
        assert measurand(name, "here") is one and pickle.loads(pickle.dumps(one)) == one
        assert one.unit == {"displacement": "m", "velocity": "m/s", "acceleration": "m/s^2"}.get(name, "N")
    sources = {name: tuple(one.sources(bench())) for name, one in MEASURANDS.items()}
    assert sources["velocity"] == ("sensor_0", "sensor_1") and sources["joint_force"] == ("joint_0", "joint_1")
    assert sources["input"] == ("input_0", "input_1") and sources["normal_force"] == ("contact",)
    with pytest.raises(ConfigError, match="here: expected one of displacement, .*found 'voltage'"):
        measurand("voltage", "here")
