"""When each of several laws is needed beside the others."""

from dataclasses import replace
from types import SimpleNamespace

import pytest

from pipeline.inference.decision import several_laws
from pipeline.inference.diagnosis import Settings
from pipeline.inference.fitting.least_squares import fit
from pipeline.inference.rules import DEFAULTS
from pipeline.inference.search.selection import Combination
from tests.inference import linear


def fits(truth):
    """(Problem, {run: Noise}, catalogue, Fits of the nominal model, with effect_1, and with both effects)."""
    whole, noise, catalogue, _ = linear.problem((2, 1, 1), runs=4, held_out=1, truth=truth)
    noises, made, hypothesis = [noise[run.name] for run in whole.training], [], whole.nominal
    for candidate in (None, *catalogue):
        hypothesis = hypothesis.joined(candidate) if candidate else hypothesis
        made.append(fit(whole, noises, hypothesis, hypothesis.nominal, whole.training))
    return whole, noise, catalogue, made


def test_both_are_needed_where_both_are_there():
    whole, noise, both, fitted = fits({"effect_1_0": 1.0, "effect_2_0": 0.8})
    assert several_laws.unneeded(whole, noise, *fitted, both, DEFAULTS.decision) == ()


@pytest.mark.parametrize("there, idle", [(1, 2), (2, 1)])
def test_the_one_that_is_not_there_is_told_whatever_their_order(there, idle):
    whole, noise, both, fitted = fits({f"effect_{there}_0": 1.0})
    reasons = several_laws.unneeded(whole, noise, *fitted, both, DEFAULTS.decision)
    assert reasons and all(f"effect_{idle}" in why for why in reasons)


def test_a_share_that_an_error_of_the_others_may_be_is_not_enough():
    whole, noise, both, fitted = fits({"effect_1_0": 1.0, "effect_2_0": 0.8})
    rules = replace(DEFAULTS.decision, second_share=0.9)
    reasons = several_laws.unneeded(whole, noise, *fitted, both, rules)
    assert reasons and "an error of the others" in reasons[0]


def test_values_may_vary_by_the_errors_of_all_laws():
    rules = several_laws.allowing(Settings(), 3).rules.decision
    assert rules.varies_by == pytest.approx(3 * DEFAULTS.decision.law_error)
    assert rules.varies_too_much == rules.varies_by, "what holds only in part is not named with others"
    assert rules.law_error == pytest.approx(3 * DEFAULTS.decision.law_error)
    alone, beside = (several_laws.allowing(Settings(), 1, second).rules.decision for second in (False, True))
    assert alone == DEFAULTS.decision and beside.varies_too_much == alone.varies_by < alone.varies_too_much


def test_a_fit_that_may_still_leave_little_enough_is_not_given_up():
    whole, noise, both, (null, one, two) = fits({"effect_1_0": 3.0, "effect_2_0": 2.0})
    rules, left = DEFAULTS, [several_laws.left_by(whole, noise, null, each, DEFAULTS)[0] for each in (one, two)]
    assert left[0] > rules.decision.unexplained > left[1]
    assert two.objective < several_laws.hoped(null, rules) < one.objective


def test_laws_lead_together_where_they_leave_little_and_half_of_what_one_law_leaves():
    def tried(left, held_out=None, **more):
        return Combination(("a", "b"), 1.0, 100.0, held_out, "too much", left, **more)

    unknown = SimpleNamespace(verdict="unknown", leading=None)
    leads = SimpleNamespace(verdict="unknown", leading=SimpleNamespace(takes=0.8))
    every = (Combination(("a", "c"), 3.0), tried(0.3), tried(0.09, 6.5), tried(0.11, 3.1))
    assert several_laws.leading(every, unknown, DEFAULTS) == 3, "what predicts runs that were not fitted best"
    assert several_laws.leading(every, leads, DEFAULTS) == 2
    assert several_laws.leading(every[:2], unknown, DEFAULTS) is None
    assert several_laws.leading(every, unknown, DEFAULTS, alone=0.1) is None, "one law leaves nearly as little"
    doubted = (tried(0.09, 3.0, held_out_left=0.6), tried(0.09, 3.0, excluded=True))
    assert several_laws.leading(doubted, unknown, DEFAULTS) is None
    assert several_laws.leading(every, SimpleNamespace(verdict="missing", leading=None), DEFAULTS) is None
