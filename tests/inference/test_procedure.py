"""A diagnosis end to end on a toy bench: right verdicts, no false names, pairs, one run, speed."""

from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from math import copysign, sin, tanh
from multiprocessing import get_context
from time import process_time
from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.contract.errors import ConvergenceError
from pipeline.inference import procedure
from pipeline.inference.decision import weighing
from pipeline.inference.diagnosis import Settings
from pipeline.inference.fitting.noise import budget
from pipeline.inference.priors import Normal, Parameter
from pipeline.inference.problem import Hypothesis
from pipeline.inference.procedure import Asked, diagnose
from pipeline.inference.rules import DEFAULTS
from pipeline.inference.search import score_screen
from pipeline.inference.search.selection import Selection, where_felt
from tests.inference import linear
from tests.inference.oscillator import CATALOGUE, alone, bench, changed


def cubic(t, x, v):
    return 1.5e4 * x**3


def coulomb(t, x, v):
    return 0.6 * tanh(v / 0.005)


def modulated(t, x, v):
    return 25.0 * sin(9.0 * t) * x


def gap(t, x, v):
    return 300.0 * max(0.0, abs(x) - 0.015) * copysign(1.0, x)


TRUTHS = [
    ({}, "consistent", ()),
    ({"stiffness": 460.0, "damping": 1.0}, "parameters", ()),
    ({"stiffness": 380.0, "extra": cubic}, "missing", ("cubic",)),
    ({"stiffness": 430.0, "damping": 1.0, "extra": coulomb}, "missing", ("coulomb",)),
    ({"stiffness": 430.0, "extra": None, "gain": 1.08}, "sensor", ("sensor_gain",)),
    ({"stiffness": 420.0, "extra": modulated}, "unknown", ()),
    ({"stiffness": 410.0, "extra": gap}, "unknown", ()),
]


@pytest.mark.parametrize("noise", [0.01, 0.1])
@pytest.mark.parametrize("truth, verdict, named", TRUTHS, ids=lambda v: v if isinstance(v, str) else "")
def test_the_verdict_is_right(truth, verdict, named, noise):
    problem = bench(5, noise, **truth)
    told = diagnose(problem, budget(problem), CATALOGUE)
    found = told.decision.verdict, tuple(c.name for c in told.decision.named)
    assert found == (verdict, named), told.decision.reasons
    if verdict == "parameters":
        assert abs(told.null.values["stiffness"] - 460.0) < 4 * told.null.spread()["stiffness"]
    if verdict == "missing":
        best, = told.named
        true = {"cubic": ("cubic_stiffness", 1.5e4), "coulomb": ("friction_force", 0.6)}[named[0]]
        assert abs(best.fit.values[true[0]] - true[1]) < 4 * best.fit.spread(told.weights)[true[0]]


def test_one_run_alone_ends_in_a_tie_at_most():
    problem = alone(bench(5, 0.1, stiffness=430.0, extra=coulomb))
    told = diagnose(problem, budget(problem), CATALOGUE)
    assert told.decision.verdict == "tie" and any("one run only" in why for why in told.decision.reasons)


def test_two_candidates_that_do_the_same_are_a_tie():
    whole, noise, catalogue, tables = linear.problem((2, 1, 1), runs=4, held_out=1, truth={"effect_1_0": 0.6})
    for table in tables.values():
        table["effect_2_0"] = table["effect_1_0"]
    told = diagnose(whole, noise, catalogue)
    assert told.decision.verdict == "tie" and {c.name for c in told.decision.named} == {"effect_1", "effect_2"}
    assert sum(w.statistics.posterior for w in told.named) == pytest.approx(1.0, abs=1e-6)


def test_processes_give_the_same_bits():
    problem = bench(5, 0.1, stiffness=430.0, extra=coulomb)
    here = diagnose(problem, budget(problem), CATALOGUE[:3])
    with ProcessPoolExecutor(2, get_context("spawn")) as pool:
        there = diagnose(problem, budget(problem), CATALOGUE[:3], fan_out=pool.map)
    assert here.decision == there.decision and np.array_equal(here.null.latent, there.null.latent)
    assert all(np.array_equal(a.fit.latent, b.fit.latent) for a, b in zip(here.weighed, there.weighed, strict=True))


def test_a_nominal_model_that_fails_is_told():
    problem = bench(5, 0.1)
    broken = replace(problem, predict=lambda h, v, r: np.full(r.samples.shape, np.nan))
    with pytest.raises(ConvergenceError, match="calibration of nominal"):
        diagnose(broken, budget(problem), CATALOGUE)


