"""Unstable modes of a case beside those of a finer model: which is which, how far they move, and by what."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy

#: roots farther apart than this share of a frequency are not the same mode
_SAME = 0.02
#: order of convergence by which errors are estimated: quadratic elements reach the fourth where nothing is singular,
#: but corners, joints and edges of a contact hold them back
_ORDER = 2
#: the cause that is no refinement: reduced model and sliding state of it, against elements of the same meshes
MODEL = "model"


@dataclass(frozen=True)
class Tolerances:
    """How far a mode may move: shares of its frequency and growth rate, and what a growth rate always may, in 1/s."""

    frequency: float
    growth: float
    neutral: float

    @classmethod
    def of(cls, settings):
        """Of the section ``convergence``."""
        return cls(settings.frequency_tolerance, settings.growth_tolerance, settings.neutral)

    def hold(self, root: np.ndarray, change: np.ndarray, error_factor: float = 1.0) -> np.ndarray:
        """True (g,) where the error, ``error_factor`` times the ``change`` (g,) 1/s, of a ``root`` (g,) is within them,
        or growth is neutral before and after."""
        allowed, error = np.maximum(self.growth * root.real, self.neutral), error_factor * change
        small = np.maximum(root.real, (root + change).real) <= self.neutral
        return (abs(error.imag) <= self.frequency * root.imag) & ((abs(error.real) <= allowed) | small)


def error_factor(meshes: float) -> float:
    """Error of a mesh over its change by a mesh with ``meshes`` times the elements in every direction, by Richardson's
    extrapolation at second order."""
    return meshes**_ORDER / (meshes**_ORDER - 1)


@dataclass(frozen=True)
class Stated:
    """Unstable modes (u,) of a case: ``root`` and ``reduced`` 1/s, those of its ``start`` (u,), an index of modes that
    were followed, -1 for none; ``exact``: on finite elements, not in the reduced model."""

    root: np.ndarray
    reduced: np.ndarray
    start: np.ndarray
    exact: bool

    @classmethod
    def of(cls, root, reduced, followed, exact):
        """With the nearest of the ``followed`` (g,) 1/s for each, within 2 % of its frequency."""
        distance = abs(reduced[:, None] - followed) / abs(reduced)[:, None]
        mode, chosen = scipy.optimize.linear_sum_assignment(distance)
        start = np.full(len(root), -1)
        near = distance[mode, chosen] <= _SAME
        start[mode[near]] = chosen[near]
        return cls(root, reduced, start, exact)

    def moved(self, finer: np.ndarray, base: np.ndarray | None) -> np.ndarray:
        """Changes (u,) 1/s of its modes from roots (g,) of a finer model, nan where there is none: against ``base``
        (g,), elements of the same meshes, unless it is exact."""
        there = np.where(self.start < 0, complex(np.nan, np.nan), np.append(finer, np.nan)[self.start])
        return there - (self.root if base is None else np.append(base, np.nan)[self.start])

    def of_starts(self, starts: np.ndarray) -> np.ndarray:
        """Roots (g,) 1/s of all modes followed: those of the case, and of others ``starts`` (g,)."""
        roots = np.array(starts, complex)
        roots[self.start[self.start >= 0]] = self.root[self.start >= 0]
        return roots

    def alone(self, count: int) -> np.ndarray:
        """True (count,) for modes followed that are none of these."""
        return ~np.isin(np.arange(count), self.start)


@dataclass(frozen=True)
class Comparison:
    """What became of Stated modes (u,) in a finer model, and of the others (g,) that were followed.

    ``change`` (u,) 1/s by meshes and contact, nan where the mode is gone; ``of_bases`` (u,) 1/s by the reduction alone,
    0 where this is not judged; ``finer`` (g,) 1/s the roots there; ``error_factor``: error of the case over ``change``.
    """

    stated: Stated
    change: np.ndarray
    of_bases: np.ndarray
    finer: np.ndarray
    limits: Tolerances
    error_factor: float = 1.0

    @property
    def found(self):
        """True (u,) where the finer model has the mode."""
        return np.isfinite(self.change)

    @property
    def held(self):
        """True (u,) where its estimated error is within the tolerances."""
        hold, root = self.limits.hold, self.stated.root
        return self.found & hold(root, self._there, self.error_factor) & hold(root, self.of_bases)

    @property
    def grows(self):
        """True (g,) for modes that grow in the finer model and are none of those stated."""
        return self.stated.alone(len(self.finer)) & (self.finer.real > self.limits.neutral)

    @property
    def moved(self):
        """(j,) modes followed that move beyond the tolerances, or grow in the finer model alone, by frequency."""
        of_stated = self.stated.start[~self.held]
        return np.sort(np.concatenate((of_stated[of_stated >= 0], np.flatnonzero(self.grows))))

    @property
    def _there(self):
        return np.where(self.found, self.change, 0.0)

    def fields(self):
        """Fields of the product Convergence."""
        root, most = self.stated.root, [abs(part(each)) for each in (self._there, self.of_bases)
                                        for part in (np.real, np.imag)]
        growth, frequency = np.maximum(most[0], most[2]), np.maximum(most[1], most[3])
        return {"root": root, "reduced_root": self.stated.reduced, "refined_root": root + self._there,
                "found": self.found.astype(int), "held": self.held.astype(int), "added": int(self.grows.sum()),
                "frequency_change": (frequency / root.imag).max(initial=0.0), "growth_change": growth.max(initial=0.0),
                "growth_share": (growth / root.real).max(initial=0.0)}


def causes(names: tuple, model_of: Callable, reference: np.ndarray, chosen: np.ndarray) -> tuple:
    """([cause], change (causes, m) 1/s) of modes ``chosen`` (m,) with ``reference`` roots (m,), by each of ``names``.

    ``model_of(names, chosen)``: their roots (m,) with some refined. A mode that is gone has no change, 0.
    """
    base = model_of((), chosen)
    changes = [base - reference, *(model_of((name,), chosen) - base for name in names)]
    return (MODEL, *names), np.where(np.isfinite(changes), changes, 0.0)
