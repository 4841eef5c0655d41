"""The fit of a candidate from its begin to its end, or what went wrong; the best of several; all of a catalogue."""

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from pipeline.contract.errors import instead, sentence_of
from pipeline.inference.fitting.calibration import Calibration, paired_anew
from pipeline.inference.fitting.fit_state import Fit, linearised
from pipeline.inference.fitting.least_squares import continued, iterated
from pipeline.inference.fitting.step_error import as_stated

#: iterations of a nominal model from a candidate's optimum before it is given up where it is still worse than before
_GIVEN_UP = 16
#: iterations after which the worse half of the candidates that have begun is given up
_LAP = 4
#: share of its objective to which a nominal model comes down from the optimum of a candidate, so that all begins anew
OVERTAKEN = 0.5


class Refitted(NamedTuple):
    """``fit`` of a candidate or None, a better Fit of the ``null`` from its optimum or None, what went wrong."""

    fit: Fit | None
    null: Fit | None
    failure: str


@dataclass(frozen=True)
class Refits:
    """Third step: ``results`` {index: Refitted} of candidates, beside the Calibration as their optima improved it.

    ``directions`` of all candidates at its null; ``refitter``, a Refitter, made the results.
    """

    calibration: Calibration
    directions: tuple
    results: dict
    refitter: Any

    def at_noise(self, factor):
        """These Refits, every value as it is, against noise ``factor`` times as large."""
        calibration = self.calibration
        budget = {name: noise.scaled(factor) for name, noise in calibration.budget.items()}
        results = {i: r._replace(fit=r.fit and r.fit.at_noise(factor)) for i, r in self.results.items()}
        return replace(self, calibration=replace(calibration, budget=budget, null=calibration.null.at_noise(factor)),
                       directions=tuple(d.at_noise(factor) for d in self.directions), results=results)

    def as_stated(self):
        """These Refits with the null at steps as stated, as the leading results are."""
        null = as_stated(self.calibration.problem, self.refitter.rules.refit, self.calibration.null)
        return replace(self, calibration=replace(self.calibration, null=null))

    def overtake(self, calibration):
        """Whether the null of a Calibration, from which they began, was far from the best."""
        return self.calibration.null.objective < OVERTAKEN * calibration.null.objective

    def begun_anew(self, starts):
        """These Refits with fits begun at the latent values ``starts`` {index: (k,)}, where they are better."""
        return replace(self, results=self.refitter.better(self.results, starts))


#: of a candidate that could not even begin
NOT_BEGUN = Refitted(None, None, "its fit could not begin")


def leader(results):
    """Index of the lowest objective, or None."""
    objectives = {i: r.fit.objective for i, r in results.items() if r.fit is not None}
    return min(objectives, key=objectives.get, default=None)


def lowest(results, others):
    """{index: Refitted} of both, each of the lower objective."""
    def lower(fit, other):
        return fit is not None and (other is None or fit.objective < other.objective)

    return {**results, **{i: r for i, r in others.items() if i not in results or lower(r.fit, results[i].fit)}}


@instead(lambda error, problem, enough, fit, **_: fit)
def advanced(problem, enough, fit, iterations=_LAP):
    """A Fit after a few more iterations, as far as its forward model goes; as it is where it cannot come to ``enough``.
    """
    return fit if fit.converged else iterated(problem, fit, iterations, enough, patient=False)


@instead(lambda error, problem, null, enough, rules, begin: Refitted(begin, None, sentence_of(error)))
def finished(problem, null, enough, rules, begin):
    """Refitted of a candidate that has begun; where its forward model fails on the way, of its begin."""
    fit = begin if begin.converged else continued(problem, begin, enough=enough, patient=False)
    fit = paired_anew(problem, fit, rules.calibration)
    if not fit.converged and fit.objective > enough:
        return Refitted(fit, None, "its fit was given up, far from what others reach or would matter")
    failure = "" if fit.converged else f"its fit had not converged after {fit.evaluations} predictions"
    return Refitted(fit, _null_again(problem, null, fit, rules.refit), failure)


@instead(lambda *_: None)
def _null_again(problem, null, fit, rules):
    """A better Fit of the nominal model, reached from the optimum of a candidate that fits better than it, or None."""
    if fit.objective > null.objective - rules.better_by:
        return None
    size = len(null.latent)
    again = linearised(problem, null.noises, problem.nominal, fit.latent[:size], null.runs,
                       [j[:, :size] for j in fit.jacobians])
    again = continued(problem, again, _GIVEN_UP, null.objective, patient=False)
    if again.objective >= null.objective:
        return None
    return again if again.converged else continued(problem, again, patient=False)
