"""Evidence of refitted and of screened candidates side by side, and what it makes of a linear problem."""

import numpy as np
import pytest

from pipeline.inference.decision.evidence import evidence, screened
from pipeline.inference.decision.weighing import _without_mere_extensions, evidence_of_all, weigh
from pipeline.inference.diagnosis import Settings
from pipeline.inference.fitting.calibration import recalibrate
from pipeline.inference.fitting.refitting import refit_catalogue
from pipeline.inference.problem import Hypothesis
from pipeline.inference.rules import DEFAULTS
from pipeline.inference.search.score_screen import screen_catalogue
from tests.inference import linear

SETTINGS = Settings(draws=2000)


def steps(truth, **more):
    """(Screening, Refits) of a linear problem of two candidates."""
    whole, noise, catalogue, _ = linear.problem((2, 1, 1), runs=4, truth=truth, held_out=1, **more)
    screening = screen_catalogue(recalibrate(whole, noise, DEFAULTS.calibration), catalogue, SETTINGS, map)
    return screening, refit_catalogue(screening, catalogue, SETTINGS, map)


@pytest.mark.exact
def test_on_a_linear_problem_the_screen_promises_what_the_refit_reaches():
    screening, refits = steps({"effect_1_0": 0.6})
    fit = refits.results[0].fit
    evidences = evidence_of_all(screening.calibration.null, screening.directions, {0: fit}, SETTINGS)
    assert evidences.log_evidence[1] == evidence(fit, evidences.weights).log_evidence
    base, scores = evidences.null.log_evidence, evidences.screen
    promised = screened(base, scores.score[0], scores.power[0])
    assert evidences.log_evidence[1] == pytest.approx(promised, abs=0.05) and promised - base > 10


def test_what_could_not_be_judged_has_no_probability():
    screening, _ = steps({})
    name = screening.directions[1].candidate.name
    logs = evidence_of_all(screening.calibration.null, screening.directions, {}, SETTINGS, {name}).log_evidence
    assert np.isfinite(logs[:2]).all() and logs[2] == -np.inf


def test_a_candidate_that_was_not_refitted_but_promises_as_much_is_overlooked():
    screening, refits = steps({"effect_1_0": 0.6})
    other = {1: refits.refitter.of([1], screening.screen.start)[1].fit}
    evidences = evidence_of_all(screening.calibration.null, screening.directions, other, SETTINGS)
    assert list(evidences.overlooked(DEFAULTS.decision)) == [0]
    assert not evidence_of_all(screening.calibration.null, screening.directions, {0: refits.results[0].fit},
                            SETTINGS).overlooked(DEFAULTS.decision)


def test_the_hidden_effect_is_weighed_first_and_probabilities_sum_to_one():
    _, refits = steps({"effect_1_0": 0.6})
    weighing = weigh(refits, SETTINGS)
    assert weighing.weighed[0].candidate.name == "effect_1" and weighing.posterior[1] > 0.99
    assert weighing.posterior.sum() == pytest.approx(1.0) and not weighing.failures
    assert weighing.weighed[0].statistics.held_out_errors > 3 and weighing.runs.runs == 4


@pytest.mark.parametrize("limit, gain, counts", [
    (40.0, 0.0, False), (40.0, 4.9, False), (40.0, 5.1, True), (2e5, 19.9, False), (2e5, 20.1, True)])
def test_a_law_that_extends_another_counts_by_what_it_adds(limit, gain, counts):
    """Margin 5 nat over its limit, or a ten thousandth of what that explains; a limit that was not refitted, or is none
    of the candidates, takes nothing away."""
    laws = [Hypothesis("limit"), Hypothesis("law", extends=("limit", "elsewhere"))]
    logs = 7.0 + np.array([0.0, limit, limit + gain])
    counted = _without_mere_extensions(logs, laws, {0: None, 1: None}, DEFAULTS.decision)
    assert list(counted[:2]) == list(logs[:2]) and counted[2] == (logs[2] if counts else -np.inf)
    assert np.array_equal(_without_mere_extensions(logs, laws, {1: None}, DEFAULTS.decision), logs)
