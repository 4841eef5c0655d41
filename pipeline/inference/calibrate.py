"""Calibration: maximum a posteriori by Levenberg-Marquardt in latent coordinates and whitened residuals.

In latent coordinates the prior is N(0, I), so that the objective is |r(u)|^2 + |u|^2 (Nielsen's damping: Madsen,
Nielsen & Tingleff, Methods for Non-Linear Least Squares Problems, 2004).
"""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.contract.errors import BrakechainError, ConfigError, ConvergenceError
from pipeline.inference.priors import LATENT_LIMIT

ITERATIONS = 60
#: forward-difference step in latent coordinates
DIFFERENCE = 1e-4
#: the expected decrease of the objective at which a fit counts as converged, per unit of mean square residual
TOLERANCE = 1e-3
#: longest step of a latent coordinate in one iteration
_LONGEST = 1.5
#: where no step helps (rounding, kinks of the forward model) a fit counts as converged below this: half a posterior
#: standard deviation from its linearised optimum
_STALLED = 0.25
#: iterations from every start before only the best goes on
_TRIAL = 8
#: shares of the runs that are fitted first where the residual is beyond _FAR noise powers: over a short horizon the
#: phase of a nonlinear motion cannot slip, so that the optimum is reached from far away
_HORIZONS, _FAR = (0.08, 0.3), 100.0


@dataclass(frozen=True)
class Fit:
    """A hypothesis at latent coordinates ``latent`` (k,) against runs.

    Per run: whitened ``residuals`` (m_r,) = observed less predicted and ``jacobians`` (m_r, k) of the prediction.
    ``converged``: whether the iteration reached its tolerance; ``evaluations`` counts forward runs.
    """

    hypothesis: object
    runs: tuple
    noises: tuple
    latent: np.ndarray
    residuals: tuple
    jacobians: tuple
    converged: bool
    evaluations: int

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

    def covariance(self, weights=None):
        """Posterior covariance (k, k) of the latent coordinates, runs weighted (see ``effective.tempering``)."""
        return np.linalg.inv(_information(self.jacobians, _ones(self, weights)) + np.eye(len(self.latent)))

    def spread(self, weights=None):
        """{name: standard deviation} of the values, by the slope of each prior's transform."""
        std = np.sqrt(np.diag(self.covariance(weights)))
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


def linearised(problem, noises, hypothesis, latent, runs):
    """Fit without iteration: residuals and Jacobians at ``latent``. Raises what the forward model raises."""
    latent = np.asarray(latent, float)
    residuals, error = whitened(problem, noises, hypothesis, latent, runs)
    if error:
        raise error
    jacobians, count = _jacobians(problem, noises, hypothesis, latent, residuals, runs)
    return Fit(hypothesis, tuple(runs), tuple(noises), latent, tuple(residuals), jacobians, False, 1 + count)


def fit(problem, noises, hypothesis, start, runs, iterations=ITERATIONS):
    """Levenberg-Marquardt from latent ``start``; the Fit says whether it ``converged``.

    ``noises`` [Noise] belong to ``runs``. Raises what the forward model raises at the start.
    """
    return _continued(problem, linearised(problem, noises, hypothesis, start, runs), iterations)


def calibrate(problem, noises, hypothesis, starts, runs):
    """The best of several fits. Raises ConvergenceError where none converged, telling what stopped them.

    A few iterations are made from each start; then the best goes on, the next best only where it does not converge.
    """
    begun, reasons = [], []
    for start in starts:
        try:
            near = _approached(problem, noises, hypothesis, start, runs)
            begun.append(fit(problem, noises, hypothesis, near, runs, _TRIAL))
        except BrakechainError as error:
            reasons.append(str(error))
    for state in sorted(begun, key=lambda f: f.objective):
        best = state if state.converged else _continued(problem, state, ITERATIONS)
        if best.converged:
            break
        reasons.append(f"not converged after {best.evaluations} forward runs")
    else:
        raise ConvergenceError(f"calibration of {hypothesis.name}", "a fit that converges from one of its starts",
                               "; ".join(dict.fromkeys(reasons)), "check the nominal values and priors")
    return best


