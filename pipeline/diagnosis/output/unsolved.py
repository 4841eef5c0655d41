"""The Diagnosis of a problem whose solution failed: unknown, what was done, and what went wrong."""

import traceback
from dataclasses import replace

import numpy as np

from pipeline.contract.errors import sentence_of
from pipeline.diagnosis.problem import Nowhere
from pipeline.inference.decision.decision_rules import Decision
from pipeline.inference.decision.evidence import cautious_prior
from pipeline.inference.decision.weighing import Evidences, Weighing
from pipeline.inference.diagnosis import Diagnosis
from pipeline.inference.fitting.calibration import Calibration
from pipeline.inference.fitting.fit_state import Fit, whitened
from pipeline.inference.fitting.parameter_drift import Drift
from pipeline.inference.search.score_screen import Screen

#: what each function of ``inference.procedure`` does, in the order of a diagnosis
STEPS = {"recalibrate": "the nominal values were being recalibrated",
         "screen_catalogue": "candidates were being screened",
         "refit_catalogue": "candidates were being refitted",
         "decided": "candidates were being weighed"}


def unsolved(problem, error):
    """(DiagnosisProblem that asks for nothing more, Diagnosis at the given values) of one whose solution raised
    ``error``. Raises it where not even the nominal model at its given values predicts the runs: that is the case's.
    """
    asked, runs = problem.problem, problem.problem.training
    noises, hypothesis = tuple(problem.budget[run.name] for run in runs), asked.nominal
    latent, count = hypothesis.nominal, len(problem.candidates)
    residuals, refused = whitened(asked, noises, hypothesis, latent, runs)
    if refused:
        raise error
    null = Fit(hypothesis, runs, noises, latent, tuple(residuals),
               tuple(np.zeros((len(r), len(latent))) for r in residuals), False, 1)
    screen = Screen(problem.candidates, np.zeros(count), np.ones(count), np.zeros(count),
                    tuple(np.zeros(len(c.parameters)) for c in problem.candidates), ("",) * count)
    prior, names = cautious_prior(count), tuple(p.name for p in hypothesis.parameters)
    nothing = np.zeros((1, len(names)))
    weighing = Weighing(None, (), prior, Evidences(None, {}, np.log(prior), screen, np.ones(len(runs))),
                        Drift((), names, nothing, nothing, 0.0, 1.0, 0),
                        {c.name: "not judged: the diagnosis did not come to its end" for c in problem.candidates})
    failure = f"nothing could be judged: while {_step(error)}, the diagnosis failed: {sentence_of(error)}"
    decision = Decision("unknown", (), (
        failure,
        "what is shown as recalibrated and completed is the model at its given values; probabilities are those before"
        " the data"), failure=failure)
    return (replace(problem, locator=Nowhere(), latent=None, squeals=None, revision=None, noise_levels=()),
            Diagnosis(Calibration(asked, problem.budget, null), weighing, decision))


def _step(error):
    """The step of the procedure in which an error was raised."""
    frames = [frame.name for frame in traceback.extract_tb(error.__traceback__)]
    return next((words for name, words in STEPS.items() if name in frames), "it was being posed")
