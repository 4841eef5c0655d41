"""Which mode of a model a measured one is: by frequency and by shape, and whether another would do nearly as well.

Modes of a model that are close in frequency make a group, as any mixture of the two of a disc's pair is a mode too:
the likeness of a measured shape is that with the nearest mixture, MAC = |P x|^2 / |x|^2 with the projection P on what
the group shows at the points (R. J. Allemang, The modal assurance criterion, Sound and Vibration 37 (2003) 14, for
subspaces). A measured mode that is group g has ln f about that of the group within the spread of both, and an
exponential 1 - MAC; one that is none, an ln f anywhere in the band and the MAC of a random shape, a beta
distribution. The most probable assignment of all modes to different places is that of Kuhn; forbidding each of its
pairs tells by how much it is better than the next.
"""

from dataclasses import dataclass

import numpy as np
import scipy

#: mean of 1 - MAC of shapes of one mode, by noise and by points that are off their places
_UNLIKE = 0.05
#: share of measured modes that the model does not have
_FOREIGN = 0.02
#: bounds of a MAC in its distributions
_LEAST, _MOST = 1e-3, 1 - 1e-3
#: odds (natural logarithm) of an assignment over the next one from which a pair is clear
CLEAR = 3.0


@dataclass(frozen=True)
class Pairing:
    """Of each measured mode (t,): its ``group`` of the model, -1 for none; the ``rival`` that it would be otherwise (-1
    for none), and the ``odds`` (natural logarithm) of the whole assignment over that one."""

    group: np.ndarray
    rival: np.ndarray
    odds: np.ndarray

    @property
    def clear(self):
        """(t,) whether a measured mode has a pair beyond doubt."""
        return (self.group >= 0) & (self.odds >= CLEAR)


def grouped(frequency, within):
    """[(k,)] indices of modes whose ``frequency`` (m,), ascending, follows the one before by less than a share."""
    splits = np.flatnonzero(np.diff(frequency) > within * frequency[:-1]) + 1
    return np.split(np.arange(len(frequency)), splits) if len(frequency) else []


def nearest_mixture(shape, seen):
    """Part (n,) of a real ``shape`` (n,) that mixtures of the columns of ``seen`` (n, k) make up."""
    basis = _basis(seen)
    return basis @ (basis.T @ shape)


def assurance(shapes, groups):
    """MAC (t, g) of real ``shapes`` (t, n) and of what each group shows, [(n, k)]."""
    size = np.maximum(np.sum(shapes ** 2, axis=1), 1e-300)
    return np.array([np.sum((shapes @ _basis(seen)) ** 2, axis=1) / size for seen in groups]).reshape(
        len(groups), len(shapes)).T


def _basis(seen):
    """Orthonormal basis (n, i) of the mixtures of columns (n, k)."""
    basis, size, _ = np.linalg.svd(seen, full_matrices=False)
    return basis[:, size > 1e-9 * max(size.max(initial=0.0), 1e-300)]


def real(shape):
    """Real shape (n,) of a complex one, turned to the phase in which most of it moves."""
    return (shape * np.exp(-0.5j * np.angle(np.sum(shape ** 2)))).real


def paired(distance, spread, places, band, likeness=None, dimensions=None, points=0):
    """Pairing of t measured modes with g groups.

    ``distance`` (t, g): difference of ln f; ``spread`` (t, g): its standard deviation where they are one; ``places``
    (g,): modes of each group; ``band``: ln of highest over lowest frequency; ``likeness`` (t, g): MAC of shapes at so
    many ``points``, of groups of ``dimensions`` (g,), or None where no shapes are known.
    """
    gain = -0.5 * (distance / spread) ** 2 - np.log(np.sqrt(2 * np.pi) * spread) + np.log(band)
    if likeness is not None and points > np.max(dimensions, initial=0):
        mac = np.clip(likeness, _LEAST, _MOST)
        own = -(1 - mac) / _UNLIKE - np.log(_UNLIKE)
        gain = gain + own - scipy.stats.beta.logpdf(mac, dimensions / 2, (points - dimensions) / 2)
    owner = np.repeat(np.arange(len(places)), places)
    whole = gain[:, owner]
    best, total = _assigned(whole, owner)
    rival, odds = np.full(len(gain), -1), np.full(len(gain), np.inf)
    for t in range(len(gain)):
        other, less = _assigned(_forbidden(whole, t, owner == best[t]), owner, none=best[t] >= 0 or None, mode=t)
        rival[t], odds[t] = other[t], total - less
    return Pairing(best, rival, odds)


def _forbidden(whole, mode, places):
    without = whole.copy()
    without[mode, places] = -np.inf
    return without


def _assigned(gain, owner, none=True, mode=-1):
    """(Group of each mode (t,) or -1, total gain): no mode is forced to have one, but ``mode`` unless ``none``."""
    modes = len(gain)
    alone = np.full((modes, modes), -1e9)
    np.fill_diagonal(alone, np.log(_FOREIGN))
    if not none and mode >= 0:
        alone[mode, mode] = -1e9
    table = np.hstack((np.maximum(gain, -1e9), alone))
    row, column = scipy.optimize.linear_sum_assignment(table, maximize=True)
    group = np.full(modes, -1)
    real_places = column < len(owner)
    group[row[real_places]] = owner[column[real_places]]
    return group, float(table[row, column].sum())
