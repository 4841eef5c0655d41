"""The fit of a candidate from its begin to its end, or what went wrong; the best of several."""

from typing import NamedTuple

from pipeline.contract.errors import instead, sentence_of
from pipeline.inference.fitting.calibration import paired_anew
from pipeline.inference.fitting.fit_state import Fit, linearised
from pipeline.inference.fitting.least_squares import continued, iterated

#: iterations of a nominal model from a candidate's optimum before it is given up where it is still worse than before
_GIVEN_UP = 16
#: iterations after which the worse half of the candidates that have begun is given up
_LAP = 4


class Refitted(NamedTuple):
    """``fit`` of a candidate or None, a better Fit of the ``null`` from its optimum or None, what went wrong."""

    fit: Fit | None
    null: Fit | None
    failure: str


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
        return Refitted(fit, None, "its fit was given up, far from what others reach")
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
