"""A hypothesis at one point: latent coordinates, whitened residuals, Jacobians, and what follows from them.

In latent coordinates the prior is N(0, I), so that the objective is |r(u)|^2 + |u|^2.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy

from pipeline.contract.errors import BrakechainError, ConfigError, ConvergenceError, sentence_of
from pipeline.inference.fitting.effective_sample_size import tempering
from pipeline.inference.priors import LATENT_LIMIT
from pipeline.inference.regular import inverse, solved
from pipeline.inference.time_budget import TimeSpentError, spent

#: forward-difference step in latent coordinates
DIFFERENCE = 1e-4
#: predictions beyond which squares are no numbers any more
_LARGEST = 1e100
#: times that steps which do not settle are halved, from those of the bench
_HALVED = 2
#: noise powers beyond which a residual is far off
FAR = 100.0


@dataclass(frozen=True)
class Fit:
    """A hypothesis at latent coordinates ``latent`` (k,) against runs.

    Per run: whitened ``residuals`` (m_r,) = observed less predicted and ``jacobians`` (m_r, k) of the prediction.
    ``converged``: whether the iteration reached its tolerance; ``evaluations`` counts predictions of all runs;
    ``fresh``: whether the Jacobians are differences taken here, not updates of earlier ones. ``step_error``: what half
    the time step would change in the residuals, squared and summed; 0 where nobody has looked. ``strict``: whether it
    ends by what its samples say, all of them, and not by what evidence makes of them.
    """

    hypothesis: object
    runs: tuple
    noises: tuple
    latent: np.ndarray
    residuals: tuple
    jacobians: tuple
    converged: bool
    evaluations: int
    fresh: bool = True
    step_error: float = 0.0
    strict: bool = False

    @property
    def values(self):
        return self.hypothesis.values(self.latent)

    @property
    def chi_square(self):
        """Sum of squared whitened residuals of each run (runs,)."""
        return np.array([r @ r for r in self.residuals])

    @property
    def counts(self):
        return np.array([len(r) for r in self.residuals])

    @property
    def objective(self):
        return float(self.chi_square.sum() + self.latent @ self.latent)

    @property
    def unordered(self):
        """Whether what is fitted has no order in time: features, not samples."""
        return not all(noise.ordered for noise in self.noises)

    @property
    def far(self):
        """Whether far more than noise is left."""
        return bool(self.chi_square.sum() > FAR * self.counts.sum())

    @cached_property
    def weights(self):
        """Weights (runs,) of the log-likelihoods of the runs by what this fit leaves (see ``tempering``)."""
        return tempering(self.noises, self.residuals)

    @cached_property
    def slopes(self):
        """Descent (k,), the negative gradient, and Gauss-Newton's Hessian (k, k) of half the objective; bounds that
        hold do not take part."""
        gradient = sum(j.T @ r for j, r in zip(self.jacobians, self.residuals, strict=True)) - self.latent
        hessian = _information(self.jacobians) + np.eye(len(self.latent))
        held = (np.abs(self.latent) >= LATENT_LIMIT) & (gradient * self.latent > 0)
        gradient[held] = hessian[held] = hessian[:, held] = 0.0
        hessian[held, held] = 1.0
        return gradient, hessian

    @cached_property
    def promised(self):
        """Decrease of the objective that the slopes still promise."""
        gradient, hessian = self.slopes
        return float(gradient @ solved(hessian, gradient))

    def ended(self, explained, fraction):
        """Whether it converged, or its slopes promise less than a ``fraction`` of what it ``explained``."""
        return self.converged or self.promised <= fraction * explained

    def reaches_noise(self, uncertainty):
        """Whether no more is left than noise whose power has this relative ``uncertainty``."""
        return self.chi_square.sum() <= (1 + uncertainty) * self.counts.sum()

    def excluded(self, beyond, among=None):
        """A sentence for each parameter, of all or of those of the indices ``among``, that lies ``beyond`` so many
        standard deviations of its prior."""
        return tuple(f"the prior of {p.name} excludes the data: they ask for {self.values[p.name]:.4g} {p.unit} or"
                     f" beyond, {abs(u):.1f} of its standard deviations away; check its unit, or widen the prior"
                     for k, (p, u) in enumerate(zip(self.hypothesis.parameters, self.latent, strict=True))
                     if abs(u) > beyond and (among is None or k in among))

    @property
    def at_limits(self):
        """Whether a value is as far out as any may be."""
        return bool((abs(self.latent) >= LATENT_LIMIT).any())

    def at_noise(self, factor):
        """The same values against noise ``factor`` times as large."""
        return replace(self, noises=tuple(noise.scaled(factor) for noise in self.noises),
                       residuals=tuple(r / factor for r in self.residuals),
                       jacobians=tuple(j / factor for j in self.jacobians), step_error=self.step_error / factor**2)

    def explains(self, null):
        """Squared error of the Fit ``null`` that this one explains."""
        return null.chi_square.sum() - self.chi_square.sum()

    def betters(self, null):
        """Decrease of the objective from the Fit ``null`` to this one."""
        return null.objective - self.objective

    def covariance(self, weights=None):
        """Posterior covariance (k, k) of the latent coordinates, runs weighted (see ``effective.tempering``)."""
        return inverse(self.precision(weights))

    def precision(self, weights=None):
        """The inverse of ``covariance``."""
        return _information(self.jacobians, _ones(self, weights)) + np.eye(len(self.latent))

    def spread(self, weights=None):
        """{name: standard deviation} of the values, by the slope of each prior's transform."""
        return self.of_latent(np.sqrt(np.diag(self.covariance(weights))))

    def from_none(self, parameters, weights=None):
        """[Distance of each of the ``parameters`` of effects from its null, in standard deviations]."""
        std = self.spread(weights)
        return [abs(self.values[p.name] - p.null) / max(std[p.name], 1e-300) for p in parameters]

    def of_latent(self, std):
        """{name: standard deviation} of the values whose latent coordinates have the standard deviations ``std`` (k,).
        """
        low, high = self.hypothesis.values(self.latent - std), self.hypothesis.values(self.latent + std)
        return {name: 0.5 * abs(high[name] - low[name]) for name in low}


