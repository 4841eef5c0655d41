"""What is left once a diagnosis has named all it can: how much, in which band, what it follows, what comes next."""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.contract import BrakechainError
from pipeline.diagnosis.output.combinations import NOT_REFITTED
from pipeline.inference.decision.held_out import held_out_residuals
from pipeline.inference.fitting.effective_sample_size import doubt


@dataclass(frozen=True)
class Remainder:
    """``floors``: root mean square of the whitened residual of the completed model over all runs, 1 for noise alone.

    ``sentence``: where it is and what it follows, empty where nothing is left beyond doubt; ``candidate``: the best one
    of those that were tried beside what is named, in words, or empty.
    """

    floors: float
    sentence: str
    candidate: str


def remainder(problem, diagnosis):
    """Remainder of a DiagnosisProblem and the Diagnosis of it."""
    fit, runs = diagnosis.completed, problem.problem.held_out
    noises, share = tuple(problem.budget[run.name] for run in runs), problem.rules.decision.start_share
    whites = [*fit.residuals, *held_out_residuals(problem.problem, noises, fit, runs, share)]
    square, count = sum(w @ w for w in whites), sum(len(w) for w in whites)
    floors = float(np.sqrt(square / max(count, 1)))
    if square - count <= doubt(count, problem.rules.decision.noise_uncertainty) or not diagnosis.decision.named:
        return Remainder(floors, "", "")
    left = replace(diagnosis, base=None, calibration=replace(diagnosis.calibration, null=fit))
    return Remainder(floors, _told(problem, left), _candidate(diagnosis))


def _told(problem, left):
    """Where what is left lies and what it follows; a model that cannot be pushed off its fit does not cost the verdict.
    """
    try:
        axes = problem.locator.located(left)
        latent = problem.latent.described(left, axes) if problem.latent else None
    except BrakechainError as error:
        return f"Where it lies could not be computed: {error}."
    words = [_band(axes.get("band")), latent.sentence if latent else ""]
    return " ".join(w for w in words if w) or "Neither a place nor a band stands out."


def _band(axis):
    """'It lies between 20 and 40 Hz.' of a located (Location, unit, edges) or None."""
    if axis is None:
        return ""
    location, unit, edges = axis
    rows = np.flatnonzero(location.members)
    if not len(rows) or not (location.p_value[rows] <= 0.05).any():
        return ""
    return f"It lies between {edges[rows, 0].min():.3g} and {edges[rows, 1].max():.3g} {unit}."


def _candidate(diagnosis):
    """The best candidate beside what is named, and why it is not named too."""
    further = diagnosis.further
    if further is None or not further.weighed:
        return _of_combinations(diagnosis)
    best = further.weighed[0].candidate.name
    why = next((reason for reason in further.decision.reasons if reason.startswith(f"{best}: ")), "")
    return why or f"{best}: it explains less than the law of what is named can be wrong by"


def _of_combinations(diagnosis):
    """What the best set of laws that was tried adds to those named, and what became of it."""
    named = {w.candidate.name for w in diagnosis.named}
    beside = [c for c in diagnosis.combinations if named < set(c.effects)]
    if not beside:
        return ""
    best = max(beside, key=lambda c: (c.objective is not None, c.gain))
    return f"{' + '.join(c for c in best.effects if c not in named)}: {best.outcome or NOT_REFITTED}"
