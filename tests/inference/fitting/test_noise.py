"""The error budget: noise from repeats, bands and densities, whitening, floors."""

import numpy as np
import pytest
from scipy.signal import lfilter

from pipeline.contract.errors import ConfigError
from pipeline.inference.fitting.noise import (
    autocovariance,
    budget,
    floor,
    from_density,
    from_high_band,
    from_repeats,
    normalised_error,
    whitening,
)
from pipeline.inference.problem import Observed, Problem
from tests.inference.oscillator import NOMINAL, predict

RATE = 100.0


def coloured(seed, size, coefficient=0.8, std=0.3):
    """First-order autoregressive series (size,) of innovation ``std``."""
    return lfilter([1.0], [1.0, -coefficient], std * np.random.default_rng(seed).standard_normal(size + 200))[200:]


def run(samples, name="a", **more):
    samples = np.atleast_2d(samples)
    return Observed(name, {}, tuple(f"c{k}" for k in range(len(samples))), samples, RATE, **more)


@pytest.mark.exact
def test_the_filter_of_a_known_covariance_is_the_autoregression_itself():
    covariance = 0.3**2 / (1 - 0.8**2) * 0.8 ** np.arange(5)[None]
    noise = whitening(run(np.zeros(50)), covariance)
    np.testing.assert_allclose(noise.filter * 0.3, [[1.0, -0.8, 0.0, 0.0, 0.0]], atol=1e-9)
    assert noise.std[0] == pytest.approx(0.5)


@pytest.mark.exact
def test_a_density_gives_the_covariance_it_is_made_of():
    frequency = np.linspace(0, RATE / 2, 2001)
    density = 2 / RATE * 0.3**2 / np.abs(1 - 0.8 * np.exp(-2j * np.pi * frequency / RATE)) ** 2
    expected = 0.3**2 / (1 - 0.8**2) * 0.8 ** np.arange(5)
    np.testing.assert_allclose(from_density(density[None], RATE, 4)[0], expected, rtol=1e-9)


def test_whitened_coloured_noise_is_white_and_of_power_one():
    repeats = [run(np.sin(np.arange(20000) / 50) + coloured(k, 20000), str(k)) for k in range(3)]
    noise = whitening(repeats[0], from_repeats(repeats))
    white = noise.whiten(coloured(9, 20000)[None])
    correlation = autocovariance(white[None], np.ones((1, len(white)), bool), 5)[0]
    assert abs(correlation[0] - 1) < 0.03 and np.abs(correlation[1:]).max() < 4 / np.sqrt(20000)


@pytest.mark.exact
def test_repeats_are_unbiased():
    ratio = [from_repeats([run(np.random.default_rng(10 * s + k).standard_normal(500), str(k)) for k in range(2)], 0)
             for s in range(100)]
    assert abs(np.mean(ratio) - 1) < 4 * np.sqrt(2 / 500 / 100)


def test_noise_is_read_from_a_band_without_signal():
    signal = 5 * np.sin(2 * np.pi * 3 * np.arange(4096) / RATE)
    noisy = run(signal + 0.1 * np.random.default_rng(0).standard_normal(4096))
    assert from_high_band(noisy, 20.0)[0, 0] == pytest.approx(0.01, rel=4 * np.sqrt(1 / (0.6 * 2048)))


@pytest.mark.exact
def test_samples_that_are_missing_are_no_part_of_the_noise_of_a_band():
    """About an offset zeros in their place would be steps; in the place of half the run they would halve its power."""
    samples = 1.0 + 0.1 * np.random.default_rng(4).standard_normal((2, 2048))
    valid = np.ones((2, 2048), bool)
    valid[:, :1024] = valid[1, 1500] = False
    found = from_high_band(run(samples, valid=valid), 20.0)
    assert found[:, 0] == pytest.approx([0.01, 0.01], rel=4 * np.sqrt(1 / (0.6 * 547)))
    valid[1] = False
    with pytest.raises(ConfigError, match="c1: expected samples without a gap to tell noise beyond 20 Hz, found 0"):
        from_high_band(run(samples, valid=valid), 20.0)


def test_missing_samples_never_enter_a_whitened_one():
    covariance = 0.25 * 0.8 ** np.arange(3)[None]
    valid = np.ones((1, 40), bool)
    valid[0, [10, 25]] = False
    noise = whitening(run(np.zeros(40), valid=valid), covariance)
    series = np.random.default_rng(0).standard_normal((1, 40))
    spoiled = np.where(valid, series, 1e9)
    np.testing.assert_array_equal(noise.whiten(series), noise.whiten(spoiled))
    assert noise.count == 40 - 2 - 6 and len(noise.whiten(series)) == noise.count


