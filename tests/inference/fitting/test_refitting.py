"""Refits of candidates: all begin where the nominal model misses the noise, rivals begin at the best one's values."""

from dataclasses import replace
from math import sin

import numpy as np
import pytest

from pipeline.inference import procedure
from pipeline.inference.diagnosis import Settings
from pipeline.inference.fitting import begins, refitting
from pipeline.inference.fitting.calibration import calibrate
from pipeline.inference.fitting.fit_state import linearised
from pipeline.inference.fitting.noise import budget
from pipeline.inference.fitting.refitted import NOT_BEGUN, Refitted
from pipeline.inference.fitting.refitting import Refitter
from pipeline.inference.procedure import diagnose
from pipeline.inference.rules import DEFAULTS
from tests.inference import resonance
from tests.inference.oscillator import CATALOGUE, bench

CUBIC = [c.name for c in CATALOGUE].index("cubic")


def cubic(t, x, v):
    return 1.5e4 * x**3


def odd(t, x, v):
    return 25.0 * sin(9.0 * t) * x


@pytest.fixture(scope="module")
def found():
    problem = bench(5, 0.01, stiffness=380.0, extra=cubic)
    noises = tuple(budget(problem)[run.name] for run in problem.training)
    null = calibrate(problem, noises, problem.nominal, [problem.nominal.nominal], problem.training, settled=False)
    return Refitter(problem, null, CATALOGUE, Settings(kept=2), map)


def begun(monkeypatch, name="begun_beside"):
    """Names of candidates that begin, in order."""
    seen, begun = [], getattr(refitting, name)
    monkeypatch.setattr(refitting, name, lambda *given, **more: seen.append(given[-1][0].name) or begun(*given, **more))
    return seen


@pytest.mark.parametrize("extra, all_begin", [(cubic, False), (odd, True)])
def test_above_the_noise_all_begin_unless_one_of_the_first_explains_enough(monkeypatch, extra, all_begin):
    problem, seen = bench(5, 0.01, stiffness=380.0, extra=extra), begun(monkeypatch)
    diagnose(problem, budget(problem), CATALOGUE, Settings(kept=3))
    first = list(dict.fromkeys(seen))
    assert len(first) == len(CATALOGUE) if all_begin else first.count("cubic") == 1 and len(first) <= 6


def test_only_the_best_few_go_on(found):
    starts = [np.zeros(len(c.parameters)) for c in CATALOGUE]
    told = found.of(range(len(CATALOGUE)), starts)
    assert sum(r.fit is not None for r in told.values()) == 2 and told[CUBIC].fit.converged
    uncertainty = DEFAULTS.decision.noise_uncertainty
    assert told[CUBIC].fit.reaches_noise(uncertainty)
    assert not found.null.reaches_noise(uncertainty) and found.anchor is found.null


def test_a_rival_is_found_from_the_nominal_values_of_the_best(found):
    """Of two equal laws one was left where it began: it comes down to the other."""
    twin = type(found)(found.problem, found.null, (CATALOGUE[CUBIC], CATALOGUE[CUBIC]), found.settings, map)
    best = found.of([CUBIC], {CUBIC: np.zeros(1)})[CUBIC]
    told = twin.with_imitators({0: best}, [np.zeros(1)] * 2)
    assert [told[k].fit.objective for k in (0, 1)] == pytest.approx([best.fit.objective] * 2, rel=1e-4)


@pytest.mark.exact
def test_what_is_one_change_at_other_nominal_values_is_led_over():
    """Of an oscillator of unknown mass and damping a smaller gain is a stiffer spring: (m, c, k) times its inverse."""
    problem = resonance.problem(gain=0.69)
    noises = tuple(budget(problem)[run.name] for run in problem.training)
    null = calibrate(problem, noises, problem.nominal, [problem.nominal.nominal], problem.training, settled=False)
    seeking = Refitter(problem, null, resonance.CATALOGUE, Settings(), map)
    best = seeking.of([0], {0: np.zeros(1)})
    assert 1 in seeking.with_imitators(best, [np.zeros(1)] * 2)
    for begun_before in ({**best, 1: NOT_BEGUN}, best):     # without, where the race was given up
        told = seeking._led_over(0, [np.zeros(1)] * 2, [1], begun_before)[1].fit
        assert told.converged and told.chi_square.sum() < 1.1 * told.counts.sum()
        assert told.values["added_stiffness"] / resonance.STIFFNESS == pytest.approx(1 / 0.69 - 1, rel=0.02)
        assert told.values["mass"] == pytest.approx(1 / 0.69, rel=0.02)


def test_all_begins_anew_where_the_null_was_at_a_wrong_optimum(monkeypatch):
    """A recalibration that ended far off, of a rig that lacks nothing: a candidate's optimum leads to the right one."""
    problem, begin, seen = bench(5, 0.01, stiffness=380.0), procedure.recalibrate, []

    def stopped_early(problem, *rest):
        right = begin(problem, *rest)
        wrong = linearised(problem, right.null.noises, problem.nominal, right.null.latent + 2.0, problem.training)
        return replace(right, null=wrong)

    monkeypatch.setattr(procedure, "recalibrate", stopped_early)
    screened = procedure.screen_catalogue
    monkeypatch.setattr(procedure, "screen_catalogue", lambda *given: seen.append(given[0].null) or screened(*given))
    told = diagnose(problem, budget(problem), CATALOGUE)
    assert told.decision.verdict == "parameters" and not told.decision.named
    assert len(seen) == 2 and seen[1].objective < 0.1 * seen[0].objective


