"""Contact patches: neighbouring contacts that move together while the motion is stepped.

A patch moves as the mean of its contacts, weighted by their stiffness, so that small motions meet the same stiffness,
resultant and moment; each of its contacts keeps its closure, area and law, so that a patch opens contact by contact.
"""

from dataclasses import dataclass
from math import ceil, inf

import numpy as np

#: weight of an open contact beside the stiffest one
_OPEN = 1e-6


@dataclass(frozen=True)
class Patches:
    """``member`` (c,) contacts, patch after patch; ``first`` (p + 1,) where each patch begins among them; ``mean``
    (p, c) takes values of contacts to those of patches."""

    member: np.ndarray
    first: np.ndarray
    mean: np.ndarray

    def summed(self, values):
        """(p,) sums over the contacts of each patch of ``values`` (c,)."""
        return np.add.reduceat(values[self.member], self.first[:-1])


def contact_patches(position, stiffness, group, largest, most=inf):
    """Patches of at most ``largest`` contacts at ``position`` (c, 3) m, of more where a ``group`` (c,) would have more
    than ``most`` of them; each within one.

    ``stiffness`` (c,) N/m weighs the contacts of a patch; each face is halved across its longer side until its parts
    are small enough.
    """
    faces = (np.flatnonzero(group == g) for g in np.unique(group))
    members = [part for face in faces for part in _halved(position, face, max(largest, ceil(len(face) / most)))]
    first = np.concatenate(([0], np.cumsum([len(part) for part in members])))
    weight = np.maximum(stiffness, _OPEN * stiffness.max(initial=0.0) or 1.0)
    mean = np.zeros((len(members), len(position)))
    for p, part in enumerate(members):
        mean[p, part] = weight[part] / weight[part].sum()
    return Patches(np.concatenate(members), first, mean)


def _halved(position, part, largest):
    if len(part) <= largest:
        return [part]
    centred = position[part] - position[part].mean(axis=0)
    along = centred @ np.linalg.svd(centred, full_matrices=False)[2][0]
    order = part[np.argsort(along, kind="stable")]
    middle = len(part) // 2
    return [*_halved(position, order[:middle], largest), *_halved(position, order[middle:], largest)]
