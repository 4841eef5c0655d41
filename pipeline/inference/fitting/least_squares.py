"""Maximum a posteriori by Levenberg-Marquardt in latent coordinates and whitened residuals.

In latent coordinates the prior is N(0, I), so that the objective is |r(u)|^2 + |u|^2 (Nielsen's damping: Madsen,
Nielsen & Tingleff, Methods for Non-Linear Least Squares Problems, 2004).
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from pipeline.contract.errors import BrakechainError, ConfigError, ConvergenceError
from pipeline.inference.fitting.effective_sample_size import tempering
from pipeline.inference.priors import LATENT_LIMIT

ITERATIONS = 60
#: forward-difference step in latent coordinates, and the widest one, which looks beyond kinks of the forward model
DIFFERENCE, _WIDEST = 1e-4, 1e-2
#: the expected decrease of the objective at which a fit counts as converged, tempered as the evidence will be
TOLERANCE = 1e-3
#: the same of features, as a share of the objective: far off, a small change of it says nothing
_SHARE = 1e-4
#: longest step of a latent coordinate in one iteration
_LONGEST = 1.5
#: where no step helps (rounding, kinks of the forward model) or iterations are used up, a fit counts as converged below
#: this: a posterior standard deviation from its linearised optimum
_STALLED = 1.0
#: a fit that used up its iterations goes on, for this fraction of them, where its predicted decrease is below _NEARLY
_NEARLY, _AGAIN = 30.0, 3
#: share of the tolerance below which the gain of a step is none
_LEAST = 0.1
#: so many times the decrease of the objective that its slope promises may a fit still come down
_HOPE = 10.0
#: noise powers beyond which a residual is far off
FAR = 100.0
#: iterations, and the share of the objective that is left after them where a fit crawls
_CRAWLING = ((5, 0.97), (8, 0.7))
#: iterations over which a fit is judged that has to come down to what others reach
_LATE = 4
#: share of the objective that a step of a rough fit must gain for another to follow
_ROUGHLY = 0.01
#: share of the promised decrease below which an updated Jacobian is replaced by differences
_TRUSTED = 0.25


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
        return float(gradient @ np.linalg.solve(hessian, gradient))

    def ended(self, explained, fraction):
        """Whether it converged, or its slopes promise less than a ``fraction`` of what it ``explained``."""
        return self.converged or self.promised <= fraction * explained

    def reaches_noise(self, uncertainty):
        """Whether no more is left than noise whose power has this relative ``uncertainty``."""
        return self.chi_square.sum() <= (1 + uncertainty) * self.counts.sum()

    def excluded(self, beyond):
        """A sentence for each parameter that lies ``beyond`` so many standard deviations of its prior."""
        return tuple(f"the prior of {p.name} excludes the data: they ask for {self.values[p.name]:.4g} {p.unit} or"
                     f" beyond, {abs(u):.1f} of its standard deviations away; check its unit, or widen the prior"
                     for p, u in zip(self.hypothesis.parameters, self.latent, strict=True) if abs(u) > beyond)

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
        return np.linalg.inv(_information(self.jacobians, _ones(self, weights)) + np.eye(len(self.latent)))

    def spread(self, weights=None):
        """{name: standard deviation} of the values, by the slope of each prior's transform."""
        return self.of_latent(np.sqrt(np.diag(self.covariance(weights))))

    def of_latent(self, std):
        """{name: standard deviation} of the values whose latent coordinates have the standard deviations ``std`` (k,).
        """
        low, high = self.hypothesis.values(self.latent - std), self.hypothesis.values(self.latent + std)
        return {name: 0.5 * (high[name] - low[name]) for name in low}


def whitened(problem, noises, hypothesis, latent, runs):
    """Whitened residuals [(m_r,)] at ``latent``; None where the forward model cannot, with its error."""
    values, residuals = hypothesis.values(latent), []
    for run, noise in zip(runs, noises, strict=True):
        try:
            predicted = np.asarray(problem.predict(hypothesis, values, run), float)
        except BrakechainError as error:
            return None, error
        if predicted.shape != run.samples.shape:
            raise ConfigError(f"prediction of run {run.name}", f"channels and samples {run.samples.shape}",
                              str(predicted.shape))
        if not np.isfinite(predicted).all():
            return None, ConvergenceError(f"prediction of run {run.name}", "finite numbers", "others")
        residuals.append(noise.whiten(run.samples - predicted))
    return residuals, None


