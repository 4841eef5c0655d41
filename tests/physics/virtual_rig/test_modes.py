"""Modes of a bench as its sensors see them: closed forms of a pin on an arm."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.physics.virtual_rig.modes import modes, order_locked, sticking
from tests.diagnosis.small_bench import ARM, BENDING, CARRIAGE, CONTACT, PIN, SHEAR, TILT, bench, run


def undamped(stiffness):
    """Natural frequencies in rad/s of pin and carriage."""
    return np.sqrt(np.sort(np.linalg.eigvals(stiffness / np.array([[PIN], [CARRIAGE]])).real))


@pytest.mark.exact
def test_lifted_modes_are_those_of_the_parts():
    root, _ = modes(bench(), run("lifted"))
    damped = [np.sqrt(k / m - (c / (2 * m)) ** 2) for k, m, c in ((ARM, CARRIAGE, 5.0), (BENDING, PIN, 8.0))]
    np.testing.assert_allclose(root.imag, damped, rtol=1e-12)
    np.testing.assert_allclose(root.real, [-5.0, -4.0], rtol=1e-9)


@pytest.mark.exact
def test_at_rest_the_contact_holds_along_sliding():
    stiffness = np.array([[BENDING + SHEAR, 0], [0, ARM]]) + CONTACT * np.outer([TILT, 1], [TILT, 1])
    np.testing.assert_allclose(abs(modes(bench(), run("rest"))[0]), undamped(stiffness), rtol=2e-4)


@pytest.mark.exact
def test_in_sliding_friction_couples_them():
    """K + k (n + mu t) n^T, not symmetric; the same at every load and speed."""
    stiffness = np.diag([BENDING, ARM]) + CONTACT * np.outer([TILT + 0.3, 1], [TILT, 1])
    for name in ("slow_5", "slow_10", "fast"):
        np.testing.assert_allclose(abs(modes(bench(), run(name))[0]), undamped(stiffness), rtol=2e-4)


def test_sensors_at_one_point_differ_by_gain_and_delay():
    late = bench().with_channels(lambda c: replace(c, gain=1.2, delay=1e-4) if c.name == "accelerometer" else c)
    root, shape = modes(late, run("slow_10"))
    np.testing.assert_allclose(shape[:, 1], 1.2 * np.exp(-1e-4 * root) * shape[:, 0], rtol=1e-12)


def test_a_lifted_pin_is_clear_of_the_waves_of_the_surface():
    hidden = {"runout": {"contact": {"amplitude": "3 um", "order": 1, "phase": "0 rad"}}}
    np.testing.assert_array_equal(modes(bench(hidden), run("lifted"))[0], modes(bench(), run("lifted"))[0])


def test_a_contact_that_sticks_needs_a_stiffness():
    with pytest.raises(ConfigError, match="tangential stiffness"):
        sticking(bench(description="rigid", tangential_stiffness=None), run("rest"))


@pytest.mark.exact
def test_runout_loads_arm_and_contact_in_series():
    """Carriage and pin follow the surface: f = -k_arm z with (K + k (n + mu t) n^T) q = -k u (n + mu t)."""
    hidden = {"runout": {"contact": {"amplitude": "3 um", "order": 2, "phase": "0.7 rad"}}}
    pushed = np.array([TILT + 0.3, 1.0])
    moved = np.linalg.solve(np.diag([BENDING, ARM]) + CONTACT * np.outer(pushed, [TILT, 1]), -CONTACT * pushed)
    found = order_locked(bench(hidden), run("slow_10"), "arm", (1, 2, 3))
    np.testing.assert_allclose(found, [0, ARM * moved[1] * 3e-6 * np.exp(0.7j), 0], atol=1e-9)
    assert not order_locked(bench(), run("slow_10"), "arm", (1, 2)).any()
