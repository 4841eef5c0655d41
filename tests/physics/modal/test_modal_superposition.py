"""The recursion against closed forms, an adaptive integrator, and points that travel."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from pipeline.contract.errors import ConfigError
from pipeline.physics.modal.modal_superposition import Points, fixed_points, modal_response, sharpened, undamped_modes

STEP, SAMPLES = 1e-3, 400
TIME = STEP * np.arange(SAMPLES)
OMEGA = 2 * np.pi * 35.0


def one_mode(force, omega=OMEGA, damping=0.0):
    one = fixed_points(np.ones((1, 1)))
    displacement, velocity = modal_response([omega], [damping], STEP, force[:, None], one, one)
    return displacement[:, 0], velocity[:, 0]


def assert_close(found, exact):
    np.testing.assert_allclose(found, exact, rtol=0, atol=1e-10 * np.abs(exact).max())


@pytest.mark.exact
@pytest.mark.parametrize("zeta", [0.0, 1e-9, 0.02, 0.7])
def test_step_force(zeta):
    damped, decay = OMEGA * np.sqrt(1 - zeta**2), zeta * OMEGA
    fading = np.exp(-decay * TIME)
    displacement, velocity = one_mode(np.ones(SAMPLES), damping=2 * decay)
    swing = np.cos(damped * TIME) + decay / damped * np.sin(damped * TIME)
    assert_close(displacement, (1 - fading * swing) / OMEGA**2)
    assert_close(velocity, fading * np.sin(damped * TIME) / damped)


def ramp_response(time, zeta):
    """Closed form of the response to f = t from rest; 0 before."""
    time, damped, decay = np.maximum(time, 0), OMEGA * np.sqrt(1 - zeta**2), zeta * OMEGA
    swing = 2 * zeta / OMEGA * np.cos(damped * time) + (2 * zeta**2 - 1) / damped * np.sin(damped * time)
    return (time - 2 * zeta / OMEGA + np.exp(-decay * time) * swing) / OMEGA**2


@pytest.mark.exact
@pytest.mark.parametrize("zeta", [0.0, 0.05])
def test_ramp_force(zeta):
    assert_close(one_mode(TIME, damping=2 * zeta * OMEGA)[0], ramp_response(TIME, zeta))


@pytest.mark.exact
def test_sampled_sine():
    """A force linear between samples is a sum of ramps, and so is its response."""
    force = np.sin(2 * np.pi * 20.0 * TIME)
    bends = np.diff(np.diff(force) / STEP, prepend=0.0)
    exact = sum(bend * ramp_response(TIME - start, 0.03) for bend, start in zip(bends, TIME[:-1], strict=True))
    assert_close(one_mode(force, damping=0.06 * OMEGA)[0], exact)


@pytest.mark.exact
def test_over_damped_and_critical():
    slow, fast = 20.0, 300.0
    displacement = one_mode(np.ones(SAMPLES), omega=np.sqrt(slow * fast), damping=slow + fast)[0]
    parts = (fast * np.exp(-slow * TIME) - slow * np.exp(-fast * TIME)) / (fast - slow)
    assert_close(displacement, (1 - parts) / (slow * fast))
    displacement = one_mode(np.ones(SAMPLES), omega=80.0, damping=160.0)[0]
    assert_close(displacement, (1 - (1 + 80 * TIME) * np.exp(-80 * TIME)) / 80**2)


@pytest.mark.exact
def test_rigid_motion():
    displacement, velocity = one_mode(np.ones(SAMPLES), omega=0.0)
    assert_close(displacement, TIME**2 / 2)
    assert_close(velocity, TIME)
    assert_close(one_mode(TIME, omega=0.0)[0], TIME**3 / 6)
    displacement = one_mode(np.ones(SAMPLES), omega=0.0, damping=50.0)[0]
    assert_close(displacement, TIME / 50 - (1 - np.exp(-50 * TIME)) / 50**2)


@pytest.mark.exact
def test_sine_force_converges_with_the_square_of_its_sampling():
    """Only the force between samples is approximate: second order in the step."""
    drive = 2 * np.pi * 20.0
    errors = []
    for step in (2e-3, 1e-3, 5e-4):
        time = np.arange(0, 0.4 + step / 2, step)
        one = fixed_points(np.ones((1, 1)))
        found = modal_response([OMEGA], [0.0], step, np.sin(drive * time)[:, None], one, one)[0][:, 0]
        exact = (np.sin(drive * time) - drive / OMEGA * np.sin(OMEGA * time)) / (OMEGA**2 - drive**2)
        errors.append(np.abs(found - exact).max())
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    np.testing.assert_allclose(orders, 2, atol=0.1)


@pytest.mark.exact
def test_sharpened_samples_keep_the_amplitude_of_a_sine_near_the_limit():
    """A sine at 0.8 of 0.4 samples per period drives a mode beside it: steady amplitude of the continuous sine."""
    cycles, mode, damping = 0.8 * 0.4, 2 * np.pi * 0.3 / STEP, 0.06 * 2 * np.pi * 0.3 / STEP
    drive = 2 * np.pi * cycles / STEP
    exact = drive / abs(mode**2 - drive**2 + 1j * damping * drive)
    force = np.sin(2 * np.pi * cycles * np.arange(2000))
    late = slice(500, 1500)                          # 320 whole periods
    tone = np.exp(-2j * np.pi * cycles * np.arange(1000)) / 500
    found, weakened = (abs(one_mode(f, mode, damping)[1][late] @ tone) for f in (sharpened(force), force))
    assert found == pytest.approx(exact, rel=0.02)
    assert weakened / found == pytest.approx(np.sinc(cycles)**2, rel=0.01)


@pytest.mark.exact
def test_constant_and_linear_samples_are_sharp():
    samples = np.column_stack([np.full(101, 3.0), np.linspace(-1, 5, 101)])
    np.testing.assert_allclose(sharpened(samples), samples, atol=1e-13)
    np.testing.assert_allclose(sharpened(samples.T, axis=1), samples.T, atol=1e-13)


@pytest.mark.exact
def test_against_dop853():
    rng = np.random.default_rng(3)
    omega, damping = 2 * np.pi * np.array([0.0, 12.0, 55.0, 140.0]), np.array([5.0, 0.0, 12.0, 30.0])
    pushed, seen = rng.standard_normal((3, 4)), rng.standard_normal((2, 4))
    forces = rng.standard_normal((60, 3))
    found = modal_response(omega, damping, STEP, forces, fixed_points(pushed), fixed_points(seen))
    state = np.zeros(8)
    for k in range(59):
        def rate(t, y, k=k):
            push = (forces[k] + (forces[k + 1] - forces[k]) * t / STEP) @ pushed
            return np.concatenate([y[4:], push - damping * y[4:] - omega**2 * y[:4]])
        state = solve_ivp(rate, (0, STEP), state, "DOP853", rtol=1e-12, atol=1e-16).y[:, -1]
        np.testing.assert_allclose(found[0][k + 1], seen @ state[:4], rtol=0, atol=1e-10 * np.abs(found[0]).max())
        np.testing.assert_allclose(found[1][k + 1], seen @ state[4:], rtol=0, atol=1e-10 * np.abs(found[1]).max())


def circle_points(angles, starts):
    """Cosine and sine of two nodal diameters along one circle."""
    at = 2 * np.pi * np.arange(angles) / angles
    table = np.stack([np.cos(2 * at), np.sin(2 * at)], axis=1)[None]
    return Points(table, np.zeros(len(starts), dtype=int), np.asarray(starts))


@pytest.mark.exact
def test_constant_force_on_a_turning_body_splits_the_frequency():
    """A force at rest on a body that turns at W drives two nodal diameters at 2 W: closed form per mode."""
    turning = 2 * np.pi * 3.0
    points = circle_points(20000, [0.4])
    found = modal_response([OMEGA] * 2, [0.0] * 2, STEP, np.ones((SAMPLES, 1)), points, points, turning)[0][:, 0]
    drive, phase = 2 * turning, 2 * 0.4

    def response(phase):       # of one mode to cos(phase - drive t) from rest
        swing = np.cos(phase) * np.cos(OMEGA * TIME) + drive / OMEGA * np.sin(phase) * np.sin(OMEGA * TIME)
        return (np.cos(phase - drive * TIME) - swing) / (OMEGA**2 - drive**2)

    now = phase - drive * TIME
    exact = np.cos(now) * response(phase) + np.sin(now) * response(phase - np.pi / 2)
    np.testing.assert_allclose(found, exact, atol=1e-3 * np.abs(exact).max())      # forces linear between samples


def test_turning_changes_nothing_of_an_axisymmetric_mode():
    """Null test: where the participation is the same all around, turning is not seen."""
    points = Points(np.ones((1, 36, 1)), np.zeros(1, dtype=int), np.array([0.7]))
    force = np.random.default_rng(0).standard_normal((SAMPLES, 1))
    turning = modal_response([OMEGA], [1.0], STEP, force, points, points, turning=50.0)
    resting = modal_response([OMEGA], [1.0], STEP, force, points, points)
    # where the response passes zero its terms cancel: rounding is a share of the largest
    np.testing.assert_allclose(turning, resting, rtol=1e-13, atol=1e-13 * np.abs(resting).max())


def test_points_go_around():
    """After whole turns the points stand where they stood; backwards indices wrap."""
    points = circle_points(64, [0.0])
    resting = modal_response([0.0] * 2, [0.0] * 2, STEP, np.ones((2, 1)), points, points)
    turned = modal_response([0.0] * 2, [0.0] * 2, STEP, np.ones((2, 1)), points, points, turning=6 * np.pi / STEP)
    np.testing.assert_allclose(turned, resting, rtol=1e-12)


def test_undamped_modes():
    mass, stiffness = np.diag([2.0, 1.0]), np.array([[400.0, -100.0], [-100.0, 900.0]])
    angular, shape = undamped_modes(mass, stiffness, limit=100.0)
    np.testing.assert_allclose(shape.T @ mass @ shape, np.eye(2), atol=1e-12)
    np.testing.assert_allclose(shape.T @ stiffness @ shape, np.diag(angular**2), atol=1e-9)
    assert len(undamped_modes(mass, stiffness, limit=angular.mean() / (2 * np.pi))[0]) == 1
    with pytest.raises(ConfigError, match="negative eigenvalues"):
        undamped_modes(mass, -stiffness, limit=100.0)
