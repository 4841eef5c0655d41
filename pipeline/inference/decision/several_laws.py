"""Whether each of several laws is needed beside the others: by evidence, and on runs that were not fitted."""

from dataclasses import dataclass

import numpy as np

from pipeline.inference.decision.evidence import evidence
from pipeline.inference.decision.held_out import gain, held_out_residuals, judged
from pipeline.inference.fitting.least_squares import continued, linearised
from pipeline.inference.problem import Hypothesis


@dataclass(frozen=True)
class Needed:
    """What a member of a set of laws is worth: ``evidence_gain`` (nat), its ``share`` of what the set explains of the
    objective, and ``errors``: its gain on runs not fitted in standard errors, None without any."""

    name: str
    evidence_gain: float
    share: float
    errors: float | None

    def objections(self, rules):
        """Why the set can do without it, in words."""
        reasons = []
        if self.evidence_gain < rules.evidence_gain:
            reasons.append(f"{self.name} adds an evidence of {self.evidence_gain:.1f} nat")
        if self.share < rules.second_share:
            reasons.append(f"{self.name} gives {self.share:.2%} of what the laws explain together, which an error of the"
                           " others may be")
        if self.errors is not None and self.errors < rules.gain_errors:
            reasons.append(f"the gain by {self.name} on runs that were not fitted is {self.errors:.1f} standard errors")
        return tuple(reasons)


def needed(problem, budget, null, whole, effect, rules):
    """Needed of one ``effect`` (name, place) beside the others of the Fit ``whole``; ``null`` Fit of the nominal model.

    The others are fitted once more without it. Raises what the forward model raises.
    """
    without = _without(problem, whole, effect)
    weights = whole.weights
    with_it, other = evidence(whole, weights), evidence(without, weights)
    runs, errors = problem.held_out, None
    if runs:
        noises, share = tuple(budget[run.name] for run in runs), rules.start_share
        gained = gain(judged(null.hypothesis, noises, runs, share),
                      *(held_out_residuals(problem, noises, fit, runs, share) for fit in (without, whole)))
        errors = gained.errors_with(with_it.left_out - other.left_out)
    return Needed(" at ".join(effect), with_it.log_evidence - other.log_evidence,
                  whole.betters(without) / max(whole.betters(null), 1e-300), errors)


def _without(problem, whole, effect):
    """Fit of the hypothesis of the Fit ``whole`` without one ``effect``, from the values that it has there."""
    hypothesis, prefix = whole.hypothesis, f"{'@'.join(effect)}."
    kept = np.array([not p.name.startswith(prefix) for p in hypothesis.parameters])
    effects = tuple(pair for pair in hypothesis.effects if pair != effect)
    less = Hypothesis(" + ".join(" at ".join(pair) for pair in effects), effects,
                      tuple(p for p, k in zip(hypothesis.parameters, kept, strict=True) if k))
    begin = linearised(problem, whole.noises, less, whole.latent[kept], whole.runs)
    return continued(problem, begin, patient=False)