def linearised(problem, noises, hypothesis, latent, runs, known=()):
    """Fit without iteration: residuals and Jacobians at ``latent``. Raises what the forward model raises.

    ``known`` [(m_r, i)]: the first columns of the Jacobians, taken as they are.
    """
    latent = np.asarray(latent, float)
    residuals, error = whitened(problem, noises, hypothesis, latent, runs)
    if error:
        raise error
    first = known[0].shape[1] if len(known) else 0
    jacobians, count = _jacobians(problem, noises, hypothesis, latent, residuals, runs, first)
    if first:
        jacobians = tuple(np.hstack(both) for both in zip(known, jacobians, strict=True))
    return Fit(hypothesis, tuple(runs), tuple(noises), latent, tuple(residuals), jacobians, False, 1 + count, not first)


def fit(problem, noises, hypothesis, start, runs, iterations=ITERATIONS):
    """Levenberg-Marquardt from latent ``start``; the Fit says whether it ``converged``.

    ``noises`` [Noise] belong to ``runs``. Raises what the forward model raises at the start.
    """
    return continued(problem, linearised(problem, noises, hypothesis, start, runs), iterations)


def continued(problem, state, iterations=ITERATIONS, enough=np.inf, patient=True):
    """The Fit after further iterations. Jacobians are updated by the secant (Broyden 1965) as long as that serves.

    A fit is given up, as it is, where its slope promises nothing that would bring its objective down to ``enough``, and
    without ``patient`` where features stay far off. Where its iterations do not end by themselves, central differences
    tell how far it is from its optimum: in a narrow valley the error of forward ones looks like a slope. From there a
    fit goes on that is nearly at its end.
    """
    state = iterated(problem, state, iterations, enough, patient)
    if state.converged or state.objective > enough:
        return state
    state = _at_central_differences(problem, state)
    if state.converged or state.promised > _NEARLY * _scale(state):
        return state
    state = iterated(problem, state, iterations // _AGAIN, enough, patient)
    return state if state.converged or state.objective > enough else _at_central_differences(problem, state)


def again(problem, state):
    """The Fit at its latent values, not converged and ``strict`` from there on, with differences taken anew over wide
    steps, which look beyond kinks."""
    return replace(_refreshed(problem, state, _WIDEST), converged=False, strict=True)


def beside(problem, state, kept, iterations=4):
    """The Fit after a few iterations over the parameters that are not ``kept`` (k,) as they are."""
    free = np.flatnonzero(~kept)
    for _ in range(iterations):
        gradient, hessian = state.slopes
        latent = state.latent.copy()
        step = np.linalg.solve(hessian[np.ix_(free, free)], gradient[free])
        step *= min(1.0, _LONGEST / max(np.abs(step).max(initial=0.0), 1e-300))
        latent[free] = np.clip(latent[free] + step, -LATENT_LIMIT, LATENT_LIMIT)
        moved = linearised(problem, state.noises, state.hypothesis, latent, state.runs)
        if moved.objective >= state.objective:
            break
        state = moved
    return state


def _at_central_differences(problem, state):
    """The Fit with central differences, converged where they show it at its optimum."""
    state = _refreshed(problem, state, central=True)
    return replace(state, converged=state.promised < _STALLED * _scale(state))


def iterated(problem, state, iterations, enough=np.inf, patient=True, rough=False, frugal=False):
    """The Fit after ``iterations``; where no step helps, differences are taken over wider steps before it ends.

    A ``rough`` one stops where updated Jacobians promise no more: its latent values are of use. A ``frugal`` one takes
    no differences at all: it stops where the Jacobians that it has, and their updates, lead no further.
    """
    damping, growth, width, objectives = 1e-3, 2.0, DIFFERENCE, []
    for _ in range(iterations):
        objectives.append(state.objective)
        if (not patient and _crawls(state, objectives)) or (rough and _settles(state, objectives)):
            break
        expected, scale = state.promised, _scale(state)
        if state.objective - _HOPE * expected > enough or _lags(objectives, enough):
            break
        if expected < _tolerance(state, scale, patient):
            if rough or frugal or state.fresh:
                return replace(state, converged=state.fresh and not rough)
            state = _refreshed(problem, state)
            continue
        moved, damping, growth = _step(problem, state, damping, growth, frugal)
        if moved is not None and state.objective - moved.objective > _LEAST * TOLERANCE * scale:
            state = moved
            continue
        if frugal:
            break
        if state.fresh and expected < _STALLED * scale:
            return replace(state, converged=True)
        if state.fresh and width >= _WIDEST:
            break
        width *= 10 if state.fresh else 1
        state, damping, growth = _refreshed(problem, state, width), 1e-3, 2.0
    return state


def _tolerance(state, scale, patient):
    return max(TOLERANCE * scale, 0.0 if patient or not state.unordered else _SHARE * state.objective)


def _crawls(state, objectives):
    """Whether features that are far off have stayed so: their hypothesis has no use for more iterations."""
    return (state.unordered and state.far
            and any(len(objectives) > n and objectives[-1] > fraction * objectives[-1 - n]
                    for n, fraction in _CRAWLING))


def _lags(objectives, enough):
    """Whether a fit that is above ``enough`` has come down so little of late that it will not get there."""
    if len(objectives) <= _LATE or objectives[-1] <= enough:
        return False
    return (objectives[-1 - _LATE] - objectives[-1]) * _HOPE < objectives[-1] - enough


def _settles(state, objectives):
    """Whether the last step gained so little that a rough fit may end."""
    return not state.fresh and len(objectives) > 1 and objectives[-1] > (1 - _ROUGHLY) * objectives[-2]


def orthogonal(residual, jacobian, prior_precision=None):
    """d = (I - J (J'J + P^-1)^-1 J') r: what parameters cannot explain of whitened (m, ...) residuals.

    ``prior_precision`` (k, k), default I (latent coordinates). d = C^-1 r with C = I + J P J', so that g'd over
    sqrt(g'C^-1 g) is standard normal for every direction g where nothing else is missing.
    """
    precision = np.eye(jacobian.shape[1]) if prior_precision is None else prior_precision
    return residual - jacobian @ np.linalg.solve(jacobian.T @ jacobian + precision, jacobian.T @ residual)


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


def _scale(state):
    """Objective per unit of log evidence (see ``effective.tempering``); 1 of a strict fit."""
    return 1.0 if state.strict else 1 / max(state.weights.max(), 1e-12)


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


def _refreshed(problem, state, width=DIFFERENCE, central=False):
    jacobians, count = _jacobians(problem, state.noises, state.hypothesis, state.latent, state.residuals, state.runs,
                                  width=width, central=central)
    return replace(state, jacobians=jacobians, fresh=True, evaluations=state.evaluations + count)


def _step(problem, state, damping, growth, frugal):
    """The next state that lowers the objective, with the new damping; None where no step does."""
    (gradient, hessian), objective, tries = state.slopes, state.objective, 0
    while damping < 1e12:
        step = np.linalg.solve(hessian + damping * np.diag(np.diag(hessian)), gradient)
        step *= min(1.0, _LONGEST / max(np.abs(step).max(), 1e-300))
        latent = np.clip(state.latent + step, -LATENT_LIMIT, LATENT_LIMIT)
        residuals, _ = whitened(problem, state.noises, state.hypothesis, latent, state.runs)
        tries += 1
        if residuals is not None:
            gain = objective - sum(r @ r for r in residuals) - latent @ latent
            expected = step @ (2 * gradient - hessian @ step)
            if gain > 0:
                ratio = gain / expected if expected > 0 else 0.5
                moved = _moved(state, latent, residuals, tries)
                if ratio < _TRUSTED and not frugal:
                    moved = _refreshed(problem, moved)
                return moved, min(damping * max(1 / 3, 1 - (2 * ratio - 1) ** 3), 1e6), 2.0
        if not state.fresh:
            break
        damping, growth = damping * growth, 2 * growth
    return None, damping, growth


def _moved(state, latent, residuals, tries):
    """State at ``latent`` with Jacobians that agree with the change of the prediction on the way there."""
    step = latent - state.latent
    felt = [step * state.hypothesis.moves(run.name) for run in state.runs]
    jacobians = tuple(j + np.outer(here - there - j @ way, way) / max(way @ way, 1e-300) for j, here, there, way in zip(
        state.jacobians, state.residuals, residuals, felt, strict=True))
    return replace(state, latent=latent, residuals=tuple(residuals), jacobians=jacobians, fresh=False,
                   evaluations=state.evaluations + tries)
