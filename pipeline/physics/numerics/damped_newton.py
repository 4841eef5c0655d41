"""Newton's method for forces in balance: a step that does not shrink what is missing is halved until it does."""

from typing import NamedTuple

import numpy as np

#: singular values below this share of the largest are none; error of a solve, relative, from which it tells nothing
_SINGULAR, _UNSOUND = 1e-12, 1e-3


class Balance(NamedTuple):
    """Where Newton's method ended: ``unknown`` (n,), the next ``step`` (n,) from there, not taken, and its size
    ``error`` (infinite where the derivative is singular)."""

    unknown: np.ndarray
    step: np.ndarray
    error: float


class _Dense(NamedTuple):
    """The derivative ``whole`` (n, n)."""

    whole: np.ndarray

    def solved(self, miss):
        return np.linalg.solve(self.whole, miss)

    def rounding(self, step, miss):
        return np.finfo(float).eps * np.linalg.norm(self.whole) * np.linalg.norm(step)


class LowRank(NamedTuple):
    """The derivative 1 - ``left`` (n, r) ``right`` (r, n), r being less than n."""

    left: np.ndarray
    right: np.ndarray

    @property
    def whole(self):
        return np.eye(len(self.left)) - self.left @ self.right

    def solved(self, miss):
        """x (n,) of 1 - left right by that of 1 - right left (Woodbury)."""
        small = np.eye(len(self.right)) - self.right @ self.left
        return miss + self.left @ np.linalg.solve(small, self.right @ miss)

    def rounding(self, step, miss):
        """Size of what a ``step`` leaves of what is missing."""
        return np.linalg.norm(step - self.left @ (self.right @ step) - miss)


def damped_newton(equation, start, size, tolerance, steps, halvings):
    """Balance of ``equation`` from ``start`` (n,): converged where its error is at most ``tolerance``.

    ``equation(unknown)`` gives what is missing (n,), its derivative (n, n) or LowRank, and whatever else
    ``size(step, ...)`` asks for to tell how much a step would change. After ``steps`` steps, each halved up to
    ``halvings`` times, it gives up. Where the derivative is singular, as that of a body that touches nothing, the
    shortest step is taken that does best.
    """
    unknown, (miss, derivative, *more) = start, equation(start)
    for _ in range(steps):
        step, sound = _step(derivative, miss)
        error = size(step, *more) if sound else np.inf
        if error <= tolerance:
            break
        for length in 0.5 ** np.arange(halvings):
            trial = equation(unknown - length * step)
            if np.linalg.norm(trial[0]) < np.linalg.norm(miss):
                break
        unknown, (miss, derivative, *more) = unknown - length * step, trial
    return Balance(unknown, step, error)


def _step(derivative, miss):
    """(Step (n,), whether it follows from the ``derivative``, (n, n) or LowRank, beyond its rounding)."""
    derivative = derivative if isinstance(derivative, LowRank) else _Dense(derivative)
    try:
        step = derivative.solved(miss)
        if derivative.rounding(step, miss) <= _UNSOUND * np.linalg.norm(miss):
            return step, True
    except np.linalg.LinAlgError:
        pass
    return np.linalg.lstsq(derivative.whole, miss, rcond=_SINGULAR)[0], False