def nominal_p(fit, nominal):
    """p-value of the values of all runs, without effects, that a Fit asks for, under their priors; ``nominal``: the
    nominal hypothesis, whose parameters come first."""
    shared = [k for k, p in enumerate(nominal.parameters) if not p.run and p.null is None and not p.discrete]
    return float(scipy.stats.chi2.sf(np.sum(fit.latent[shared]**2), len(shared))) if shared else 1.0


def whitened(problem, noises, hypothesis, latent, runs):
    """Whitened residuals [(m_r,)] at ``latent``; None where the forward model cannot, or no time is left, with the
    error."""
    values, residuals = hypothesis.values(latent), []
    for run, noise in zip(runs, noises, strict=True):
        if spent():
            return None, TimeSpentError()
        try:
            predicted = np.asarray(problem.predict(hypothesis, hypothesis.in_run(values, run.name), run), float)
        except BrakechainError as error:
            return None, error
        except Exception as error:      # what one hypothesis cannot predict says nothing of others
            return None, ConvergenceError(f"prediction of run {run.name}: {sentence_of(error)}")
        if predicted.shape != run.samples.shape:
            raise ConfigError(f"prediction of run {run.name}", f"channels and samples {run.samples.shape}",
                              str(predicted.shape))
        if not (np.abs(predicted) < _LARGEST).all():
            return None, ConvergenceError(f"prediction of run {run.name}", "finite numbers", "others")
        residuals.append(noise.whiten(run.samples - predicted))
    return residuals, None


def linearised(problem, noises, hypothesis, latent, runs, known=()):
    """Fit without iteration: residuals and Jacobians at ``latent``; with shorter steps where those of the forward model
    do not settle. Raises what the forward model raises.

    ``known`` [(m_r, i)]: the first columns of the Jacobians, taken as they are.
    """
    latent = np.asarray(latent, float)
    try:
        return _linearised(problem, noises, hypothesis, latent, runs, known)
    except BrakechainError as error:
        if not worth_halving(error, hypothesis):
            raise
    return linearised(problem, noises, replace(hypothesis, halvings=hypothesis.halvings + 1), latent, runs, known)


def worth_halving(error, hypothesis):
    """Whether a hypothesis whose forward model failed with an ``error`` is worth a try with steps half as long."""
    return error.shorter_step and hypothesis.halvings < _HALVED


