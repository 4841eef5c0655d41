"""Sets of laws: all that are there, none that only mends the law of another."""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import pytest

from pipeline.contract.errors import ConvergenceError
from pipeline.inference import several
from pipeline.inference.diagnosis import Settings
from pipeline.inference.fitting.fit_state import linearised
from pipeline.inference.problem import Problem
from pipeline.inference.procedure import diagnose
from pipeline.inference.rules import DEFAULTS
from pipeline.inference.search.score_screen import directions
from tests.inference import linear
from tests.studies import several as study

RULES = DEFAULTS.decision


@dataclass(frozen=True)
class Measured:
    """Motions of a linear problem, where the law of effect_1 may err by ``shape`` {run: (1, m)}."""

    whole: Problem
    shape: dict

    def along(self, null):
        return replace(self.whole, runs=null.runs, predict=self)

    def __call__(self, hypothesis, values, run):
        return self.whole.predict(hypothesis, values, run)

    def law_errors(self, hypothesis, values, run, effects):
        size = values["effect_1_0"] if effects[0][0] == "effect_1" else 0.0
        return [size * self.shape[run.name]]


def posed(truth):
    """(Fit of the nominal model, Problem, {run: Noise}, catalogue, tables) of five effects."""
    whole, noise, catalogue, tables = linear.problem((2, *(1,) * 5), runs=4, samples=400, held_out=1, truth=truth,
                                                     prior=3.0)
    noises = [noise[run.name] for run in whole.training]
    return linearised(whole, noises, whole.nominal, np.zeros(2), whole.training), whole, noise, catalogue, tables


def named(selection, catalogue):
    return {catalogue[i].name for i in selection.members}


@pytest.mark.parametrize("truth", [{}, {"effect_2_0": 1.0}, {"effect_1_0": 1.0, "effect_3_0": -0.7, "effect_5_0": 0.5}])
def test_all_that_are_there_and_nothing_else(truth):
    null, whole, _, catalogue, tables = posed(truth)
    every = tuple(map(partial(directions, whole, null), catalogue))
    screened = several.linearised_about(null, every, catalogue, RULES)
    motions = Measured(whole, {run: np.zeros((1, 400)) for run in tables})
    along = several.along_motions(null, catalogue, motions, RULES, map).selected()
    assert named(screened, catalogue) == named(along, catalogue) == {n.removesuffix("_0") for n in truth}
    assert not screened.judged and along.judged == set(range(5)), "motions alone can say that a law is not there"
    assert along.start(along.members)[2:] == pytest.approx([truth[f"{catalogue[i].name}_0"] / 3 for i in along.members],
                                                           abs=0.05)


def test_a_law_that_only_mends_another_is_not_named():
    null, whole, _, catalogue, tables = posed({"effect_1_0": 2.0, "effect_4_0": 0.25})
    nothing = Measured(whole, {run: np.zeros((1, 400)) for run in tables})
    shape = Measured(whole, {run: table["effect_4_0"][None] for run, table in tables.items()})
    sharp, wrong = (several.along_motions(null, catalogue, m, RULES, map).selected() for m in (nothing, shape))
    assert named(sharp, catalogue) == {"effect_1", "effect_4"}
    loose = several.along_motions(null, catalogue, shape, replace(RULES, law_error=0.2), map).selected()
    assert named(loose, catalogue) == {"effect_1"}
    assert {c.effects: c.gain for c in wrong.tried}["effect_1", "effect_4"] < {
        c.effects: c.gain for c in sharp.tried}["effect_1", "effect_4"]


def test_a_share_that_the_law_of_another_may_be_wrong_by_is_not_named():
    null, whole, _, catalogue, tables = posed({"effect_1_0": 6.0, "effect_4_0": 0.25})
    every = tuple(map(partial(directions, whole, null), catalogue))
    assert named(several.linearised_about(null, every, catalogue, RULES), catalogue) == {"effect_1"}
    fine = replace(RULES, second_share=1e-4)
    assert named(several.linearised_about(null, every, catalogue, fine), catalogue) == {"effect_1", "effect_4"}


def test_motions_that_fail_select_nothing():
    class Failing:
        def along(self, null):
            raise ConvergenceError("motions", "some", "none")

    null, _, _, catalogue, _ = posed({})
    assert several.along_motions(null, catalogue, Failing(), RULES, map) is None


def test_three_of_a_joint_are_named_together_with_what_was_tried():
    """Laws of the truth that are 2 to 5 % wrong, integrated by SciPy; by the equation of motion, few rivals."""
    whole = study.problem(study.truth(study.LAWS, 0), 0, equation=True)
    solved = whole.solved()
    assert study.answer(solved) == ("missing", tuple(sorted(study.LAWS)))
    first = solved.combinations[0]
    assert set(first.effects) == {f"{law} at mount" for law in study.LAWS} and first.outcome == "named"
    assert first.objective is not None and 0.9 < first.held_out < 1.5 and solved.laws == 3


def test_one_law_alone_gets_no_second_name():
    whole, noise, catalogue, tables = linear.problem((2, *(1,) * 5), runs=4, samples=400, held_out=1, prior=3.0,
                                                     truth={"effect_1_0": 2.0})
    motions = Measured(whole, {run: np.zeros((1, 400)) for run in tables})
    solved = diagnose(whole, noise, catalogue, Settings(draws=2000), motions=motions)
    assert [c.name for c in solved.decision.named] == ["effect_1"] and solved.base is None and solved.laws == 1


@pytest.mark.parametrize(("elaborate", "answer"), [(False, {"effect_5", "effect_3"}), (True, {"effect_1", "effect_3"})])
def test_elaborate_laws_are_selected_only_where_simple_ones_do_not_reach_the_noise(elaborate, answer):
    """The last candidate moves as the first does and as the noise happened to be."""
    truth = {"effect_1_0": 1.0, "effect_3_0": -0.7}
    whole, noise, catalogue, tables = linear.problem((2, *(1,) * 5), runs=4, samples=400, held_out=1, prior=3.0,
                                                     truth=truth)
    for run in whole.runs:
        own = tables[run.name]
        own["effect_5_0"] = own["effect_1_0"] + 0.5 * (run.samples[0] - sum(v * own[n] for n, v in truth.items()))
    catalogue[-1] = replace(catalogue[-1], elaborate=elaborate, extends=("effect_1",))
    motions = Measured(whole, {run: np.zeros((1, 400)) for run in tables})
    solved = diagnose(whole, noise, catalogue, Settings(draws=2000), motions=motions)
    assert set(solved.combinations[0].effects) == answer and solved.combinations[0].outcome == "named"


def test_sensors_are_in_no_set():
    """Gains of several sensors together shrink all data, which leaves less without explaining anything."""
    null, whole, _, catalogue, tables = posed({"effect_1_0": 1.0, "effect_3_0": -0.7})
    mixed = tuple(replace(c, kind="sensor") if c.name == "effect_3" else c for c in catalogue)
    every = tuple(map(partial(directions, whole, null), mixed))
    motions = Measured(whole, {run: np.zeros((1, 400)) for run in tables})
    along = several.along_motions(null, mixed, motions, RULES, map).selected()
    for selection in (several.linearised_about(null, every, mixed, RULES), along):
        tried = {name for combination in selection.tried for name in combination.effects}
        assert "effect_1" in named(selection, mixed) and "effect_3" not in tried
    assert along.judged == {0, 1, 2, 3, 4} - {[c.name for c in mixed].index("effect_3")}
