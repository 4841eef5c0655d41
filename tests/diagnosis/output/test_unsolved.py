"""A diagnosis whose solution fails is unknown, and says what was done and what went wrong."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.runs import recorded
from pipeline.contract import ConvergenceError
from pipeline.contract.settings import fill
from pipeline.diagnosis.forced_response import forced_problem
from pipeline.diagnosis.output.files import as_json
from pipeline.diagnosis.output.product import product
from pipeline.diagnosis.output.unsolved import STEPS, unsolved
from pipeline.diagnosis.settings import Settings
from pipeline.inference import procedure
from pipeline.views.chapters.bench.diagnosis import chapter
from tests.diagnosis.output.test_product import ASKED
from tests.diagnosis.small_rig import laid_out, model, recording


def posed():
    return forced_problem(benches.built(model(), laid_out()), recorded(recording(levels=(1.0, 2.0, 3.0, 2.5)),
                                                                       laid_out()), fill(Settings, ASKED, "d"))


def fails(*_, **__):
    raise np.linalg.LinAlgError("Singular matrix")


@pytest.mark.parametrize("step", ["recalibrate", "decided"])
def test_the_step_that_failed_is_told_with_the_failure(step, monkeypatch):
    problem = replace(posed(), candidates=posed().candidates[:1])
    monkeypatch.setattr(procedure, step, _named(step))
    with pytest.raises(np.linalg.LinAlgError) as failure:
        problem.solved()
    told = product(*unsolved(problem, failure.value))
    why = str(told.reason[0])
    assert told.verdict.item() == "unknown" and not len(told.named) and not len(told.leading)
    assert why.startswith(f"nothing could be judged: while {STEPS[step]}, the diagnosis failed: internal error"
                          " LinAlgError: Singular matrix")
    assert "please report it" in why and told.posterior.sum() == pytest.approx(1.0)
    assert all("not judged" in str(o) for o in told.objection[1:])
    assert set(told.runs) == {run.name for run in problem.problem.runs} and told.fit[1, 0] == told.fit[1, 2] > 0
    assert as_json(told)["reasons"][0] == why
    assert any("Singular matrix" in text for text in dict(chapter_notes(told)).values())


def chapter_notes(told):
    from pipeline.views.chapters.bench.diagnosis import note

    assert chapter(told, None).title
    return note(told)


def _named(step):
    """A function of this name that fails, as the traceback shows it."""
    scope = {"fails": fails}
    exec(f"def {step}(*a, **k): return fails()", scope)
    return scope[step]


def test_what_not_even_the_given_values_predict_is_an_error_of_the_case():
    problem = posed()

    def nowhere(hypothesis, values, run):
        raise ConvergenceError("time stepping", "a bounded motion", "unbounded growth")

    error = ConvergenceError("calibration of nominal", "a fit", "none")
    with pytest.raises(ConvergenceError, match="calibration of nominal"):
        unsolved(replace(problem, problem=replace(problem.problem, predict=nowhere)), error)