def _linearised(problem, noises, hypothesis, latent, runs, known):
    residuals, error = whitened(problem, noises, hypothesis, latent, runs)
    if error:
        raise error
    first = known[0].shape[1] if len(known) else 0
    jacobians, count = _jacobians(problem, noises, hypothesis, latent, residuals, runs, first)
    if first:
        jacobians = tuple(np.hstack(both) for both in zip(known, jacobians, strict=True))
    return Fit(hypothesis, tuple(runs), tuple(noises), latent, tuple(residuals), jacobians, False, 1 + count, not first)


def orthogonal(residual, jacobian, prior_precision=None):
    """d = (I - J (J'J + P^-1)^-1 J') r: what parameters cannot explain of whitened (m, ...) residuals.

    ``prior_precision`` (k, k), default I (latent coordinates). d = C^-1 r with C = I + J P J', so that g'd over
    sqrt(g'C^-1 g) is standard normal for every direction g where nothing else is missing.
    """
    precision = np.eye(jacobian.shape[1]) if prior_precision is None else prior_precision
    return residual - jacobian @ solved(jacobian.T @ jacobian + precision, jacobian.T @ residual)


def from_prior_mean(fit):
    """Linearised whitened residuals [(m_r,)] at latent zero: r + J u."""
    return [r + j @ fit.latent for r, j in zip(fit.residuals, fit.jacobians, strict=True)]


def _ones(fit, weights):
    return np.ones(len(fit.residuals)) if weights is None else np.asarray(weights, float)


def _information(jacobians, weights=None):
    """Weighted J'J (k, k) of all runs; most columns of parameters of one run alone are zero in the others."""
    total = np.zeros((jacobians[0].shape[1],) * 2)
    for weight, jacobian in zip(np.ones(len(jacobians)) if weights is None else weights, jacobians, strict=True):
        moving = np.flatnonzero(jacobian.any(axis=0))
        part = jacobian if len(moving) == len(total) else jacobian[:, moving]
        total[np.ix_(moving, moving)] += weight * (part.T @ part)
    return total


def _jacobians(problem, noises, hypothesis, latent, residuals, runs, first=0, width=DIFFERENCE, central=False):
    """Forward differences (backward at the upper limit and where the forward model fails ahead) from ``first`` on.

    ``central``: the mean of both. Parameters of one run alone are moved in their runs at once, as no other is changed.
    """
    columns = [np.zeros((len(latent) - first, len(residual))) for residual in residuals]
    count = 0
    for moved in _moved_together(hypothesis, runs, first):
        (members, chosen), slopes = zip(*moved, strict=True), []
        of, among, under = ([every[i] for i in members] for every in (residuals, runs, noises))
        chosen = list(chosen)
        for side in (width, -width):
            if slopes and not central:
                break
            ahead, steps = latent.copy(), np.where(np.abs(latent[chosen] + side) > LATENT_LIMIT, -side, side)
            ahead[chosen] += steps
            there, error = whitened(problem, under, hypothesis, ahead, among)
            count += len(moved) / len(runs)
            if there is not None:
                slopes.append([(before - after) / step for before, after, step in zip(of, there, steps, strict=True)])
        if not slopes:
            raise error
        for (i, k), *sides in zip(moved, *slopes, strict=True):
            columns[i][k - first] = np.mean(sides, axis=0)
    return tuple(column.T for column in columns), int(np.ceil(count))


def _moved_together(hypothesis, runs, first=0):
    """[[(index of a run, index of a parameter that changes it)]] from parameter ``first`` on, one item a prediction."""
    shared = hypothesis.shared
    together = [[(i, k) for i in range(len(runs))] for k in range(first, len(shared)) if shared[k]]
    members = [(i, [k for k in range(first, len(shared)) if hypothesis.parameters[k].run == run.name])
               for i, run in enumerate(runs)]
    for position in range(max((len(each) for _, each in members), default=0)):
        together.append([(i, each[position]) for i, each in members if position < len(each)])
    return together


def refreshed(problem, state, width=DIFFERENCE, central=False):
    jacobians, count = _jacobians(problem, state.noises, state.hypothesis, state.latent, state.residuals, state.runs,
                                  width=width, central=central)
    return replace(state, jacobians=jacobians, fresh=True, evaluations=state.evaluations + count)
