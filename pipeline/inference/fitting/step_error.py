"""The error of the time step of leading candidates, by half the step; candidates are refined, not refused, for theirs.

Of order 2 half the step changes three quarters of the error of the whole one. Where that matters against noise, the
hypothesis steps half as far from then on (``Hypothesis.halvings``), and is refitted from where it is. What is left is
carried in the error budget (``Fit.step_error``).

Fits go most of their way with steps as long as the nominal model allows (``longest``); what leads, and the nominal
model, is predicted with steps as stated before anything is decided, and goes on where that matters (``as_stated``).
"""

from contextlib import suppress
from dataclasses import replace

import numpy as np

from pipeline.contract.errors import BrakechainError
from pipeline.inference.fitting.fit_state import whitened
from pipeline.inference.fitting.least_squares import continued

#: times that a step is doubled at most
_DOUBLED = 3
#: standard deviations by which doubled steps may shift a value that is not fitted anew with stated ones
_SHIFTED = 0.1


def as_stated(problem, rules, fit):
    """The Fit at steps as stated, where they were longer, gone on from where it is if that matters by RefitRules
    ``rules``. Raises what the forward model raises."""
    if fit.hypothesis.halvings >= 0:
        return fit
    stated = _stepped(problem, fit, 0)
    error, shift = changed(fit, stated)
    if error <= _most(rules, fit) and shift <= _SHIFTED:
        return replace(stated, converged=fit.converged)
    return continued(problem, stated, patient=False)


def _most(rules, fit):
    """Largest squared change by the step that does not matter."""
    return rules.step_error * max(fit.counts.sum(), fit.chi_square.sum())


def halved(problem, fit):
    """The Fit as it stands, its residuals predicted with half the time step. Raises what the forward model raises."""
    return _stepped(problem, fit, fit.hypothesis.halvings + 1)


def _stepped(problem, fit, halvings):
    hypothesis = replace(fit.hypothesis, halvings=halvings)
    residuals, error = whitened(problem, fit.noises, hypothesis, fit.latent, fit.runs)
    if error:
        raise error
    return replace(fit, hypothesis=hypothesis, residuals=tuple(residuals), converged=False, fresh=False, step_error=0.0)


def longest(problem, noises, rules):
    """Halvings, 0 or below as steps are doubled, at which the nominal model at its given values predicts the fitted
    runs as it does with the stated step, by RefitRules ``rules``; 0 where it fails at that."""
    nominal, latent = problem.nominal, problem.nominal.nominal

    def predicted(halvings):
        return whitened(problem, noises, replace(nominal, halvings=halvings), latent, problem.training)

    stated, error = predicted(0)
    for halvings in range(-_DOUBLED, 0) if not error else ():
        doubled, error = predicted(halvings)
        change = np.inf if error else sum(np.sum((a - b)**2) for a, b in zip(stated, doubled, strict=True))
        if change <= rules.step_error * sum(len(r) for r in stated):
            return halvings
    return 0


def changed(fit, finer):
    """(squared change of the residuals, largest shift of a value in its standard deviations) from a Fit to a finer one.
    """
    change = [after - before for before, after in zip(fit.residuals, finer.residuals, strict=True)]
    pull = sum(j.T @ c for j, c in zip(fit.jacobians, change, strict=True))
    shift = abs(fit.covariance() @ pull) / np.sqrt(np.diag(fit.covariance(fit.weights)))
    return float(sum(c @ c for c in change)), float(shift.max(initial=0.0))


def refined(problem, rules, fit):
    """The Fit whose time step is fine enough by RefitRules ``rules``, with what is left as its ``step_error``.

    Where the forward model fails at a finer step, or halvings are used up, the last one.
    """
    with suppress(BrakechainError):
        fit = as_stated(problem, rules, fit)
    for _ in range(rules.halvings):
        try:
            finer = halved(problem, fit)
            error, shift = changed(fit, finer)
            fit = replace(fit, step_error=error)
            if error <= _most(rules, fit) and shift <= rules.step_shift:
                return fit
            fit = replace(continued(problem, finer, patient=False), step_error=error)
        except BrakechainError:
            break
    return fit
