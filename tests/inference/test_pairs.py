"""Pairs of laws: found together or one after the other, named only where the second is more than an error of the first.
"""

from dataclasses import dataclass, replace
from math import tanh
from types import SimpleNamespace

import pytest

from pipeline.inference import pairs
from pipeline.inference.diagnosis import Settings
from pipeline.inference.fitting.noise import budget
from pipeline.inference.procedure import Asked, diagnose
from tests.inference import linear
from tests.inference.oscillator import CATALOGUE, bench, both, changed


def test_two_laws_neither_of_which_explains_enough_are_named_together():
    problem = bench(5, 0.1, stiffness=380.0, extra=lambda t, x, v: 1.5e4 * x**3 + 1.5 * tanh(v / 0.005))
    told = diagnose(problem, budget(problem), CATALOGUE)
    effects = {effect for effect, _ in told.nominal.effects} | {c.name for c in told.decision.named}
    assert told.base.decision.verdict == "unknown" and told.decision.verdict == "missing"
    assert effects == {"cubic", "coulomb"} and told.combinations[0].outcome == "named"


def test_two_effects_are_found_one_after_the_other():
    problem = bench(5, 0.1, stiffness=380.0, extra=both)
    told = diagnose(problem, budget(problem), CATALOGUE)
    effects = {effect for effect, _ in told.nominal.effects} | {c.name for c in told.decision.named}
    assert told.decision.verdict == "missing" and effects == {"cubic", "coulomb"}
    assert told.base.weighed[0].candidate.name == "cubic", "friction is a small share of the excess"


def test_the_first_law_of_a_pair_is_told_from_others_beside_the_second(monkeypatch):
    """Beside quadratic stiffness a slow drive did nearly what the pad that acted did; it had led alone."""
    problem, asked = bench(5, 0.1, stiffness=380.0, extra=both), []

    def untold(self, single, start, law, known):
        asked.append((law.name, *(k.name for k in known)))
        reasons = "these runs cannot tell cubic, quintic apart",
        return SimpleNamespace(decision=SimpleNamespace(verdict="tie", named=[law], reasons=reasons))

    monkeypatch.setattr(Asked, "weighed_together", untold)
    told = diagnose(problem, budget(problem), CATALOGUE)
    assert asked == [("cubic", "coulomb")] and told.decision.verdict == "unknown" and not told.named
    assert any("cannot tell cubic, quintic apart" in reason for reason in told.decision.reasons)


def test_a_second_effect_within_the_error_of_the_law_of_the_first_is_not_named():
    problem = bench(5, 0.1, stiffness=380.0, extra=both)
    asked = replace(Settings(), rules=changed("decision", second_share=0.2, second_at_noise=0.2))
    told = diagnose(problem, budget(problem), CATALOGUE, asked)
    assert told.base is None and [c.name for c in told.decision.named] in ([], ["cubic"])


def test_a_smaller_second_effect_is_named_where_both_reach_the_noise():
    problem = bench(5, 0.1, stiffness=380.0, extra=both)
    asked = replace(Settings(), rules=changed("decision", second_share=0.2))
    told = diagnose(problem, budget(problem), CATALOGUE, asked)
    assert told.base is not None and told.decision.verdict == "missing"
    assert not told.named[0].statistics.held_out_left


def odd_values(amount):
    """A linear problem of a strong effect_1, and an effect_2 of this ``amount`` that 7 deviations of a value mimic."""
    whole, noise, catalogue, tables = linear.problem((1, 1, 1), runs=4, held_out=1)
    runs = []
    for run in whole.runs:
        table = tables[run.name]
        table["effect_2_0"] = 7 * table["nominal_0"] + 0.3 * table["effect_2_0"]
        runs.append(replace(run, samples=run.samples + 3 * table["effect_1_0"] + amount * table["effect_2_0"]))
    return replace(whole, runs=tuple(runs)), noise, catalogue


def test_a_second_effect_that_gives_values_back_to_their_priors_is_named():
    asked = replace(Settings(), rules=changed("decision", second_share=0.9, second_at_noise=0.9))
    told = diagnose(*odd_values(1.0), asked)
    assert told.decision.verdict == "missing" and told.base is not None
    assert {c.name for c in told.decision.named} == {"effect_2"} and told.nominal.effects[0][0] == "effect_1"


def test_values_within_their_priors_ask_for_no_second_effect():
    asked = replace(Settings(), rules=changed("decision", second_share=0.9, second_at_noise=0.9))
    told = diagnose(*odd_values(0.4), asked)
    assert told.decision.verdict == "missing" and told.base is None
    assert [c.name for c in told.decision.named] == ["effect_1"]


@dataclass(frozen=True)
class Told:
    """What stands for a Diagnosis: its verdict, whether it is of several laws, whether it leaves nothing."""

    verdict: str
    base: object = None
    leaves_nothing: bool = False
    combinations: tuple = ()

    null = None
    refits = SimpleNamespace(refitter=SimpleNamespace(catalogue=()))

    @property
    def decision(self):
        return SimpleNamespace(verdict=self.verdict)

    @property
    def weighed(self):
        return (SimpleNamespace(fit=SimpleNamespace(reaches_noise=lambda _: self.leaves_nothing),
                                statistics=SimpleNamespace(unexplained=0.0, held_out_left=None)),)


WHOLE, PART, NONE = Told("missing", 1, True), Told("missing", 1), Told("unknown")


@pytest.mark.parametrize("single, pair, along, best", [
    ("unknown", WHOLE, None, WHOLE), ("unknown", PART, WHOLE, WHOLE), ("unknown", PART, NONE, PART),
    ("unknown", NONE, NONE, NONE), ("tie", Told("tie"), None, Told("tie")), ("tie", PART, None, PART)])
def test_a_pair_of_the_race_stands_where_it_leaves_nothing_or_no_set_is_named(monkeypatch, single, pair, along, best):
    """A set along motions may hold a third law; a tie of single laws is asked for a second one, and for no more."""
    tried = []
    monkeypatch.setattr(pairs, "raced", lambda asked, single: pair)
    monkeypatch.setattr(Asked, "along", lambda self, single, motions: (tried.append(motions), along)[1])
    assert Asked(None, {}, (), Settings(), map).of_several(Told(single), "motions") == best
    assert bool(tried) == (along is not None)


@dataclass(frozen=True)
class Asking:
    """What stands for Asked: of the names that a race yields, ``right`` is named."""

    catalogue: tuple = ()
    problem, budget, settings, fan_out, weighed = None, None, None, None, []

    def together(self, single, pair):
        self.weighed.append(pair)
        return PART if pair == "right" else single


def test_a_race_is_asked_for_others_until_two_laws_are_named(monkeypatch):
    monkeypatch.setattr(pairs, "race", lambda *_: (SimpleNamespace(selected=lambda *_, name=name: name)
                                                   for name in ("wrong", "right", "late")))
    assert pairs.raced(Asking(), NONE) == PART and Asking.weighed == ["wrong", "right"]
    assert pairs.raced(Asking(), PART) == PART and len(Asking.weighed) == 2, "its second law is looked for beside it"
