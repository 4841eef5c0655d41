"""The numbers that the rules see, on linear problems."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from pipeline.inference.decision import candidate_statistics as candidate_statistics_of
from pipeline.inference.decision.candidate_statistics import (
    _beyond,
    _immaterial,
    _one_factor,
    candidate_statistics,
    held_out_gains,
    run_statistics,
    unexplained,
)
from pipeline.inference.decision.evidence import evidence
from pipeline.inference.fitting.fit_state import nominal_p
from pipeline.inference.fitting.least_squares import fit
from pipeline.inference.fitting.parameter_drift import drift
from pipeline.inference.fitting.varying_values import Following
from pipeline.inference.priors import LATENT_LIMIT, HalfNormal, LogNormal, Normal, Parameter, Uniform
from pipeline.inference.problem import Hypothesis
from pipeline.inference.rules import DEFAULTS, DecisionRules
from tests.inference import linear
from tests.inference.tones import null_of


def fits(truth=None, seed=0, held_out=0, sizes=(2, 1, 1), runs=4):
    whole, noise, catalogue, _ = linear.problem(sizes, runs, 60, truth, seed, held_out, 5.0)
    noises = tuple(noise[r.name] for r in whole.training)
    found = [fit(whole, noises, h, np.zeros(len(h.parameters)), whole.training)
             for h in (whole.nominal, *(whole.nominal.joined(c) for c in catalogue))]
    return whole, noise, catalogue, found


def seen(whole, catalogue, found, k, held_out=(None, None)):
    null = found[0]
    return candidate_statistics(null, evidence(null), catalogue[k - 1], found[k], evidence(found[k]), 0.5, 0.01,
                                held_out, np.ones(len(null.runs)), DEFAULTS)


@pytest.mark.exact
def test_the_distance_from_null_is_the_value_over_its_posterior_deviation():
    whole, _, catalogue, found = fits({"effect_1_0": 0.5})
    told = seen(whole, catalogue, found, 1)
    assert told.from_null == pytest.approx(found[1].values["effect_1_0"] / found[1].spread()["effect_1_0"], rel=1e-6)
    assert told.evidence_gain > 20 and told.left_out_gain > 10 and told.unexplained == 0.0
    assert told.held_out_errors is None and told.beats_decoy is None and told.forbidden == ""


def test_a_size_that_trades_with_a_shape_is_judged_by_what_it_takes_off_the_objective():
    """Only size times shape shows: its value is uncertain by the prior of the shape, its presence is not."""
    whole, _, catalogue, found = fits({"effect_1_0": 0.5})
    size = Parameter("size", "1", 0.5, HalfNormal(1.0), 0.0)
    shape = Parameter("shape", "1", 1.0, LogNormal(1.0, 1.0))
    inner, known = whole.predict, [p.name for p in whole.nominal.parameters]

    def predict(hypothesis, values, run):
        grown = {"effect_1_0": values["size"] * values["shape"]} if "size" in values else {}
        return inner(hypothesis, {**{k: values[k] for k in known}, **grown}, run)

    whole = replace(whole, predict=predict)
    traded = Hypothesis("traded", (("traded", "here"),), (size, shape))
    end = fit(whole, found[0].noises, whole.nominal.joined(traded), np.zeros(len(known) + 2), whole.training)
    told = seen(whole, (traded,), [found[0], end], 1)
    assert end.values["size"] / end.spread()["size"] < 2
    assert told.from_null == pytest.approx(np.sqrt(end.weights.max() * end.betters(found[0]))) and told.from_null > 5


def test_values_at_which_it_is_another_law_forbid_an_effect():
    whole, _, catalogue, found = fits({"effect_1_0": -0.5})
    bounded = replace(catalogue[0].parameters[0], within=(0.0, np.inf))
    guarded = (replace(catalogue[0], parameters=(bounded, *catalogue[0].parameters[1:])), *catalogue[1:])
    told = seen(whole, guarded, found, 1)
    assert "is below 0" in told.forbidden and not told.doubts and seen(whole, catalogue, found, 1).forbidden == ""


def test_a_value_at_the_edge_of_its_prior_is_doubted():
    """What is there is ten times what the prior of the candidate allows, or beyond what bounds it."""
    whole, _, catalogue, found = fits({"effect_1_0": 0.5})
    for prior, why in ((HalfNormal(0.03), "the prior of effect_1_0 excludes the data"),
                       (Uniform(-0.4, 0.3), "is at the end of its range, -0.4 to 0.3")):
        narrow = replace(catalogue[0], parameters=(replace(catalogue[0].parameters[0], prior=prior, nominal=0.1),))
        end = fit(whole, found[0].noises, whole.nominal.joined(narrow), np.zeros(len(found[1].latent)), whole.training)
        told = seen(whole, (narrow,), [found[0], end], 1)
        assert why in told.doubts[0]
    assert not seen(whole, catalogue, found, 1).doubts


def test_all_nominal_values_moved_by_one_factor_are_doubted():
    whole, _, catalogue, found = fits({"effect_1_0": 0.5})
    sized = tuple(Parameter(p.name, "1", 1.0, LogNormal(1.0, 1.0)) for p in whole.nominal.parameters)

    def moved(fitted, *logs):
        hypothesis = replace(fitted.hypothesis, parameters=sized + fitted.hypothesis.parameters[len(sized):])
        return replace(fitted, hypothesis=hypothesis, latent=np.concatenate((logs, fitted.latent[len(sized):])))

    null, tenth = moved(found[0], 0.0, 0.1), moved(found[1], -2.3, -2.31)
    assert "moves all nominal values by one factor, 0.1" in _one_factor(tenth, null, DEFAULTS.decision)[0]
    assert not _one_factor(tenth, moved(found[0], -2.3, -2.3), DEFAULTS.decision), "so does the nominal model alone"
    assert not _one_factor(moved(found[1], -2.3, 0.4), null, DEFAULTS.decision)


@pytest.mark.parametrize("change, named", [(0.29, True), (0.35, False)])
def test_a_value_that_follows_time_a_little_is_told_and_one_that_follows_it_much_is_of_another_law(change, named,
                                                                                              monkeypatch):
    monkeypatch.setattr(candidate_statistics_of, "followed", lambda *_: [Following("time", change, 12.0)])
    whole, _, catalogue, found = fits({"effect_1_0": 0.5})
    told = seen(whole, catalogue, found, 1)
    assert (bool(told.remarks), bool(told.varying)) == (named, not named)
    assert f"its value follows time along the runs, by {change:.0%}" in (*told.remarks, *told.varying)[0]


def test_the_right_effect_beats_its_decoy_on_held_out_runs():
    whole, noise, catalogue, found = fits({"effect_1_0": 0.5}, held_out=1)
    gains = held_out_gains(whole, noise, found[0], {0: found[1], 1: found[2]}, np.array([0.99, 0.001]), DEFAULTS)
    assert gains[0][0].errors > 3 and gains[0][1] is True
    assert gains[1][0].errors < 3 and gains[1][1] is None, "the only other candidate is not out of the question"


def test_half_of_an_effect_leaves_a_quarter_of_the_excess():
    whole, _, _, found = fits({"effect_1_0": 4.0})
    half = fit_at(whole, found[1], found[1].latent * [1, 1, 0.5])
    sure = replace(DEFAULTS, decision=DecisionRules(noise_uncertainty=0.0))
    assert unexplained(found[0], half, sure) == pytest.approx(0.25, abs=0.03)
    assert unexplained(found[0], found[2], DEFAULTS) > 0.9


def fit_at(whole, found, latent):
    from pipeline.inference.fitting.fit_state import linearised

    return linearised(whole, found.noises, found.hypothesis, latent, found.runs)


@pytest.mark.exact
def test_the_given_values_are_tested_by_chi_square():
    whole, noise, _, found = fits({"nominal_0": 0.1})
    told = told_of(whole, noise, found[0])
    given = sum(((r.samples / linear.STD) ** 2).sum() for r in whole.runs)
    assert told.moved_p == pytest.approx(stats.chi2.sf(given - found[0].chi_square.sum(), 2), rel=1e-3)
    assert told.runs == told.points == 4 and not told.coherent


def test_the_misfit_of_a_good_model_is_small_and_of_a_bad_one_large():
    good = [misfit({"nominal_0": 1.0}, seed) for seed in range(30)]
    assert max(good) < 3 < misfit({"effect_1_0": 1.0}, 0)


def misfit(truth, seed):
    whole, noise, _, found = fits(truth, seed)
    return told_of(whole, noise, found[0]).misfit


@pytest.mark.exact
def test_held_out_runs_are_off_as_chi_square_is_what_the_values_leave_open():
    """Values that 240 samples tell, of three runs, err in the fourth: (I + J C J') whitens that."""
    rules = replace(DEFAULTS, decision=DecisionRules(noise_uncertainty=0.0))
    off = [told_of(whole, noise, found[0], rules).held_out for whole, noise, _, found in (
        fits({"nominal_0": 1.0}, seed, held_out=1, sizes=(20,)) for seed in range(60))]
    assert abs(np.mean(off)) < 3.5 / np.sqrt(60) and np.std(off) == pytest.approx(1.0, abs=0.35)


def test_held_out_runs_that_differ_from_the_fitted_ones_are_seen():
    whole, noise, _, found = fits({"nominal_0": 1.0}, held_out=1)
    other = tuple(replace(r, samples=r.samples + linear.STD) if r in whole.held_out else r for r in whole.runs)
    assert told_of(whole, noise, found[0]).held_out < 3 < told_of(replace(whole, runs=other), noise, found[0]).held_out


def told_of(whole, noise, null, rules=None):
    return run_statistics(whole, noise, null, np.ones(len(null.runs)), drift(null), rules or DEFAULTS)


def test_what_has_no_optimum_is_compared_only_by_far():
    """The recalibration did not converge: a candidate a little below it is doubted, one far below it is not."""
    whole, _, catalogue, found = fits()
    null = replace(fit_at(whole, found[0], found[0].latent + 0.1), converged=False)
    doubted = seen(whole, catalogue, [null, *found[1:]], 1)
    assert any("recalibration" in told for told in doubted.doubts) and not seen(whole, catalogue, found, 1).doubts
    far = replace(null, residuals=tuple(10 * r for r in null.residuals))
    assert not seen(whole, catalogue, [far, *found[1:]], 1).doubts


def test_a_fit_or_a_recalibration_that_ended_where_its_slopes_promise_nothing_is_not_doubted():
    whole, _, catalogue, found = fits({"effect_1_0": 4.0})
    ended = replace(found[1], converged=False)
    assert not seen(whole, catalogue, [replace(found[0], converged=False), ended, found[2]], 1).doubts
    away = fit_at(whole, ended, found[1].latent * [1, 1, 0.5])
    assert any("did not converge" in told for told in seen(whole, catalogue, [found[0], away, found[2]], 1).doubts)


def test_another_name_for_nearly_the_same_force_is_no_decoy():
    whole, noise, catalogue, tables = linear.problem((2, 1, 1), runs=4, held_out=1, truth={"effect_1_0": 0.6})
    for table in tables.values():
        table["effect_2_0"] = 0.999 * table["effect_1_0"]
    noises = tuple(noise[r.name] for r in whole.training)
    null = fit(whole, noises, whole.nominal, np.zeros(2), whole.training)
    fits = {k: fit(whole, noises, whole.nominal.joined(c), np.zeros(3), whole.training)
            for k, c in enumerate(catalogue)}
    gains = held_out_gains(whole, noise, null, fits, np.array([0.99, 0.01]), DEFAULTS)
    assert gains[0][1] is None and gains[0][0].errors > 3


def test_no_change_of_a_value_at_the_end_of_its_prior_is_more_than_its_whole_range():
    whole, _, catalogue, found = fits({"effect_1_0": 0.5})
    own = replace(catalogue[0], parameters=(replace(catalogue[0].parameters[0], prior=Uniform(0.0, 1.0)),))
    ended = fit_at(whole, replace(found[1], hypothesis=whole.nominal.joined(own)),
                   np.append(found[1].latent[:-1], LATENT_LIMIT))
    assert _immaterial(ended, len(ended.latent) - 1, DEFAULTS.decision) == LATENT_LIMIT


@pytest.mark.exact
def test_nominal_values_count_together_under_their_priors():
    """chi^2 of what is common to all runs, no more: neither effects nor starts of single runs."""
    _, null = null_of({})
    third = Parameter("start", "m", 0.0, Normal(0.0, 1.0), run="one")
    size = Parameter("force", "N", 0.1, HalfNormal(1.0), null=0.0)
    hypothesis = replace(null.hypothesis, parameters=(*null.hypothesis.parameters, third, size))
    asked = replace(null, hypothesis=hypothesis, latent=np.array([3.0, 9.0, 9.0]))
    assert nominal_p(asked, hypothesis) == pytest.approx(stats.chi2.sf(9.0, 1))


@pytest.mark.parametrize("ratio, told", [
    (0.29, []), (0.31, ["its damping_ratio of 0.31 is above 0.3, where it is another law"])])
def test_a_value_at_which_an_effect_is_another_one_is_told(ratio, told):
    _, null = null_of({})
    shape = Parameter("absorber@mass_0.damping_ratio", "1", 0.03, LogNormal(0.03, 1.0), within=(0.0, 0.3))
    candidate = Hypothesis("absorber at mass_0", (("absorber", "mass_0"),), (shape,))
    found = replace(null, hypothesis=null.hypothesis.joined(candidate),
                    latent=np.append(null.latent, shape.prior.latent(ratio)))
    assert list(_beyond(found, candidate)) == told
    beside = Hypothesis("gain of x", (("sensor_gain", "x"),), ())
    assert list(_beyond(found, beside)) == [
        each.replace("its damping_ratio", "absorber@mass_0.damping_ratio, beside it,") for each in told]
