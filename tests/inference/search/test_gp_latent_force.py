"""Unknown physics: the smoother against dense Gaussian-process regression, and what a force depends on."""

import numpy as np
import pytest
from scipy import stats

from pipeline.contract.errors import ConvergenceError
from pipeline.inference.search.gp_latent_force import (
    dependence,
    latent_force,
    loop_area,
    memory,
    order_locked,
    slow_drift,
    smooth,
)

RATE = 100.0


def matern(distance, size, length):
    return size**2 * (1 + distance / length) * np.exp(-distance / length)


def dense(residual, valid, size, length, noise):
    """Mean, standard deviation and log likelihood by matrices."""
    time = np.arange(len(residual)) / RATE
    whole = matern(np.abs(time[:, None] - time), size, length)
    seen = whole[np.ix_(valid, valid)] + noise**2 * np.eye(valid.sum())
    gain = np.linalg.solve(seen, whole[valid]).T
    log = stats.multivariate_normal(np.zeros(valid.sum()), seen).logpdf(residual[valid])
    return gain @ residual[valid], np.sqrt(np.diag(whole - gain @ whole[valid])), log


@pytest.mark.exact
def test_the_smoother_is_gaussian_process_regression():
    generator = np.random.default_rng(0)
    residual, valid = generator.standard_normal(80).cumsum(), np.ones(80, bool)
    valid[30:45] = False
    told = smooth(residual, RATE, 3.0, 0.07, 0.4, valid)
    mean, std, log = dense(residual, valid, 3.0, 0.07, 0.4)
    np.testing.assert_allclose(told.mean, mean, atol=1e-8)
    np.testing.assert_allclose(told.std, std, atol=1e-8)
    assert told.log_likelihood == pytest.approx(log, abs=1e-8)


def test_hyperparameters_and_force_are_recovered():
    time, generator = np.arange(2000) / RATE, np.random.default_rng(1)
    root = np.linalg.cholesky(matern(np.abs(time[:, None] - time), 2.0, 0.2) + 1e-10 * np.eye(2000))
    force = root @ generator.standard_normal(2000)
    told = latent_force(force + 0.5 * generator.standard_normal(2000), RATE)
    assert told.size == pytest.approx(2.0, rel=0.4) and told.length == pytest.approx(0.2, rel=0.3)
    assert told.noise == pytest.approx(0.5, rel=0.06)
    assert np.mean(np.abs(told.mean - force) < 1.96 * told.std) == pytest.approx(0.95, abs=0.03)


def test_a_residual_that_does_not_vary_holds_no_force():
    with pytest.raises(ConvergenceError, match="a residual that varies"):
        latent_force(np.ones(50), RATE)


def correlated(seed, size=3000, length=15):
    white = np.random.default_rng(seed).standard_normal(size + length)
    return np.convolve(white, np.ones(length) / np.sqrt(length), "valid")[:size]


def test_dependence_is_found_and_its_p_value_even_without():
    p_values = [dependence("speed", correlated(s), correlated(1000 + s), draws=199, seed=s).p_value for s in range(150)]
    assert stats.kstest(p_values, "uniform").statistic < 1.63 / np.sqrt(150)
    speed = correlated(1)
    told = dependence("speed", np.tanh(2 * speed) + 0.2 * correlated(2), speed)
    assert told.share > 0.85 and told.p_value < 0.01
    assert np.abs(told.curve[np.abs(told.centre) > 1]).min() > 0.7 and np.all(np.diff(told.centre) > 0)


def test_forces_that_follow_a_rotation_are_told():
    angle = 2 * np.pi * (3 * np.arange(3000) / 1000 + 0.3 * np.sin(np.arange(3000) / 400))
    share, p_value = order_locked(np.cos(angle) + 0.4 * np.sin(2 * angle) + 0.5 * correlated(3), angle)
    assert share > 0.6 and p_value < 0.05
    assert order_locked(correlated(4), angle)[1] > 0.05


def test_slow_drift_of_a_force_is_told():
    growing = np.linspace(0.5, 2.0, 3000)
    assert slow_drift(growing * correlated(5))[1] < 0.01
    p_values = [slow_drift(correlated(s), draws=199, seed=s)[1] for s in range(150)]
    assert stats.kstest(p_values, "uniform").statistic < 1.63 / np.sqrt(150)


@pytest.mark.exact
def test_the_area_of_loops_is_the_work_of_friction_and_of_viscosity():
    angle = np.linspace(0, 2 * np.pi, 20001)
    moved, speed = 0.01 * np.sin(angle), 0.01 * np.cos(angle)
    assert loop_area(3.0 * np.sign(speed), moved) == pytest.approx(4 * 3.0 * 0.01, rel=1e-3)
    assert loop_area(5.0 * speed, moved) == pytest.approx(np.pi * 5.0 * 0.01**2, rel=1e-6)
    assert loop_area(200.0 * moved + 1e4 * moved**3, moved) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.exact
def test_memory_is_what_is_left_at_no_frequency():
    frequency, std = np.array([0.5, 1.0, 2.0, 4.0]), np.full(4, 0.01)
    dry, viscous = memory(frequency, 0.3 + 0.1 * frequency, std), memory(frequency, 0.1 * frequency, std)
    assert dry.static == pytest.approx(0.3) and dry.growth == pytest.approx(0.1) and dry.present
    assert viscous.static == pytest.approx(0.0, abs=1e-12) and not viscous.present
    assert dry.std == pytest.approx(0.01 * np.sqrt(np.sum(frequency**2) / (4 * np.sum((frequency - 1.875) ** 2))))
