"""When a second effect matters beside a first one."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.inference.decision import second_effect
from pipeline.inference.diagnosis import Settings
from pipeline.inference.procedure import diagnose
from pipeline.inference.rules import DEFAULTS
from tests.inference import linear


@pytest.fixture(scope="module")
def solved():
    """(Diagnosis of one hidden effect of two, its catalogue)."""
    whole, noise, catalogue, _ = linear.problem((2, 1, 1), runs=4, held_out=1, truth={"effect_1_0": 0.6})
    return diagnose(whole, noise, catalogue, Settings(draws=2000)), catalogue


def test_the_named_effect_leads(solved):
    single, _ = solved
    assert [w.candidate.name for w in second_effect.leading(single, DEFAULTS)] == ["effect_1"]


def test_a_fit_at_the_noise_leaves_room_only_for_what_the_noise_may_hide(solved):
    first = solved[0].named[0].fit
    assert second_effect.has_room(first, 1e-3 * first.counts.sum(), DEFAULTS)
    assert not second_effect.has_room(first, 1e6 * first.counts.sum(), DEFAULTS)


@pytest.mark.parametrize("explained, matters", [(1.0, True), (1e9, False)])
def test_a_second_effect_must_explain_a_fraction_of_what_the_first_does(solved, explained, matters):
    assert second_effect.matters(solved[0], explained, DEFAULTS) is matters
    tie = replace(solved[0], decision=replace(solved[0].decision, verdict="tie"))
    assert not second_effect.matters(tie, explained, DEFAULTS), "only what is named matters"


@pytest.mark.parametrize("place, share, matters", [("there", 1e-3, True), ("here", 1e-3, False), ("here", 5e-3, True)])
def test_at_the_place_of_the_first_a_faint_one_may_be_an_error_of_its_law(solved, place, share, matters):
    pair, (second,) = solved[0], solved[0].named
    known = replace(pair.null.hypothesis, effects=(("first", place),))
    null = replace(pair.null, hypothesis=known)
    beside = replace(pair, calibration=replace(pair.calibration, null=null))
    assert second.candidate.effects == (("effect_1", "here"),)
    assert second_effect.matters(beside, second.fit.betters(null) / share, DEFAULTS) is matters


def at_objective(fit, objective):
    """A Fit whose latent values stay, and whose residuals are as large as they have to be."""
    size = np.sqrt((objective - fit.latent @ fit.latent) / fit.counts.sum())
    return replace(fit, residuals=tuple(np.full(n, size) for n in fit.counts))


@pytest.mark.parametrize("place", ["here", "there"])
@pytest.mark.parametrize("left", [1.02, 1.5, 40.0])
def test_no_second_effect_above_the_bound_matters(solved, place, left):
    """``left`` by the first in noise powers; the second takes more and more off."""
    pair, (second,) = solved[0], solved[0].named
    counts = pair.null.counts.sum()
    known = replace(pair.null.hypothesis, effects=(("first", place),))
    null = at_objective(replace(pair.null, hypothesis=known), left * counts)
    beside = replace(pair, calibration=replace(pair.calibration, null=null))
    first = SimpleNamespace(candidate=known, fit=null)
    bound = second_effect.bound(first, at_objective(null, 500 * counts), [second.candidate], DEFAULTS)
    mattered = []
    for objective in np.linspace(0.3 * counts, null.objective, 60):
        fit = at_objective(second.fit, objective)
        told = replace(beside, weighing=replace(beside.weighing, weighed=(replace(second, fit=fit),)))
        if second_effect.matters(told, (500 - left) * counts, DEFAULTS):
            mattered.append(objective)
    assert bound <= null.objective and all(objective <= bound for objective in mattered)
    assert mattered or left < 40


@pytest.mark.parametrize("place, away, share, of_another_form", [
    ("here", 0.4, 5e-3, True), ("here", 3.0, 5e-3, False), ("here", 0.4, 1e-3, False), ("there", 0.4, 5e-3, False)])
def test_a_first_law_that_values_of_nothing_mend_at_its_place_is_of_another_form(solved, place, away, share,
                                                                                  of_another_form):
    pair, (second,) = solved[0], solved[0].named
    null = replace(pair.null, hypothesis=replace(pair.null.hypothesis, effects=(("first", place),)))
    mending = replace(second, statistics=replace(second.statistics, from_null=away))
    beside = replace(pair, calibration=replace(pair.calibration, null=null),
                     weighing=replace(pair.weighing, weighed=(mending,)))
    why = second_effect.mends(beside, second.fit.betters(null) / share, DEFAULTS)
    assert bool(why) is of_another_form and why.endswith("another form" if why else "")


@pytest.mark.parametrize("single_says, pair_says, kind, left, found", [
    ("unknown", "unknown", "physics", 0.03, True), ("missing", "unknown", "physics", 0.03, False),
    ("unknown", "tie", "physics", 0.03, False), ("unknown", "unknown", "sensor", 0.03, False),
    ("unknown", "unknown", "physics", 0.9, False)])
def test_what_leads_beside_a_first_law_unnamed_may_be_named_with_it(solved, single_says, pair_says, kind, left, found):
    told, (second,) = solved[0], solved[0].named
    single, pair = (replace(told, decision=replace(told.decision, verdict=verdict))
                    for verdict in (single_says, pair_says))
    counts = second.fit.counts
    excess = (single.null.chi_square.sum() - counts.sum()) * left + counts.sum() * (
        1 + DEFAULTS.decision.noise_uncertainty)
    fit = replace(second.fit, residuals=tuple(np.full(n, np.sqrt(excess / counts.sum())) for n in counts))
    led = replace(second, fit=fit, candidate=replace(second.candidate, kind=kind))
    pair = replace(pair, weighing=replace(pair.weighing, weighed=(led,)))
    assert (second_effect.unnamed(single, pair, DEFAULTS) is led) is found


def test_the_second_begins_without_the_first(solved):
    single, catalogue = solved
    first = next(c for c in catalogue if c.name == "effect_1")
    second = next(c for c in catalogue if c.name != "effect_1")
    nominal = len(single.null.latent)
    latent = np.arange(1.0, nominal + 1 + len(first.parameters) + len(second.parameters))
    pair = SimpleNamespace(named=(SimpleNamespace(candidate=second, fit=SimpleNamespace(latent=latent)),))
    known = SimpleNamespace(fit=SimpleNamespace(latent=latent[:nominal + len(first.parameters)]))
    (index, start), = second_effect.starts_without(known, pair, single).items()
    assert single.refits.refitter.catalogue[index].name == second.name
    assert start.tolist() == [*latent[:nominal], *latent[nominal + len(first.parameters):]]


@pytest.mark.parametrize("away, remains", [(1.9, False), (2.1, True)])
def test_the_first_remains_where_its_size_is_far_from_none(solved, away, remains):
    _, catalogue = solved
    first = next(c for c in catalogue if c.name == "effect_1")
    size = first.parameters[first.sizes[0]]
    whole = solved[0].completed
    moved = replace(whole, latent=np.where([p.name == size.name for p in whole.hypothesis.parameters], [
        p.prior.latent(size.null + away * whole.spread()[size.name]) for p in whole.hypothesis.parameters],
        whole.latent))
    pair = SimpleNamespace(completed=moved, weights=None)
    assert second_effect.remains(SimpleNamespace(candidate=first), pair, DEFAULTS) is remains


def test_a_name_of_less_evidence_alone_does_not_take_the_place_of_the_pair(solved):
    single, _ = solved
    assert not second_effect.better_alone(single, single)
    other = replace(single, decision=replace(single.decision, verdict="unknown", named=()))
    assert not second_effect.better_alone(other, single)


@pytest.mark.parametrize("place, powered, odd, said", [
    ("here", False, False, "another form of coulomb at here, which alone predicts take_4 to the noise"),
    ("here", True, False, ""), ("there", False, False, ""), ("here", False, True, "")])
def test_a_second_law_at_the_place_of_the_first_needs_runs_that_tell(place, powered, odd, said):
    """On the runs that were fitted cubic stiffness and hysteresis together once stood for a quintic spring."""
    def fit(*excluded):
        return SimpleNamespace(excluded=lambda beyond: excluded)

    first = SimpleNamespace(candidate=SimpleNamespace(name="coulomb at here", places={"here"}))
    second = SimpleNamespace(candidate=SimpleNamespace(name="backlash", places={place}), fit=fit(),
                             statistics=SimpleNamespace(powered=powered))
    pair = SimpleNamespace(named=(second,), null=fit(*["mass"] * odd), weighing=SimpleNamespace(
        runs=SimpleNamespace(powerless=("take_4",))))
    assert said in second_effect.unconfirmed(first, pair, DEFAULTS)
    assert bool(said) == bool(second_effect.unconfirmed(first, pair, DEFAULTS))
