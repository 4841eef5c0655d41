"""Which mode of one model is which of another: by the modal assurance criterion at points that both have.

    MAC(x, y) = |x^H y|^2 / (x^H x  y^H y)

(R. J. Allemang, The modal assurance criterion, Sound and Vibration 37 (2003) 14). Models of one machine may have other
meshes: shapes are taken to the points of the other one by moving least squares with linear polynomials (P. Lancaster,
K. Salkauskas, Math. Comp. 37 (1981) 141), which a shape that varies linearly along a surface passes exactly.
"""

from dataclasses import dataclass

import numpy as np
import scipy

#: a MAC below is no clear match; nor is one with a rival within the margin, unless the best lies far closer to 1
LIKE, MARGIN, FAR = 0.6, 0.1, 0.25
#: nodes that a shape is interpolated from
_NEIGHBOURS = 8
#: singular values of the local polynomials, over the largest, that count as none: surfaces are flat
_FLAT = 1e-3


@dataclass(frozen=True)
class CommonPoints:
    """Points of a model that another one has too: ``index`` (p,) of them in the first, and the sparse ``weight`` (p, m)
    of the m points of the second that makes its shapes there."""

    index: np.ndarray
    weight: object

    def mac(self, first, second):
        """MAC (g, h) of shapes (g, n, 3) of the first model with shapes (h, m, 3) of the second."""
        given = first[:, self.index].reshape(len(first), 3 * len(self.index))
        rows = [self.weight @ shape for shape in second]
        return assurance(given, np.reshape(rows, (len(second), given.shape[1])))


def common_points(position, body, other_position, other_body):
    """CommonPoints of the points (n, 3) m of one model, each with the name of its ``body`` (n,), and those (m, 3) of
    another; points that lie farther from the other model than its points do from each other are left out."""
    index, rows, columns, weights, count = [], [], [], [], 0
    for name in np.unique(body):
        here, there = np.flatnonzero(body == name), np.flatnonzero(other_body == name)
        if not len(there):
            continue
        members, weight, near = _interpolation(position[here], other_position[there])
        index.append(here[near])
        rows.append(np.repeat(count + np.arange(near.sum()), members.shape[1]))
        columns.append(there[members[near]].ravel())
        weights.append(weight[near].ravel())
        count += int(near.sum())
    empty = [np.empty(0, int)]
    places = tuple(np.concatenate([*empty, *each]) for each in (rows, columns))
    weight = scipy.sparse.csr_array((np.concatenate([np.empty(0), *weights]), places), (count, len(other_position)))
    return CommonPoints(np.concatenate([*empty, *index]), weight)


def _interpolation(points, nodes):
    """(neighbours (p, k), weights (p, k), near (p,)) that interpolate at ``points`` what is known at ``nodes``."""
    tree, count = scipy.spatial.cKDTree(nodes), min(_NEIGHBOURS, len(nodes))
    distance, members = tree.query(points, np.arange(1, count + 1))
    spacing = tree.query(nodes, [min(2, len(nodes))])[0].ravel()[members[:, 0]]
    size = np.maximum(distance[:, -1:], np.finfo(float).tiny)
    share = np.exp(-(2 * distance / size) ** 2)
    offset = (nodes[members] - points[:, None]) / size[:, :, None]
    basis = np.concatenate((np.ones((*members.shape, 1)), offset), axis=2)
    weight = np.linalg.pinv(share[:, :, None] * basis, rcond=_FLAT)[:, 0] * share
    exact = distance[:, 0] <= 1e-9 * np.ptp(nodes, axis=0).max(initial=0.0)
    weight[exact] = np.eye(count)[0]
    return members, weight, exact | (distance[:, 0] <= spacing)


def assurance(first, second):
    """MAC (g, h) of complex shapes (g, n) with shapes (h, n); 0 for a shape that does not move."""
    sizes = [np.sum(abs(shapes) ** 2, axis=1) for shapes in (first, second)]
    product = np.outer(*sizes)
    return np.divide(abs(first.conj() @ second.T) ** 2, product, out=np.zeros(product.shape), where=product > 0)


@dataclass(frozen=True)
class Counterparts:
    """Of each mode (g,) of one model: its ``counterpart`` among those of another (-1: none), and the ``rivals`` that it
    may be as well, a tuple of indices for each."""

    counterpart: np.ndarray
    rivals: tuple
    mac: np.ndarray     # (g, h)

    def alike(self, mode):
        """(MAC of a ``mode`` with its counterpart, largest with a rival), 0 where there is none."""
        chosen = self.counterpart[mode]
        return (self.mac[mode, chosen] if chosen >= 0 else 0.0,
                max((self.mac[mode, k] for k in self.rivals[mode]), default=0.0))

    def clear(self, mode):
        """Whether a ``mode`` has its counterpart beyond doubt."""
        return bool(self.alike(mode)[0] >= LIKE and not self.rivals[mode])


def counterparts(mac):
    """Counterparts by a table ``mac`` (g, h): the assignment of the largest sum, each mode to one at most."""
    modes, others = mac.shape
    chosen = np.full(modes, -1)
    if others:
        row, column = scipy.optimize.linear_sum_assignment(mac, maximize=True)
        chosen[row] = column
    rivals = tuple(tuple(k for k in range(others) if _rivals(mac, chosen, mode, k)) for mode in range(modes))
    return Counterparts(chosen, rivals, mac)


def _rivals(mac, chosen, mode, other):
    """Whether ``mode`` may as well be the ``other`` one, which no mode has that is more like it."""
    if other == chosen[mode]:
        return False
    holders = np.flatnonzero(chosen == other)
    if any(mac[k, other] >= max(mac[mode, other], LIKE) for k in holders):
        return False
    best = mac[mode, chosen[mode]] if chosen[mode] >= 0 else 0.0
    close = mac[mode, other] > best - MARGIN and 1 - best > FAR * (1 - mac[mode, other])
    return bool(close or best < LIKE and mac[mode, other] > best / 2)
