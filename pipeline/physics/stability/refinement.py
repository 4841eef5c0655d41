"""Roots of one system, by a model and by a refined one: which is which, and by how much they moved."""

from dataclasses import dataclass

import numpy as np

#: roots farther apart than this share of a frequency are not the same mode
_SAME = 0.02


@dataclass(frozen=True)
class Moved:
    """Where g unstable roots of a model stand in a refined one: ``root`` (g,) 1/s, nan where there is none, and the
    ``added`` (a,) unstable roots that the refined model has beside them."""

    root: np.ndarray
    added: np.ndarray


def moved_roots(unstable, refined, neutral):
    """Moved: the ``unstable`` roots (g,) 1/s of a model among all roots ``refined`` (r,) of the refined one.

    Each is taken for the nearest in the complex plane within 2 % of its frequency, the closest pairs first. Roots that
    grow by at most ``neutral`` 1/s count as added ones no more than decaying ones.
    """
    unstable, refined = np.asarray(unstable, complex), np.asarray(refined, complex)
    refined = refined[refined.imag > 0]
    root, taken = np.full(len(unstable), complex(np.nan, np.nan)), np.zeros(len(refined), bool)
    distance = abs(unstable[:, None] - refined)
    distance[abs(refined.imag / unstable.imag[:, None] - 1) > _SAME] = np.inf
    for place in np.argsort(distance, axis=None, kind="stable"):
        k, j = np.unravel_index(place, distance.shape)
        if not np.isfinite(distance[k, j]):
            break
        if np.isnan(root[k]) and not taken[j]:
            root[k], taken[j] = refined[j], True
    return Moved(root, refined[(refined.real > neutral) & ~taken])
