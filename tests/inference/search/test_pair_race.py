"""The race of pairs: two laws are found that neither alone explains, nothing where no two simple laws do."""

from dataclasses import replace
from math import sin, tanh
from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.inference.diagnosis import Settings
from pipeline.inference.fitting.noise import budget
from pipeline.inference.problem import Hypothesis
from pipeline.inference.procedure import Asked
from pipeline.inference.rules import DEFAULTS
from pipeline.inference.search import pair_race
from pipeline.inference.search.pair_race import firsts, race
from tests.inference.oscillator import CATALOGUE, bench


def raced(extra, noise=0.1, catalogue=CATALOGUE):
    """(Diagnosis by one law, Pair) of the toy bench with an ``extra`` force."""
    problem, settings = bench(5, noise, stiffness=380.0, extra=extra), Settings()
    noises = budget(problem)
    _, single = Asked(problem, noises, catalogue, settings, map).steps()
    return single, next(race(problem, noises, single, catalogue, settings, map), None)


def test_two_laws_neither_of_which_explains_enough_win_and_begin_near_their_values():
    single, pair = raced(lambda t, x, v: 1.5e4 * x**3 + 1.5 * tanh(v / 0.005))
    assert single.decision.verdict == "unknown" and pair.names == ("cubic", "coulomb")
    assert pair.fit.objective < 1.1 * pair.fit.counts.sum()
    selection = pair.selected(single.null, CATALOGUE)
    assert list(selection.members) == [[c.name for c in CATALOGUE].index(name) for name in pair.names]
    assert not selection.judged
    np.testing.assert_array_equal(selection.start(selection.members), pair.fit.latent)
    assert pair.fit.values["cubic_stiffness"] == pytest.approx(1.5e4, rel=0.1)


def test_no_pair_wins_where_no_two_laws_explain_enough():
    single, pair = raced(lambda t, x, v: 25.0 * sin(9.0 * t) * x)
    assert single.decision.verdict == "unknown" and pair is None


def test_only_simple_laws_of_physics_run(monkeypatch):
    asked = []
    monkeypatch.setattr(pair_race, "firsts", lambda *_: ["first"])
    monkeypatch.setattr(pair_race, "_beside", lambda problem, budget, null, laws, *_: asked.extend(laws) or [])
    fit = SimpleNamespace(counts=np.array([100]), chi_square=np.array([300.0]))
    catalogue = tuple(replace(c, elaborate=c.name == "coulomb") for c in CATALOGUE)
    assert not list(race(None, None, SimpleNamespace(null=fit, named=()), catalogue, Settings(), map))
    assert {c.name for c in CATALOGUE} - {c.name for c in asked} == {"coulomb", "sensor_gain"}


@pytest.mark.parametrize("left, wins", [(102.0, False), (101.0, True)])
def test_beside_laws_that_tie_a_pair_has_to_explain_more_than_one_of_them(monkeypatch, left, wins):
    """Of 1000 above the noise the tied law leaves 110; a second one has to take a hundredth of 890 off."""
    fit, pair = (SimpleNamespace(objective=o, reaches_noise=lambda _: False, counts=np.array([20]),
                                 latent=np.ones(2)) for o in (110.0, left))
    bounds = []
    monkeypatch.setattr(pair_race, "firsts", lambda *_: ["first"])
    monkeypatch.setattr(pair_race, "_beside", lambda *given: bounds.append(given[-1]) or [
        pair_race.Pair(*CATALOGUE[:2], pair)])
    monkeypatch.setattr(pair_race, "advanced", lambda problem, enough, fit, iterations: fit)
    fit.betters = lambda null: null.objective - fit.objective
    null = SimpleNamespace(counts=np.array([60]), chi_square=np.array([1060.0]), objective=1000.0)
    tie = SimpleNamespace(null=null, named=(SimpleNamespace(fit=fit),))
    assert bool(list(race(None, None, tie, CATALOGUE, Settings(), map))) is wins
    assert bounds == [pytest.approx(110.0 - 0.01 * 890)], "the noise is at 21, and priors"


def weighed(name, gain, law="", **more):
    return SimpleNamespace(candidate=Hypothesis(name, ((law or name, "mount"),), **more),
                           fit=SimpleNamespace(betters=lambda null: gain),
                           statistics=SimpleNamespace(significant=lambda rules: gain > 1))


def test_first_come_simple_laws_and_limits_that_explain_about_as_much():
    single = SimpleNamespace(null=None, weighed=[
        weighed("lugre", 120.0, elaborate=True, extends=("dahl",)), weighed("dahl", 100.0, extends=("coulomb",)),
        weighed("gain", 95.0, kind="sensor"), weighed("coulomb", 90.0), weighed("jenkins", 200.0, extends=("coulomb",)),
        weighed("cubic", 80.0), weighed("gap", 40.0), weighed("air", 0.5)])
    assert [w.candidate.name for w in firsts(single, DEFAULTS)] == ["jenkins", "coulomb", "cubic"]
    assert firsts(SimpleNamespace(null=None, weighed=[]), DEFAULTS) == []


def test_each_law_comes_at_its_best_place_before_any_at_another():
    single = SimpleNamespace(null=None, weighed=[
        weighed("gap at wall", 100.0, "gap"), weighed("gap at arm", 90.0, "gap"), weighed("gap at foot", 80.0, "gap"),
        weighed("air", 70.0), weighed("cubic at foot", 60.0, "cubic"), weighed("cubic at arm", 50.0, "cubic")])
    assert [w.candidate.name for w in firsts(single, DEFAULTS)] == ["gap at wall", "air", "cubic at foot", "gap at arm"]