def test_a_candidate_that_fails_is_reported_and_not_judged():
    problem = bench(5, 0.1)
    blown_up = Parameter("cubic_stiffness", "N/m^3", -1e12, Normal(-1e12, 1.0), -1e12)
    far = Hypothesis("far", (("far", "mount"),), (blown_up,))
    told = diagnose(problem, budget(problem), (*CATALOGUE[:1], far), Settings(rules=changed("screening", p_value=1.0)))
    assert "far" in told.failures and [w.candidate.name for w in told.weighed] == ["cubic"]


def test_a_candidate_that_fails_of_a_fault_of_the_program_is_told_and_the_others_are_judged(monkeypatch):
    problem = bench(5, 0.1)

    def broken(hypothesis, values, run):
        if "coulomb" in hypothesis.name:
            raise ValueError("shapes (113,) and (110,)")
        return problem.predict(hypothesis, values, run)

    told = diagnose(replace(problem, predict=broken), budget(problem), CATALOGUE[:3],
                    Settings(rules=changed("screening", p_value=1.0)))
    failed, = [why for name, why in told.failures.items() if "coulomb" in name]
    assert "internal error ValueError: shapes (113,) and (110,) (" in failed and "please report it" in failed
    assert len(told.weighed) == 2
    numbers = weighing.candidate_statistics

    def singular(null, evidence, candidate, *rest):
        if candidate.name == "cubic":
            raise np.linalg.LinAlgError("Singular matrix")
        return numbers(null, evidence, candidate, *rest)

    monkeypatch.setattr(weighing, "candidate_statistics", singular)
    told = diagnose(problem, budget(problem), CATALOGUE[:2], Settings(rules=changed("screening", p_value=1.0)))
    assert "LinAlgError: Singular matrix" in told.failures["cubic"] and len(told.weighed) == 1


def test_no_control_of_forty_is_given_a_name():
    verdicts = []
    for seed in range(40):
        whole, noise, catalogue, _ = linear.problem((3, *(1,) * 12), runs=4, samples=300, seed=seed, held_out=1,
                                                    truth={"nominal_0": 1.5, "nominal_1": -0.7})
        verdicts.append(diagnose(whole, noise, catalogue, Settings(draws=4000)).decision.verdict)
    assert set(verdicts) == {"parameters"}


@pytest.mark.slow
@pytest.mark.parametrize("noise", [0.01, 0.1])
def test_no_control_of_the_toy_bench_is_given_a_name(noise):
    verdicts = []
    for seed in range(40):
        generator = np.random.default_rng(1000 + seed)
        problem = bench(seed, noise, stiffness=400 * np.exp(0.2 * generator.standard_normal()),
                        damping=1.2 * np.exp(0.3 * generator.standard_normal()))
        verdicts.append(diagnose(problem, budget(problem), CATALOGUE).decision.verdict)
    assert set(verdicts) <= {"parameters", "consistent"}


@pytest.mark.slow
@pytest.mark.study
def test_linearised_p_values_agree_with_full_refits_under_the_null():
    """The share of controls whose best refitted gain passes the bound of the linearised null is that of the bound."""
    every_score = changed("screening", p_value=1.0)
    passed, level = [], 0.2
    for seed in range(60):
        problem = bench(seed, 0.05, held_out=False)
        told = diagnose(problem, budget(problem), CATALOGUE, Settings(kept=7, rules=every_score))
        gains = [told.null.objective - w.fit.chi_square.sum() - w.fit.latent[:2] @ w.fit.latent[:2]
                 for w in told.weighed]
        score = np.sqrt(max(0.0, *gains))
        ordered = told.screen.score[told.screen.order()[0]]
        passed.append((score, ordered, told.screen.p_value.min() <= level))
    scores, linear_scores, small = (np.array(c) for c in zip(*passed, strict=True))
    assert np.median(np.abs(scores - linear_scores)) < 0.3
    assert abs(np.mean(small) - level) < 3 * np.sqrt(level * (1 - level) / 60)


@pytest.mark.parametrize("count", [7, pytest.param(25, marks=pytest.mark.slow)])
def test_twenty_five_hypotheses_take_less_than_twenty_seconds(count):
    """Those of the catalogue alone, as a sample of them, their share."""
    problem = bench(5, 0.1, stiffness=430.0, extra=coulomb)
    many = tuple(replace(c, name=f"{c.name}_{k}") for k in range(4) for c in CATALOGUE)[:count]
    start = process_time()
    diagnose(problem, budget(problem), many)
    assert process_time() - start < 20 * count / 25