@pytest.mark.exact
def test_solver_error_adds_its_power():
    error = 0.4 * np.random.default_rng(1).choice([-1.0, 1.0], (1, 4000))
    problem = Problem((run(np.zeros(4000), noise_std=np.array([0.3])),), predict, NOMINAL)
    assert budget(problem, {"a": error})["a"].std[0] == pytest.approx(0.5)
    assert budget(problem)["a"].std[0] == pytest.approx(0.3)


@pytest.mark.exact
def test_noise_may_change_along_the_run():
    std = np.linspace(0.1, 1.0, 30)[None]
    problem = Problem((run(np.zeros(30), noise_std=std),), predict, NOMINAL)
    np.testing.assert_allclose(budget(problem)["a"].whiten(std), 1.0)


@pytest.mark.exact
def test_the_floor_is_the_error_of_the_true_model():
    generator = np.random.default_rng(2)
    clean = np.sin(np.arange(5000) / 7)[None] * [[1.0], [20.0]]
    std = np.array([0.1, 4.0])
    noisy = run(clean + std[:, None] * generator.standard_normal(clean.shape), noise_std=std)
    noise = budget(Problem((noisy,), predict, NOMINAL))["a"]
    expected = np.sqrt(np.mean(std**2 / noisy.samples.var(axis=1)))
    assert floor(noisy, noise) == pytest.approx(expected, rel=1e-9)
    assert normalised_error(noisy, noisy.samples - clean) == pytest.approx(expected, rel=4 / np.sqrt(5000))


def test_runs_take_the_first_noise_they_have():
    first, again = (run(coloured(k, 3000), str(k), repeat_of="0" * k) for k in range(2))
    noises = budget(Problem((first, again, run(coloured(5, 3000), "c")), predict, NOMINAL), above=30.0)
    assert noises["0"].filter.shape == (1, 9) and noises["c"].filter.shape == (1, 1)


@pytest.mark.parametrize("make, told", [
    (lambda: budget(Problem((run(np.zeros(8)),), predict, NOMINAL)), "a given noise, a repeat of any run, or a band"),
    (lambda: whitening(run(np.zeros(8)), [[0.0]]), "a positive power on every channel"),
    (lambda: from_high_band(run(np.zeros(8)), 60.0), "below half the sample rate"),
    (lambda: from_repeats([run(np.zeros(8)), run(np.zeros(9), "b")]), "two or more runs of the same length"),
])
def test_unusable_noise_is_refused(make, told):
    with pytest.raises(ConfigError, match=told):
        make()


def test_noise_of_a_cut_run_whitens_its_first_samples_alike():
    whole = run(coloured(3, 500))
    noise = whitening(whole, autocovariance(whole.samples, whole.valid, 2))
    cut = whole.until(60)
    np.testing.assert_allclose(noise.until(60).whiten(cut.samples), noise.whiten(whole.samples)[:58], rtol=1e-12)


def test_a_horizon_counts_usable_samples_from_the_begin():
    whole = run(coloured(3, 500))
    noise = whitening(whole, [[1.0]])
    noise.usable[:, :200] = False
    assert noise.horizon(0.1, 8) == 230 and noise.horizon(0.1, 64) == 264 and noise.horizon(1.0, 8) == 500
    assert noise.until(noise.horizon(0.1, 8)).count == 30
    noise.usable[:] = False
    assert noise.horizon(0.1, 8) == 500


def test_channels_without_samples_do_not_count_in_errors():
    one = Observed("rung", {}, ("seen", "lost", "lost too"), np.array([[2.0], [0.0], [0.0]]), None,
                   np.array([[True], [False], [False]]), noise_std=np.array([0.1, 1.0, 1.0]))
    noise = budget(Problem((one,), predict, NOMINAL))["rung"]
    assert normalised_error(one, np.array([[0.5], [0.0], [0.0]])) == pytest.approx(0.25)
    assert floor(one, noise) == pytest.approx(0.05)


@pytest.mark.exact
def test_one_repeat_tells_the_noise_of_all_runs():
    """Runs of other lengths take the noise of the one that was repeated; with other channels they do not."""
    random = np.random.default_rng(12)
    runs = [run(np.sin(np.arange(4000) / 50) + 0.1 * random.standard_normal(4000), name, repeat_of=first)
            for name, first in (("a", ""), ("b", "a"))]
    other = run(np.cos(np.arange(900) / 20) + 0.1 * random.standard_normal(900), "c")
    noises = budget(Problem((*runs, other), None, None))
    assert [noises[name].std[0] for name in "abc"] == pytest.approx([0.1] * 3, rel=4 / np.sqrt(2 * 4000))
    assert noises["c"].usable.shape == (1, 900)
    with pytest.raises(ConfigError, match="a repeat of any run"):
        budget(Problem((*runs, run(np.zeros((2, 900)), "c")), None, None))