def _approached(problem, noises, hypothesis, start, runs):
    """Latent coordinates (k,) nearer to the optimum than ``start``: fits over rising horizons where it is far off."""
    if not all(noise.ordered for noise in noises):
        return start
    residuals, error = whitened(problem, noises, hypothesis, start, runs)
    if error:
        raise error
    if np.mean(np.concatenate(residuals) ** 2) < _FAR:
        return start
    for share in _HORIZONS:
        start = fit(problem, [noise.until(share) for noise in noises], hypothesis, start, runs, _TRIAL).latent
    return start


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
    weights = np.ones(len(jacobians)) if weights is None else weights
    return sum(w * (j.T @ j) for w, j in zip(weights, jacobians, strict=True))


def _scale(state):
    return max(1.0, state.chi_square.sum() / max(state.counts.sum(), 1))


def _jacobians(problem, noises, hypothesis, latent, residuals, runs):
    """Forward differences (backward at the upper limit and where the forward model fails ahead)."""
    columns = []
    for k in range(len(latent)):
        for step in (DIFFERENCE, -DIFFERENCE):
            if abs(latent[k] + step) > LATENT_LIMIT:
                continue
            moved, error = whitened(problem, noises, hypothesis, latent + step * (np.arange(len(latent)) == k), runs)
            if moved is not None:
                break
        if moved is None:
            raise error
        columns.append([(before - after) / step for before, after in zip(residuals, moved, strict=True)])
    jacobians = tuple(np.array([column[i] for column in columns]).reshape(len(latent), len(residuals[i])).T
                      for i in range(len(residuals)))
    return jacobians, len(latent)


def _continued(problem, state, iterations):
    damping, growth = 1e-3, 2.0
    for _ in range(iterations):
        gradient = sum(j.T @ r for j, r in zip(state.jacobians, state.residuals, strict=True)) - state.latent
        gradient[(np.abs(state.latent) >= LATENT_LIMIT) & (gradient * state.latent > 0)] = 0.0
        hessian = _information(state.jacobians) + np.eye(len(state.latent))
        expected, scale = gradient @ np.linalg.solve(hessian, gradient), _scale(state)
        if expected < TOLERANCE * scale:
            return replace(state, converged=True)
        moved, damping, growth = _step(problem, state, gradient, hessian, damping, growth)
        if moved is None:
            return replace(state, converged=bool(expected < _STALLED * scale))
        state = moved
    return state


def _step(problem, state, gradient, hessian, damping, growth):
    """The next state that lowers the objective, with the new damping; None where no step does."""
    objective = state.objective
    while damping < 1e12:
        step = np.linalg.solve(hessian + damping * np.diag(np.diag(hessian)), gradient)
        step *= min(1.0, _LONGEST / max(np.abs(step).max(), 1e-300))
        latent = np.clip(state.latent + step, -LATENT_LIMIT, LATENT_LIMIT)
        residuals, _ = whitened(problem, state.noises, state.hypothesis, latent, state.runs)
        if residuals is not None:
            gain = objective - sum(r @ r for r in residuals) - latent @ latent
            promised = step @ (2 * gradient - hessian @ step)
            if gain > 0:
                jacobians, count = _jacobians(problem, state.noises, state.hypothesis, latent, residuals, state.runs)
                damping *= max(1 / 3, 1 - (2 * gain / max(promised, 1e-300) - 1) ** 3) if promised > 0 else 1.0
                return replace(state, latent=latent, residuals=tuple(residuals), jacobians=jacobians,
                               evaluations=state.evaluations + 1 + count), min(damping, 1e6), 2.0
        damping, growth = damping * growth, 2 * growth
    return None, damping, growth