def elaborated(*names):
    """The catalogue with the candidates of these names marked as elaborate."""
    return tuple(replace(c, elaborate=c.name in names) for c in CATALOGUE)


def test_elaborate_candidates_are_weighed_only_where_simpler_ones_leave_something(monkeypatch):
    """Beside a simple law that reaches the noise none is tried; where nothing does, all are weighed together."""
    screened = []
    look = score_screen.directions
    monkeypatch.setattr(score_screen, "directions", lambda problem, null, candidate, like=None: (
        screened.append(candidate.name), look(problem, null, candidate, like))[1])
    problem = bench(5, 0.1, stiffness=380.0, extra=cubic)
    simple = diagnose(problem, budget(problem), elaborated("coulomb", "quadratic"))
    assert [c.name for c in simple.decision.named] == ["cubic"] and "coulomb" not in screened
    found = diagnose(problem, budget(problem), elaborated("cubic"))
    assert found.decision.verdict == "missing" and [c.name for c in found.decision.named] == ["cubic"]
    assert {w.candidate.name for w in found.weighed} > {"cubic"} and screened.count("cubic") >= 1
    assert len(found.posterior) == 1 + len(CATALOGUE)


def test_elaborate_candidates_are_weighed_where_simple_ones_are_felt():
    def candidate(name, place):
        return Hypothesis(f"{name} at {place}", ((name, place),))

    simple = [candidate("spring", "left"), candidate("spring", "right"), candidate("damper", "right")]
    elaborate = [candidate("lugre", "left"), candidate("lugre", "right"), candidate("lugre", "above")]
    nothing = SimpleNamespace(results={}, calibration=SimpleNamespace(null=None))
    screen = SimpleNamespace(score=np.array([10.0, -np.inf, 1.0]))
    assert where_felt(elaborate, simple, screen, nothing) == (elaborate[0],)
    explaining = SimpleNamespace(fit=SimpleNamespace(betters=lambda null: 5.0))
    refitted = SimpleNamespace(results={1: explaining}, calibration=SimpleNamespace(null=None))
    assert where_felt(elaborate, simple, screen, refitted) == tuple(elaborate[:2])


@pytest.mark.parametrize("left, verdict, tried", [(3.0, "unknown", 3), (3.0, "missing", 1), (50.0, "unknown", 1)])
def test_pairs_follow_where_no_set_along_motions_is_named(monkeypatch, left, verdict, tried):
    """Motions that mislead have judged two of three; where pairs came first, they do not come again."""
    asked, seconds = Asked(None, {}, tuple(CATALOGUE[:3]), Settings(), map), []
    single = SimpleNamespace(decision=SimpleNamespace(verdict=verdict), base=None, weighed=(), null=None,
                             combinations=(), further=None,
                             named=[SimpleNamespace(fit=None)] * (verdict == "missing"))
    selection = Selection((), (), (), np.zeros(0), {}, frozenset({0, 1}), left)
    monkeypatch.setattr(procedure.several, "along_motions", lambda *_: SimpleNamespace(selected=lambda *_: selection))
    monkeypatch.setattr(Asked, "together", lambda self, single, selection: single)
    monkeypatch.setattr(procedure.pairs, "beside",
                        lambda asked, single, catalogue: (seconds.append(len(catalogue)), single)[1])
    asked.along(single, object())
    assert seconds == [3] * (left > DEFAULTS.decision.along_motions) + [tried]


@pytest.mark.parametrize("told, again", [("unknown", 0), ("tie", 1)])
def test_fewer_seconds_are_not_tried_again_unless_all_of_them_tied(monkeypatch, told, again):
    problem = bench(5, 0.1, stiffness=380.0, extra=cubic)
    found = diagnose(problem, budget(problem), CATALOGUE[:3])
    asked, seconds = Asked(None, {}, tuple(CATALOGUE[:3]), Settings(), map), []
    further = replace(found, decision=replace(found.decision, verdict=told))
    selection = Selection((), (), (), np.zeros(0), {}, frozenset({0, 1}), 50.0)
    monkeypatch.setattr(procedure.several, "along_motions", lambda *_: SimpleNamespace(selected=lambda *_: selection))
    monkeypatch.setattr(procedure, "reaches_noise", lambda *_: False)
    monkeypatch.setattr(procedure.second_effect, "has_room", lambda *_: True)
    monkeypatch.setattr(Asked, "together", lambda self, single, selection: single)
    monkeypatch.setattr(procedure.pairs, "beside", lambda asked, single, catalogue: (
        seconds.append(len(catalogue)), replace(single, further=further))[1])
    assert asked.along(found, object()).further is further and seconds == [3] + [1] * again
