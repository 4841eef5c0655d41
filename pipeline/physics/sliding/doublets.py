"""Doublets of a sliding model: pairs of coordinates of one body that are two modes of nearly one frequency."""

import numpy as np

#: share of the largest entry of a matrix that counts as rounding
_ROUNDING = 1e-9


def doublets(model, within=1e-3):
    """{name: (i, j)} of a SlidingModel, by body and rising frequency: what ``Bench.doublets`` asks for.

    Two coordinates are modes where neither mass nor stiffness, joints counted, couples them with others of their body;
    they belong together where their frequencies differ by less than the share ``within``. Each is in one pair at most.
    """
    mass, _, stiffness = model.supported(gyroscopic=False, centrifugal=False)
    named = {}
    for index, body in enumerate(model.body_name):
        members = np.flatnonzero(model.coordinate_body == index)
        members = members[~(_coupled(mass, members) | _coupled(stiffness, members))]
        members = members[np.diag(mass)[members] > 0]
        frequency = np.sqrt(np.maximum(stiffness[members, members] / mass[members, members], 0.0))
        members, frequency = members[np.argsort(frequency, kind="stable")], np.sort(frequency)
        free, pairs = 0, []
        for k in range(1, len(members)):
            if k > free and frequency[k] > 0 and frequency[k] - frequency[k - 1] < within * frequency[k]:
                pairs.append((int(members[k - 1]), int(members[k])))
                free = k + 1
        named |= {f"{body} {number}": pair for number, pair in enumerate(pairs, 1)}
    return named


def _coupled(matrix, members):
    """True (k,) for coordinates that ``matrix`` couples with others of their body."""
    block = abs(matrix[np.ix_(members, members)])
    return (block - np.diag(np.diag(block)) > _ROUNDING * block.max(initial=0.0)).any(axis=1)
