"""Best subsets against evidences computed one by one, laws that explain only together, and what is paid for."""

from dataclasses import replace
from itertools import combinations
from math import comb, log

import numpy as np
import pytest

from pipeline.inference.fitting.fit_state import linearised
from pipeline.inference.search.score_screen import directions
from pipeline.inference.search.subset_selection import best_subsets, multiplicity, table
from tests.inference import linear

TRUTH = {"effect_1_0": 0.5, "effect_3_0": -0.4, "effect_4_0": 0.3}


def at_null(truth, seed=0):
    """(Fit of the nominal model, Directions of six effects, Problem, catalogue, tables)."""
    whole, noise, catalogue, tables = linear.problem((2, *(1,) * 6), samples=200, truth=truth, seed=seed)
    noises = [noise[run.name] for run in whole.training]
    null = linearised(whole, noises, whole.nominal, np.zeros(2), whole.training)
    return null, [directions(whole, null, c) for c in catalogue], whole, catalogue, tables


def exact(whole, catalogue, tables, members):
    """ln Z of effects beside the nominal parameters, from the covariance of the samples.

    Across the span of the design, on whose axes the rest is taken, samples are uncorrelated and of unit variance.
    """
    hypothesis = whole.nominal
    for i in members:
        hypothesis = hypothesis.joined(catalogue[i])
    samples, design = linear.dense(whole, hypothesis, tables)
    axes, shares = np.linalg.qr(design)
    along = axes.T @ samples
    covariance = np.eye(len(along)) + shares @ shares.T
    across = samples @ samples - along @ along
    return -0.5 * (across + along @ np.linalg.solve(covariance, along) + np.linalg.slogdet(covariance)[1])


def test_gains_are_ratios_of_evidence_less_the_number_of_sets():
    null, every, *dense = at_null({})
    of = table(null, every)
    of = replace(of, gram=of.gram / of.weights.mean(), score=of.score / of.weights.mean())
    assert of.weights == pytest.approx(np.full(3, of.weights.mean()), rel=0.02), "white residuals count all but in full"
    for members in ((0,), (1, 4), (0, 2, 5), (1, 2, 3, 4)):
        rows = [[int(np.flatnonzero(of.owner == i)[0]) for i in members]]
        expected = exact(*dense, members) - exact(*dense, ()) - log(comb(6, len(members)))
        assert of.gain(rows)[0][0] == pytest.approx(expected, rel=0.02, abs=0.2)
    assert multiplicity(12, 4) == pytest.approx(log(495))


def test_the_three_that_are_there_are_the_best_set():
    null, every, *dense = at_null(TRUTH)
    best = best_subsets(table(null, every))
    assert best[0].owners == (0, 2, 3) and best[0].coefficients == pytest.approx((0.5, -0.4, 0.3), abs=0.06)
    sets = [s for size in range(1, 5) for s in combinations(range(6), size)]
    assert max(sets, key=lambda s: exact(*dense, s) - log(comb(6, len(s)))) == (0, 2, 3)


def test_no_two_of_one_family_are_in_a_set():
    """Of three that are there two are one law and its limit, or share a limit: one of them is left out."""
    null, every, *_ = at_null(TRUTH)
    for extends in ({2: ("effect_1",)}, {0: ("coulomb",), 2: ("coulomb",)}):
        related = [replace(d, candidate=replace(d.candidate, extends=extends.get(i, ()))) for i, d in enumerate(every)]
        found = best_subsets(table(null, related))
        assert len(found[0].owners) >= 2 and all(not {0, 2} <= set(subset.owners) for subset in found)


def test_laws_that_explain_only_together_are_a_set():
    """Two directions that all but cancel: each alone explains nothing of their difference."""
    null, every, *_ = at_null({})
    random = np.random.default_rng(0)
    base, small = random.standard_normal((2, sum(null.counts)))
    first, second = base + 0.05 * small, -base + 0.05 * small
    residual = 3 * (first + second)
    parts = np.split(residual, np.cumsum(null.counts)[:-1])
    null = type(null)(**{**{k: getattr(null, k) for k in null.__dataclass_fields__}, "residuals": tuple(
        r + p for r, p in zip(null.residuals, parts, strict=True))})
    every[0] = type(every[0])(every[0].candidate, 20 * first[None], np.zeros(1, int), every[0].tried[:1])
    every[1] = type(every[1])(every[1].candidate, 20 * second[None], np.zeros(1, int), every[1].tried[:1])
    best = best_subsets(table(null, every))
    alone = {s.owners: s.gain for s in best if len(s.owners) == 1}
    assert best[0].owners == (0, 1) and all(gain < 0.1 * best[0].gain for gain in alone.values())


def test_coefficients_of_one_sign_keep_it():
    null, every, *_ = at_null(TRUTH)
    signed = [type(d)(d.candidate, d.vectors, np.ones(len(d.sign), int), d.tried) for d in every]
    assert 2 not in best_subsets(table(null, signed))[0].owners


def test_nothing_is_worth_a_name_where_nothing_is_missing():
    for seed in range(10):
        null, every, *_ = at_null({}, seed)
        assert all(s.gain < 3.0 for s in best_subsets(table(null, every)))
