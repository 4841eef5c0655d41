"""Newton's method for forces in balance: a step that does not shrink what is missing is halved until it does."""

from typing import NamedTuple

import numpy as np


class Balance(NamedTuple):
    """Where Newton's method ended: ``unknown`` (n,), the next ``step`` (n,) from there, not taken, and its size
    ``error`` (infinite where the derivative is singular)."""

    unknown: np.ndarray
    step: np.ndarray
    error: float


def damped_newton(equation, start, size, tolerance, steps, halvings):
    """Balance of ``equation`` from ``start`` (n,): converged where its error is at most ``tolerance``.

    ``equation(unknown)`` gives what is missing (n,), its derivative (n, n), and whatever else ``size(step, ...)`` asks
    for to tell how much a step would change. After ``steps`` steps, each halved up to ``halvings`` times, it gives up.
    """
    unknown, (miss, derivative, *more) = start, equation(start)
    for _ in range(steps):
        try:
            step = np.linalg.solve(derivative, miss)
        except np.linalg.LinAlgError:
            return Balance(unknown, np.zeros_like(unknown), np.inf)
        error = size(step, *more)
        if error <= tolerance:
            break
        for length in 0.5 ** np.arange(halvings):
            trial = equation(unknown - length * step)
            if np.linalg.norm(trial[0]) < np.linalg.norm(miss):
                break
        unknown, (miss, derivative, *more) = unknown - length * step, trial
    return Balance(unknown, step, error)
