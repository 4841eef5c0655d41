"""The rules as a section of the settings, and as what the steps get."""

import pytest

from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from pipeline.diagnosis.rules import DEFAULTS, rules_stated
from pipeline.diagnosis.settings import Settings, procedure


def settings(**rules):
    return fill(Settings, {"rules": rules}, "diagnosis")


def test_a_case_that_says_nothing_has_the_defaults():
    assert rules_stated(settings()) == DEFAULTS == procedure(settings()).rules


def test_a_stated_threshold_is_the_one_in_force_and_in_the_table():
    rules = procedure(settings(decision={"p_value": 0.001}, poles={"delay_std": 2e-6})).rules
    rows = {name: (value, unit) for name, value, unit, _ in rules.rows()}
    assert rows["decision.p_value"] == (0.001, "1") and rows["poles.delay_std"] == (2e-6, "s")
    assert rules.decision.posterior == DEFAULTS.decision.posterior


def test_runs_of_a_few_dozen_numbers_ask_for_more():
    assert procedure(settings(), few=True).rules.decision.posterior == DEFAULTS.decision.posterior_of_few > 0.9


@pytest.mark.parametrize("rules, said", [({"decision": {"posteriour": 0.8}}, "posterior"),
                                         ({"decision": {"p_value": -1}}, "p_value")])
def test_unknown_and_impossible_thresholds_are_refused(rules, said):
    with pytest.raises(ConfigError, match=said):
        settings(**rules)
