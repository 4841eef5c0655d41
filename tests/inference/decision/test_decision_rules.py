"""The rules of the decision, one by one."""

from dataclasses import replace

import pytest

from pipeline.inference.decision.decision_rules import (
    VERDICTS,
    CandidateStatistics,
    RunStatistics,
    decide,
    objections,
)
from pipeline.inference.rules import DecisionRules

GOOD = CandidateStatistics("friction", "physics", 0.99, 40.0, 1e-4, 30.0, 15.0, 12.0, 0.8, 0.02, 1.2, True, 0.3, 20.0,
                           0.01)
FOUR = RunStatistics(runs=4, points=3, misfit=25.0, held_out=12.0, coherent=True, moved_p=0.0, drift_p=0.001)
FINE = replace(FOUR, misfit=-0.2, held_out=0.3, coherent=False, moved_p=0.4, drift_p=0.3)


def verdict(situation, *contenders):
    told = decide(situation, contenders, DecisionRules())
    assert told.verdict in VERDICTS and told.reasons
    return told.verdict


def test_what_passes_every_rule_is_named_by_its_kind():
    assert verdict(FOUR, GOOD) == "missing"
    assert verdict(FOUR, replace(GOOD, kind="sensor")) == "sensor"
    assert verdict(FOUR, replace(GOOD, kind="numerics")) == "numerics"


def test_without_candidates_the_nominal_model_decides():
    assert verdict(FINE) == "consistent"
    assert verdict(replace(FINE, moved_p=1e-6)) == "parameters"
    assert verdict(replace(FINE, misfit=3.1)) == "unknown"
    assert verdict(replace(FINE, held_out=3.1)) == "unknown"
    assert verdict(replace(FINE, coherent=True)) == "unknown"
    assert verdict(replace(FINE, drift_p=5e-4)) == "unknown"


def test_values_that_priors_exclude_are_told_where_nothing_is_named():
    situation = replace(FOUR, excluded=("the prior of stiffness excludes the data",))
    assert situation.excluded[0] in decide(situation, [], DecisionRules()).reasons
    assert situation.excluded[0] not in decide(situation, [GOOD], DecisionRules()).reasons


@pytest.mark.parametrize("broken, told", [
    ({"forbidden": "its friction is negative"}, "its friction is negative"),
    ({"doubts": ("its fit did not converge",)}, "its fit did not converge"),
    ({"nominal_p": 1e-5}, "unlikely together under their priors"),
    ({"powered": False, "evidence_gain": 9.0, "stays": 0.0}, "no held-out run can confirm it"),
    ({"from_null": 1.9}, "1.9 standard deviations from none"),
    ({"disagreement": 3.1}, "differs between operating points"),
    ({"left_out_gain": -0.1}, "left-out operating points no better"),
    ({"unfitted_errors": 2.9}, "gain on runs that were not fitted is 2.9 standard errors"),
    ({"held_out_errors": -1.1}, "predicts held-out runs worse, by 1.1 standard errors"),
    ({"held_out_share": 0.04}, "4.0% of the excess error"),
    ({"held_out_left": 0.11}, "leaves 11% of the excess error on held-out runs"),
    ({"growth": 3.1}, "squared error on held-out runs is 3.1 times that on the fitted ones"),
    ({"beats_decoy": False}, "no better than a decoy"),
    ({"varying": ("its value follows time along the runs",)}, "follows time along the runs"),
])
def test_a_single_broken_rule_forbids_the_name_and_is_told(broken, told):
    contender = replace(GOOD, **broken)
    assert any(told in why for why in objections(contender, FOUR, DecisionRules()))
    assert verdict(FOUR, contender) == "unknown" and verdict(FINE, contender) == "consistent"
    assert any(told in why for why in decide(FOUR, [contender], DecisionRules()).reasons)


@pytest.mark.parametrize("broken", [{"p_value": 0.011}, {"evidence_gain": 4.9}])
def test_what_is_not_significant_is_not_a_candidate(broken):
    assert verdict(FINE, replace(GOOD, **broken)) == "consistent"
    assert verdict(FOUR, replace(GOOD, **broken)) == "unknown"


def test_two_that_explain_alike_are_a_tie_of_both():
    first, second = replace(GOOD, posterior=0.6), replace(GOOD, name="gap", posterior=0.39)
    told = decide(FOUR, [second, first], DecisionRules())
    assert told.verdict == "tie" and [c.name for c in told.named] == ["friction", "gap"]
    assert verdict(FOUR, replace(first, kind="sensor"), replace(second, kind="sensor")) == "sensor"


def test_a_rival_that_breaks_a_rule_leaves_the_other_named():
    first, second = replace(GOOD, posterior=0.6), replace(GOOD, name="gap", posterior=0.39, held_out_errors=-2.0)
    assert verdict(FOUR, first, second) == "missing"


def test_what_breaks_no_rule_is_not_named_in_place_of_something_more_likely():
    first, second = replace(GOOD, posterior=0.6, held_out_errors=-2.0), replace(GOOD, name="gap", posterior=0.39)
    told = decide(FOUR, [first, second], DecisionRules())
    assert told.verdict == "unknown" and "gap: candidates that break a rule are more likely" in told.reasons