def test_where_nothing_explains_more_than_chance_nothing_is_looked_for(monkeypatch):
    problem = bench(5, 0.1)
    seen = begun(monkeypatch, "begun_at")
    diagnose(problem, budget(problem), CATALOGUE)
    assert not seen


def test_what_is_better_is_kept(found):
    """A rival that ends above what was found before does not take its place."""
    best = found.of([CUBIC], {CUBIC: np.zeros(1)})[CUBIC]
    told = found.with_imitators({CUBIC: best}, [np.zeros(len(c.parameters)) for c in CATALOGUE])
    assert told[CUBIC] is best
    assert all(r.fit is None or r.fit.objective >= best.fit.objective - 1e-6 for r in told.values())


def test_a_leading_fit_that_did_not_converge_begins_again(found):
    starts = {CUBIC: np.zeros(1)}
    first, _ = begins.begun_beside(found.problem, found.null, found.null, (), (), (CATALOGUE[CUBIC], starts[CUBIC]))
    told = found.settled({CUBIC: Refitted(replace(first, converged=False), None, "it stopped")})[CUBIC]
    assert told.fit.converged and not told.failure and told.fit.objective <= first.objective


def test_a_leading_fit_that_ended_above_the_noise_goes_on(found):
    """A little off its optimum, and called converged as residuals that are far from noise count for little."""
    best = found.of([CUBIC], {CUBIC: np.zeros(1)})[CUBIC].fit
    off = np.concatenate((best.latent[:-1], [best.latent[-1] + 0.02]))
    early = replace(linearised(found.problem, best.noises, best.hypothesis, off, best.runs), converged=True)
    assert not early.reaches_noise(DEFAULTS.decision.noise_uncertainty)
    told = found.settled({CUBIC: Refitted(early, None, "")})[CUBIC].fit
    assert told.strict and told.converged and told.objective == pytest.approx(best.objective, rel=1e-4)


def test_step_errors_of_leading_candidates_alone_are_looked_for(found, monkeypatch):
    looked, look = [], refitting.refined
    monkeypatch.setattr(refitting, "refined", lambda *given: looked.append(given[-1]) or look(*given))
    told = found.settled(found.of(range(len(CATALOGUE)), [np.zeros(1)] * len(CATALOGUE)))
    assert [fit.hypothesis.name for fit in looked] == ["cubic"] and told[CUBIC].fit.step_error == 0.0


def test_the_better_half_goes_on_until_few_are_left(found, monkeypatch):
    lapped, advanced = [], refitting.advanced
    monkeypatch.setattr(refitting, "advanced",
                        lambda *given: lapped.append(given[-1].hypothesis.name) or advanced(*given))
    first = [begins.begun_beside(found.problem, found.null, found.null, (), (), (c, np.zeros(len(c.parameters))))[0]
             for c in CATALOGUE]
    fits = {i: fit for i, fit in enumerate(first) if fit is not None and i != CUBIC}
    left = found._raced(fits)
    assert len(left) == found.settings.kept < len(lapped) < 2 * len(fits)
    assert min(fits, key=lambda i: fits[i].objective) in left
    lapped.clear()
    assert CUBIC in found._raced(fits | {CUBIC: found.of([CUBIC], {CUBIC: np.zeros(1)})[CUBIC].fit})
    assert not lapped, "where one is at the noise no other needs to go on"


def test_where_the_null_is_at_odds_with_its_priors_candidates_begin_with_those_values_as_they_were(found):
    pulled = np.array(found.null.latent)
    pulled[0] = DEFAULTS.calibration.excluded + 1
    away = linearised(found.problem, found.null.noises, found.problem.nominal, pulled, found.null.runs)
    anchor = replace(found, null=away).anchor
    assert anchor.latent[0] == pytest.approx(found.problem.nominal.nominal[0])
    assert found.anchor is found.null


def test_beside_a_null_at_the_noise_by_unlikely_values_candidates_begin_at_those_given_and_go_on(found):
    """Other values than were given can take over what an effect does, to the noise; from there its valley is bent."""
    latent = np.array(found.null.latent)
    latent[0] = 4.5
    quiet = tuple(np.zeros(len(r)) for r in found.null.residuals)
    unlikely = replace(found, null=replace(found.null, latent=latent, residuals=quiet))
    likely = replace(found, null=replace(found.null, latent=0 * latent, residuals=quiet))
    assert unlikely.anchor.latent[0] == pytest.approx(found.problem.nominal.nominal[0])
    assert likely.anchor is likely.null
    assert unlikely._near(likely.null) == unlikely.null.objective > likely._near(likely.null)
