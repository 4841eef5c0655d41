"""What a sensor writes, takes back and shows of small motions, against closed forms."""

import pickle

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.time_stepping.simulate import Hard
from pipeline.physics.virtual_rig.response import Bench
from pipeline.physics.virtual_rig.sensor import (
    ACCELERATION,
    DISPLACEMENT,
    JOINT_FORCE,
    MEASURANDS,
    NORMAL_FORCE,
    VELOCITY,
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