def test_what_leaves_more_than_a_twentieth_is_unknown():
    assert verdict(FOUR, replace(GOOD, unexplained=0.06)) == "unknown"
    assert verdict(FOUR, replace(GOOD, unexplained=0.049)) == "missing"


def test_a_law_whose_shape_adapts_may_leave_less():
    """GOOD leaves 1 %: an error of a tenth of its force, which a law with a shape would take up were it the right one.
    """
    assert verdict(FOUR, GOOD) == "missing" and verdict(FOUR, replace(GOOD, adapts=True)) == "unknown"
    assert verdict(FOUR, replace(GOOD, adapts=True, unexplained=0.0024)) == "missing"
    assert "another form" in "".join(objections(replace(GOOD, adapts=True), FOUR, DecisionRules()))


def test_a_law_refused_for_its_form_alone_still_ties_with_another_as_likely():
    other = replace(GOOD, posterior=0.85)
    shaped = replace(GOOD, name="arm", posterior=0.15, adapts=True)
    told = decide(FOUR, [other, shaped], DecisionRules())
    assert told.verdict == "tie" and [c.name for c in told.named] == ["friction", "arm"]
    assert verdict(FOUR, replace(other, posterior=0.95), replace(shaped, posterior=0.05)) == "missing"
    assert verdict(FOUR, other, replace(shaped, doubts=("its fit did not converge",))) == "missing"
    assert verdict(FOUR, replace(other, posterior=0.4), replace(shaped, posterior=0.6)) == "unknown"


def test_one_run_names_nothing_and_says_so():
    alone = replace(GOOD, held_out_errors=None, beats_decoy=None)
    told = decide(replace(FOUR, runs=1, points=1), [alone], DecisionRules())
    assert told.verdict == "tie" and any("one run only" in why for why in told.reasons)


def test_below_three_points_agreement_is_waived_and_told():
    told = decide(replace(FOUR, runs=3, points=2), [replace(GOOD, disagreement=50.0)], DecisionRules())
    assert told.verdict == "missing" and any("values agree across them was not tested" in why for why in told.reasons)


def test_held_out_runs_without_power_neither_refuse_nor_confirm_and_are_told():
    situation = replace(FOUR, powerless=("run_9",))
    weak = replace(GOOD, powered=False, held_out_errors=-3.6, held_out_left=0.9, growth=9.0, beats_decoy=False,
                   stays=0.08)
    told = decide(situation, [weak], DecisionRules())
    assert told.verdict == "missing" and any("without power: run_9" in why for why in told.reasons)
    assert verdict(situation, replace(weak, stays=0.11)) == "unknown"
    assert verdict(situation, replace(weak, loses=0.3)) == "unknown", "what is not there on held-out runs"
    assert verdict(situation, replace(weak, unfitted_errors=2.9)) == "unknown"
    assert verdict(situation, replace(weak, powered=True)) == "unknown"


@pytest.mark.parametrize("broken", [{"unexplained": 0.19}, {"held_out_left": 0.19}, {"disagreement": 15.5}])
def test_what_helps_beyond_chance_leads_where_nothing_is_named(broken):
    partly = replace(GOOD, takes=0.81, stays=0.19, **broken)
    told = decide(FOUR, [replace(partly, name="gap", posterior=0.01), partly], DecisionRules())
    assert (told.verdict, told.leading) == ("unknown", partly)
    assert decide(FINE, [partly], DecisionRules()).leading is None or told.verdict == "unknown"


@pytest.mark.parametrize("broken", [{"takes": 0.04}, {"unfitted_errors": 2.9}, {"left_out_gain": -1.0},
                                    {"forbidden": "its friction is negative"}, {"p_value": 0.02},
                                    {"doubts": ("its prior excludes the data",)}, {"nominal_p": 1e-5},
                                    {"posterior": 6e-27}, {"growth": 65.0}])
def test_nothing_leads_that_does_not_help(broken):
    partly = replace(GOOD, **{"takes": 0.81, "stays": 0.19, "unexplained": 0.19, **broken})
    told = decide(FOUR, [partly], DecisionRules())
    assert told.verdict == "unknown" and told.leading is None


def test_the_leading_one_comes_with_its_family():
    """Dahl and Jenkins at the joint both take nearly all: dry friction there, of a form that is open."""
    dahl = replace(GOOD, name="dahl at joint", takes=0.98, unexplained=0.19)
    jenkins, elsewhere = (replace(dahl, name=name, posterior=1e-9) for name in ("jenkins at joint", "jenkins at wall"))
    spring = replace(jenkins, name="cubic_stiffness at joint", takes=0.5)
    told = decide(FOUR, [dahl, jenkins, elsewhere, spring, replace(jenkins, doubts=("no",))], DecisionRules())
    assert (told.verdict, told.leading, told.family) == ("unknown", dahl, (jenkins,))
    assert decide(FOUR, [spring], DecisionRules()).family == ()


def test_what_a_value_follows_a_little_is_told_beside_the_name():
    told = decide(FOUR, [replace(GOOD, remarks=("its value follows time along the runs, by 29%",))], DecisionRules())
    assert told.verdict == "missing" and "friction: its value follows time along the runs, by 29%" in told.reasons


def test_rules_are_the_users():
    assert decide(FOUR, [replace(GOOD, unexplained=0.15)], DecisionRules(unexplained=0.2)).verdict == "missing"
