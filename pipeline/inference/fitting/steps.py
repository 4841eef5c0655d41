"""One step of a least-squares fit: damped, with updated Jacobians, or along a bent valley.

Nielsen's damping: Madsen, Nielsen & Tingleff, Methods for Non-Linear Least Squares Problems, 2004.
"""

from dataclasses import replace

import numpy as np

from pipeline.inference.fitting.fit_state import refreshed, whitened
from pipeline.inference.priors import LATENT_LIMIT
from pipeline.inference.regular import solved

#: longest step of a latent coordinate in one iteration
_LONGEST = 1.5
#: part of a step at which its second derivative is taken; parts of the bent path that are tried
_PROBE, _PATH = 0.1, (1.0, 0.5, 0.25, 0.1, 0.03)
#: share of the promised decrease below which an updated Jacobian is replaced by differences
_TRUSTED = 0.25


def newton_step(gradient, hessian):
    """Gauss-Newton's step (k,), no coordinate of it too long."""
    step = solved(hessian, gradient)
    return step * min(1.0, _LONGEST / max(np.abs(step).max(initial=0.0), 1e-300))


def within(latent):
    """Latent coordinates (k,) within their bounds."""
    return np.clip(latent, -LATENT_LIMIT, LATENT_LIMIT)


def damped_step(problem, state, damping, growth, frugal):
    """The next state that lowers the objective, with the new damping; None where no step does."""
    (gradient, hessian), objective, tries = state.slopes, state.objective, 0
    while damping < 1e12:
        step = newton_step(gradient, hessian + damping * np.diag(np.diag(hessian)))
        latent = within(state.latent + step)
        residuals, _ = whitened(problem, state.noises, state.hypothesis, latent, state.runs)
        tries += 1
        if residuals is not None:
            gain = objective - sum(r @ r for r in residuals) - latent @ latent
            expected = step @ (2 * gradient - hessian @ step)
            if gain > 0:
                ratio = gain / expected if expected > 0 else 0.5
                moved = _moved(state, latent, residuals, tries)
                if ratio < _TRUSTED and not frugal:
                    moved = refreshed(problem, moved)
                return moved, min(damping * max(1 / 3, 1 - (2 * ratio - 1) ** 3), 1e6), 2.0
        if not state.fresh:
            break
        damping, growth = damping * growth, 2 * growth
    return None, damping, growth


def along_valley(problem, state):
    """The best state on the path that Gauss-Newton's step v begins, t v + t^2 a, bent as the prediction is.

    Geodesic acceleration a (Transtrum & Sethna, arXiv:1201.5885, 2012): along a narrow, bent valley a straight step
    leaves it at once, and a damped one hardly moves. ``state`` itself where none is lower.
    """
    gradient, hessian = state.slopes
    step, best, tries = newton_step(gradient, hessian), state, 1
    there, _ = whitened(problem, state.noises, state.hypothesis, within(state.latent + _PROBE * step), state.runs)
    if there is None:
        return state
    curved = [2 / _PROBE**2 * (before - after - _PROBE * (j @ step))
              for j, before, after in zip(state.jacobians, state.residuals, there, strict=True)]
    bend = -0.5 * solved(hessian, sum(j.T @ c for j, c in zip(state.jacobians, curved, strict=True)))
    for t in _PATH:
        latent = within(state.latent + t * step + t**2 * bend)
        residuals, _ = whitened(problem, state.noises, state.hypothesis, latent, state.runs)
        tries += 1
        if residuals is not None and sum(r @ r for r in residuals) + latent @ latent < best.objective:
            best = _moved(state, latent, residuals, tries)
        elif best is not state:
            break
    return best


def _moved(state, latent, residuals, tries):
    """State at ``latent`` with Jacobians that agree with the change of the prediction on the way there."""
    step = latent - state.latent
    felt = [step * state.hypothesis.moves(run.name) for run in state.runs]
    jacobians = tuple(j + np.outer(here - there - j @ way, way) / max(way @ way, 1e-300) for j, here, there, way in zip(
        state.jacobians, state.residuals, residuals, felt, strict=True))
    return replace(state, latent=latent, residuals=tuple(residuals), jacobians=jacobians, fresh=False,
                   evaluations=state.evaluations + tries)
