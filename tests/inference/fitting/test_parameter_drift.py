"""Drift over operating points: Q in closed form, its null, what drifts, and agreement of a coefficient."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from scipy import stats

from pipeline.inference.fitting.least_squares import fit
from pipeline.inference.fitting.parameter_drift import agreement, drift, scatter, spread, trend
from tests.inference import linear


def fitted(**more):
    whole, noise, _, tables = linear.problem((2,), prior=50.0, **more)
    found = fit(whole, tuple(noise[r.name] for r in whole.training), whole.nominal, np.zeros(2), whole.training)
    return whole, found, tables


def own_estimates(whole, tables):
    """Least-squares values (run, k) of every run alone, and their information (run, k, k)."""
    rows = []
    for run in whole.training:
        design = np.array([tables[run.name][p.name] for p in whole.nominal.parameters]).T / linear.STD
        rows.append((np.linalg.lstsq(design, run.samples[0] / linear.STD, rcond=None)[0], design.T @ design))
    return (np.array(part) for part in zip(*rows, strict=True))


@pytest.mark.exact
def test_the_statistic_is_that_of_the_definition():
    whole, found, tables = fitted(runs=4, truth={"nominal_0": 1.0})
    value, information = own_estimates(whole, tables)
    mean = np.linalg.solve(information.sum(axis=0), np.einsum("iab,ib->a", information, value))
    expected = np.einsum("ia,iab,ib->", value - mean, information, value - mean)
    result = drift(found)
    assert result.statistic == pytest.approx(expected, rel=1e-3) and result.freedom == 6


@pytest.mark.exact
def test_its_null_is_the_chi_square_distribution_where_priors_are_wide():
    for seed in range(5):
        result = drift(fitted(runs=4, seed=seed)[1])
        expected = stats.chi2.sf(result.statistic, 6)
        assert result.p_value == pytest.approx(expected, abs=4 * np.sqrt(expected * (1 - expected) / 4000) + 1e-3)


def test_p_values_are_even_where_nothing_drifts():
    p_values = [drift(fitted(runs=4, seed=seed, truth={"nominal_1": 2.0})[1], draws=500).p_value for seed in range(150)]
    assert stats.kstest(p_values, "uniform").statistic < 1.63 / np.sqrt(150)


def test_one_point_drifts_from_no_other_however_odd_its_values():
    """What is left of Q is the pull of the prior: values 4 of its standard deviations off."""
    found = drift(fitted(runs=1, truth={"nominal_0": 200.0})[1])
    assert found.freedom == 0 and found.p_value == 1.0


def test_a_value_that_follows_the_load_drifts_and_says_so():
    whole, found, tables = fitted(runs=4, truth={"nominal_0": 1.0})
    moved = partial(_following_load, whole.predict)
    runs = tuple(type(run)(run.name, run.conditions, run.channels, run.samples + moved(whole, tables, run), run.rate,
                           noise_std=run.noise_std) for run in whole.runs)
    changed = type(whole)(runs, whole.predict, whole.nominal)
    noises = found.noises
    result = drift(fit(changed, noises, changed.nominal, np.zeros(2), changed.training))
    load = np.array([run.conditions["load"] for run in runs])
    assert result.p_value < 0.001 and trend(result, 0, load) > 5 > 3 > abs(trend(result, 1, load))


def _following_load(_, whole, tables, run):
    return 0.3 * run.conditions["load"] * tables[run.name]["nominal_0"][None]


@pytest.mark.exact
def test_agreement_is_chi_square_over_points_and_forgives_what_does_not_matter():
    whole, found, tables = fitted(runs=6, samples=400)
    value, information = own_estimates(whole, tables)
    std = 1 / np.sqrt(information[:, 0, 0] - information[:, 0, 1] ** 2 / information[:, 1, 1])
    mean = np.average(value[:, 0], weights=std**-2)
    expected = np.sum(((value[:, 0] - mean) / std) ** 2)
    assert 2 * stats.norm.sf(agreement(found, 0)[0]) == pytest.approx(stats.chi2.sf(expected, 5), abs=0.01)
    assert agreement(found, 0, tolerance=10.0)[0] == pytest.approx(0.0, abs=0.01)


def scattered(seed, spread_of_truth, runs=8, repeat_of=()):
    """Fit of one value that differs from run to run by ``spread_of_truth``, about 2; wide prior."""
    whole, noise, _, tables = linear.problem((1,), runs, 60, None, seed, prior=50.0)
    value = 2.0 + spread_of_truth * np.random.default_rng(1000 + seed).standard_normal(runs)
    shifted = tuple(replace(run, samples=run.samples + v * tables[run.name]["nominal_0"], repeat_of=of)
                    for run, v, of in zip(whole.runs, value, repeat_of or [""] * runs, strict=True))
    whole = replace(whole, runs=shifted)
    return fit(whole, tuple(noise[r.name] for r in whole.training), whole.nominal, np.zeros(1), whole.training)


@pytest.mark.parametrize("truth, least", [(0.0, 0.93), (0.3, 0.90)])
def test_stated_deviations_hold_where_values_differ_from_run_to_run(truth, least):
    found = [scattered(seed, truth) for seed in range(200)]
    off = [abs(f.values["nominal_0"] - 2.0) / spread(f)["nominal_0"] for f in found]
    assert least < np.mean(np.array(off) < 2) < 0.985
    if truth:
        noise_alone = [abs(f.values["nominal_0"] - 2.0) / f.spread()["nominal_0"] for f in found]
        assert np.mean(np.array(noise_alone) < 2) < 0.6, "noise alone promises too much"
        sizes = [scatter(f)[0][0] * 50.0 for f in found]
        assert np.sqrt(np.mean(np.square(sizes))) == pytest.approx(truth, rel=0.1)


def test_repeats_that_differ_say_how_far_points_may():
    """Five runs of each of two points: what they differ by among themselves does not count between points."""
    repeats = ["", *["run_0"] * 4, "", *["run_5"] * 4]
    disagreement = [agreement(scattered(seed, 0.3, 10, repeats), 0)[0] for seed in range(60)]
    alone = [agreement(scattered(seed, 0.3, 10), 0)[0] for seed in range(60)]
    assert np.mean(np.array(disagreement) > 3) < 0.05 < 0.9 < np.mean(np.array(alone) > 3)
