"""The screen: exact scores, their family-wise null, signs, shapes, directions that parameters hide."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy import stats

from pipeline.inference.fitting.fit_state import from_prior_mean
from pipeline.inference.fitting.least_squares import fit
from pipeline.inference.priors import Factors, HalfNormal, LogNormal, Normal, Parameter, Uniform
from pipeline.inference.problem import Hypothesis
from pipeline.inference.search.score_screen import (
    _each_once,
    _trials,
    directions,
    directions_with_tones,
    faint,
    family_p,
    largest_scores,
    reshaped,
    screen,
    shapes_like,
)
from pipeline.inference.search.subset_selection import left_by
from tests.inference import linear
from tests.inference.tones import DRAG, RIPPLE, TRUE, null_of


def screened(seed=0, sizes=(2, 1, 1, 1), truth=None, draws=2000):
    whole, noise, catalogue, tables = linear.problem(sizes, seed=seed, truth=truth)
    null = fit(whole, tuple(noise[r.name] for r in whole.training), whole.nominal, np.zeros(sizes[0]), whole.training)
    found = [directions(whole, null, candidate) for candidate in catalogue]
    return whole, catalogue, tables, null, found, screen(null, found, draws=draws)


@pytest.mark.exact
def test_scores_are_those_of_generalised_least_squares():
    whole, catalogue, tables, _, _, result = screened(truth={"effect_2_0": 0.3})
    data, design = linear.dense(whole, whole.nominal, tables)
    inverse = np.linalg.inv(np.eye(len(data)) + design @ design.T)
    for k, candidate in enumerate(catalogue):
        g = linear.dense(whole, candidate, tables)[1][:, 0]
        assert result.score[k] == pytest.approx(abs(g @ inverse @ data) / np.sqrt(g @ inverse @ g), abs=1e-3)
        assert result.power[k] == pytest.approx(np.sqrt(g @ inverse @ g), rel=1e-6)
    assert result.order()[0] == 1 and result.p_value[1] < 0.01


def test_family_wise_p_values_are_even_under_the_null():
    smallest = [screened(seed, draws=500)[-1].p_value.min() for seed in range(200)]
    assert stats.kstest(smallest, "uniform").statistic < 1.63 / np.sqrt(200)


@pytest.mark.exact
def test_the_largest_of_independent_scores_is_sidak():
    largest = largest_scores(np.eye(6), np.zeros(6, int), 40000)
    one_sided = largest_scores(np.eye(6), np.ones(6, int), 40000)
    for bound in (1.0, 2.0, 3.0):
        for drawn, tail in ((largest, 2 * stats.norm.sf(bound)), (one_sided, stats.norm.sf(bound))):
            expected = 1 - (1 - tail) ** 6
            assert family_p(bound, drawn) == pytest.approx(expected, abs=4 * np.sqrt(expected / 40000))


@pytest.mark.exact
def test_equal_directions_cost_nothing():
    largest = largest_scores(np.ones((5, 5)), np.zeros(5, int), 40000)
    assert family_p(2.0, largest) == pytest.approx(2 * stats.norm.sf(2.0), abs=4 * np.sqrt(0.05 / 40000))


def test_one_direction_counts_once_among_the_first_candidates():
    found = scored([9.0, 9.0, 9.0 + 1e-9, 7.0, 6.0, 5.0], "aaabcd")
    assert _each_once([0, 1, 2, 3, 4, 5], found, 3) == (0, 3, 4, 1, 2, 5)
    assert _each_once([0, 1, 2], found, 3) == (0, 1, 2)
    assert _each_once([], found, 3) == ()


def test_the_same_direction_at_another_place_is_a_rival_and_counts():
    assert _each_once([0, 1, 2, 3], scored([9.0, 9.0, 9.0, 7.0], "aabc"), 3) == (0, 2, 3, 1)


def scored(score, places):
    """What is known of a Screen: scores of candidates at places."""
    return SimpleNamespace(score=np.array(score), candidates=[
        Hypothesis(f"{k}", ((f"effect_{k}", place),)) for k, place in enumerate(places)])


def test_a_faint_start_is_near_a_null_at_the_end_of_its_prior_alone():
    gap = Parameter("gap", "m", 1e-4, LogNormal(1e-4, 2.0), 0.0)
    factor = Parameter("factor", "1", 0.1, Factors((10.0, 0.1), 0.01), 1.0)
    time = Parameter("time", "s", 1.0, LogNormal(1.0, 1.0))
    found = faint(Hypothesis("some", (("some", "here"),), (gap, factor, time)), np.array([0.5, -0.2, 1.0]))
    np.testing.assert_allclose(found, [-3.0, -0.2, 1.0])


def test_a_direction_inside_the_parameters_is_never_found():
    whole, _, tables, null, _, _ = screened()
    hidden = Hypothesis("hidden", (("hidden", "here"),), (Parameter("hidden", "1", 0.0, HalfNormal(1e-3), 0.0),))
    for run in whole.runs:
        tables[run.name]["hidden"] = 1e6 * tables[run.name]["nominal_0"]
    result = screen(null, [directions(whole, null, hidden)])
    assert result.score[0] < 3 and result.p_value[0] > 0.01


def test_signs_are_kept_and_shapes_are_tried():
    whole, noise, _, tables = linear.problem((1, 1), truth={"effect_1_0": -1.0})
    amplitude = Parameter("amount", "1", 0.5, HalfNormal(1.0), 0.0)
    shape = Parameter("shape", "1", 0.5, Uniform(0.0, 1.0))

    def predict(hypothesis, values, run):
        grown = values.get("amount", 0.0) * values.get("shape", 0.0) * tables[run.name]["effect_1_0"]
        return (values["nominal_0"] * tables[run.name]["nominal_0"] + grown)[None]

    whole = type(whole)(whole.runs, predict, whole.nominal)
    null = fit(whole, tuple(noise[r.name] for r in whole.training), whole.nominal, np.zeros(1), whole.training)
    found = directions(whole, null, Hypothesis("grown", (("grown", "here"),), (amplitude, shape)))
    assert len(found.vectors) == 4 and set(found.sign) == {1}
    assert sorted({round(float(t[1]), 3) for t in found.tried}) == [-0.842, 0.842]
    start = screen(null, [found]).start[0]
    assert 0 < amplitude.prior.value(start[0]) < 0.03     # of its sign, though the data ask for the other
    assert screen(null, [found]).score[0] < 0 < 0.5 < screen(null, [found]).p_value[0]


@pytest.mark.exact
def test_a_gap_out_of_reach_is_tried_as_one_that_closes():
    """What stays within a gap feels nothing of a wider one: only a narrower one has a direction."""
    whole, noise, _, tables = linear.problem((1, 1), truth={"effect_1_0": 3.0})
    gap = Parameter("gap", "m", 0.5, Normal(0.0, 1.0), 0.0)

    def predict(hypothesis, values, run):
        felt = max(-values.get("gap", 0.0) - 0.1, 0.0) * tables[run.name]["effect_1_0"]
        return (values["nominal_0"] * tables[run.name]["nominal_0"] + felt)[None]

    whole = type(whole)(whole.runs, predict, whole.nominal)
    null = fit(whole, tuple(noise[r.name] for r in whole.training), whole.nominal, np.zeros(1), whole.training)
    found = directions(whole, null, Hypothesis("stop", (("stop", "here"),), (gap,)))
    felt = np.linalg.norm(found.vectors, axis=1)
    assert sorted(gap.prior.value(latent[0]) for latent in found.tried) == pytest.approx([-1.0, -0.02])
    assert sorted(felt > 0) == [False, True]
    result = screen(null, [found])
    assert result.score[0] > 5 and gap.prior.value(result.start[0][0]) < -0.5


def test_an_empty_catalogue_names_nothing():
    assert len(screen(screened()[3], []).score) == 0


def test_a_candidate_that_cannot_be_computed_says_why():
    from pipeline.contract.errors import ConvergenceError

    whole, catalogue, _, null, _, _ = screened()

    def fail(hypothesis, values, run):
        raise ConvergenceError("model", "a solution", "none")

    broken = type(whole)(whole.runs, fail, whole.nominal)
    found = directions(broken, null, catalogue[0])
    assert found.failure == "model: expected a solution, found none" and len(found.vectors) == 0
    assert screen(null, [found]).score[0] == -np.inf


@pytest.mark.exact
def test_shapes_of_the_same_name_are_tried_as_another_candidate_has_them():
    speed = Parameter("wave@pad.speed", "m/s", 1.0, LogNormal(1.0, 0.5))
    wave = Hypothesis("wave", (), (Parameter("wave@pad.height", "m", 0.0, HalfNormal(1.0), 0.0), speed))
    here = np.array([0.3, 0.7])
    tried = [sides[0][1] for sides, _, _ in _trials(wave, shapes_like(wave, here, {"speed": 1.7, "height": 3.0}))]
    assert sorted(set(np.round(tried, 12))) == sorted(np.round([0.7, speed.prior.latent(1.7)], 12))
    assert {sides[0][1] for sides, _, _ in _trials(wave, shapes_like(wave, here, {"height": 3.0}))} == {0.7}


@pytest.mark.exact
def test_other_shapes_keep_the_size_and_what_is_of_one_run():
    own = Parameter("start", "m", 0.0, Normal(0.0, 1.0), run="a")
    wave = Hypothesis("wave", (), (Parameter("height", "m", 0.0, HalfNormal(1.0), 0.0),
                                   Parameter("speed", "m/s", 1.0, LogNormal(1.0, 0.5)), own))
    assert wave.shaping == [1]
    found = reshaped(wave, np.array([0.4, 0.1, 0.9]))
    np.testing.assert_allclose(found, [[0.4, -0.8416, 0.9], [0.4, 0.8416, 0.9]], atol=1e-4)
    assert reshaped(Hypothesis("drag", (), (wave.parameters[0],)), np.array([0.4])) == []


@pytest.mark.exact
def test_angles_are_tried_in_every_quarter():
    """No phase is farther than pi / 4 from one that is tried."""
    phase = Parameter("phase", "rad", 0.0, Uniform(-np.pi, np.pi))
    wave = Hypothesis("wave", (), (Parameter("height", "m", 0.0, HalfNormal(1.0), 0.0), phase))
    tried = np.array([phase.prior.value(sides[0][1]) for sides, _, _ in _trials(wave, None)])
    away = np.subtract.outer(np.linspace(-np.pi, np.pi, 50), tried)
    assert np.cos(away).max(axis=1).min() >= np.cos(np.pi / 4) - 1e-6


def test_of_discrete_values_the_one_that_errs_least_is_screened():
    whole, noise, _, tables = linear.problem((1, 1), truth={"effect_1_0": 9.0})
    factor = Parameter("factor", "1", 10.0, Factors((0.1, 10.0, 1e3), 0.01), 0.0)

    def predict(hypothesis, values, run):
        table = tables[run.name]
        return (values["nominal_0"] * table["nominal_0"] + values.get("factor", 0.0) * table["effect_1_0"])[None]

    whole = type(whole)(whole.runs, predict, whole.nominal)
    null = fit(whole, tuple(noise[r.name] for r in whole.training), whole.nominal, np.zeros(1), whole.training)
    shown = directions(whole, null, Hypothesis("scaled", (("scaled", "here"),), (factor,)))
    assert len(shown.vectors) == 1 and factor.prior.value(shown.tried[0][0]) == pytest.approx(10.0)
    assert screen(null, [shown]).p_value[0] < 1e-3


def test_the_directions_of_a_tone_hold_the_one_that_is_there():
    """Spread over the priors of frequency and phase, they miss it; one that stands out explains nearly all of it."""
    whole, null = null_of(TRUE)
    residual, known = np.concatenate(from_prior_mean(null)), np.concatenate(null.jacobians)

    def left(*vectors):
        return (left_by(np.column_stack((known, *vectors)), residual) ** 2).sum()

    def explained(found):
        return max(1 - left(vector) / left() for vector in found.vectors)

    assert explained(directions(whole, null, RIPPLE)) < 0.05
    assert explained(directions_with_tones(whole, null, RIPPLE)) > 0.95
    assert len(directions_with_tones(whole, null, DRAG).sign) == len(directions(whole, null, DRAG).sign)
