"""Laws that hold in part: named where one explains nearly all, not where none does or noise is all that stays."""

import numpy as np
import pytest

from pipeline.inference.diagnosis import Settings, over_noise
from pipeline.inference.procedure import Asked, diagnose
from tests.inference.falling_ball import CATALOGUE, bench

SETTINGS = Settings(draws=500)


def told(drag):
    return diagnose(*bench(drag), CATALOGUE, SETTINGS)


def floors(fit):
    return np.sqrt(fit.chi_square.sum() / fit.counts.sum())


def waving(v):
    return 0.5 * v + 3.0 * np.sin(v)


def test_a_law_that_holds_in_part_is_named_and_what_stays_is_told():
    solved = told(waving)
    decision, completed = solved.decision, solved.completed
    assert decision.verdict == "missing" and [c.name for c in decision.named] == ["viscous"]
    assert solved.model_error > 1.2 and "holds in part" in decision.reasons[0]
    assert 0.2 * solved.model_error < floors(completed) < 1.1 * solved.model_error, "fits stand beside the stated noise"
    assert floors(solved.null) > 4 * solved.model_error
    assert over_noise(solved, SETTINGS, (1.0,))[0].verdict == "missing", "levels are multiples of that error"


@pytest.mark.parametrize(("drag", "verdict"), [
    (lambda v: 0.0 * v, "consistent"), (lambda v: 0.5 * v, "missing"), (lambda v: 6.0 * np.sin(0.3 * v), "unknown")])
def test_what_reaches_the_noise_or_is_like_nothing_is_not_told_so(drag, verdict):
    solved = told(drag)
    assert solved.decision.verdict == verdict
    assert solved.model_error == 1 and not any("holds in part" in reason for reason in solved.decision.reasons)


def test_a_failure_there_leaves_what_was_told_beside_the_stated_noise(monkeypatch):
    def failing(asked, motions=None):
        if asked.alone:
            raise ZeroDivisionError("no")
        return asked.diagnosed(motions)

    monkeypatch.setattr(Asked, "told", failing)
    solved = told(waving)
    assert solved.decision.verdict == "unknown" and solved.model_error == 1
    assert "whether a law holds in part could not be computed: " in solved.decision.reasons[-1]
