"""Bending waves of a stepped disc that its hub clamps and whose rim is free: finely and thick, or coarsely and thin.

A wave of n nodal diameters has w = W(r) cos n t, turns p_r = P(r) cos n t and p_t = F(r) sin n t, u = z p, and energies

    pi (2 pi for n = 0) int D / 2 (k_r^2 + k_t^2 + 2 v k_r k_t + (1 - v) / 2 k_rt^2) + k G h / 2 (g_r^2 + g_t^2) r dr,
    k_r = P',   k_t = (P + n F) / r,   k_rt = F' - (n P + F) / r,   g_r = W' + P,   g_t = F - n W / r.

``thick``: R. D. Mindlin, J. Appl. Mech. 18 (1951) 31, by polynomials of high degree on Gauss-Lobatto points. ``thin``:
G. Kirchhoff, P = -W' and F = n W / r without inertia of their own, by cubic splines with few cells.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg import eigh

#: correction of shear (E. Reissner)
SHEAR = 5 / 6
_DEGREE, _PARTS = 7, 2


@dataclass(frozen=True)
class Disc:
    """Radii of the clamped ``hub``, of the ``step`` and the ``rim``, thickness of ``web`` and ``ring``, all in m."""

    hub: float
    step: float
    rim: float
    web: float
    ring: float
    young: float
    poisson: float
    density: float

    def edges(self, parts):
        """(edges, thickness) of ``parts`` elements in web and ring each."""
        inner, outer = (np.linspace(*ends, parts + 1) for ends in ((self.hub, self.step), (self.step, self.rim)))
        return np.append(inner, outer[1:]), np.repeat((self.web, self.ring), parts)


@dataclass(frozen=True)
class Waves:
    """Modes of ``order`` n: ``squared`` (m,) rad^2/s^2; ``at(r)`` -> W and F, each (len(r), m), of modal mass 1 kg."""

    order: int
    squared: np.ndarray
    at: object

    @property
    def frequency(self):
        """(m,) in Hz."""
        return np.sqrt(self.squared) / (2 * np.pi)

    def first(self, count):
        """The lowest ``count`` modes."""
        def at(radius):
            return tuple(values[:, :count] for values in self.at(radius))

        return replace(self, squared=self.squared[:count], at=at)


def thick(disc, order, parts=_PARTS, degree=_DEGREE):
    """Waves of a thick plate, ``parts`` elements of this ``degree`` in web and in ring."""
    edges, thickness = disc.edges(parts)
    point, weight = legendre.leggauss(degree + 2)
    nodes = np.concatenate(([-1], legendre.Legendre.basis(degree).deriv().roots().real, [1]))
    across = _lagrange(nodes, point)
    size = 3 * (degree * len(thickness) + 1)
    stiffness, mass = np.zeros((2, size, size))
    for k, (low, high, h) in enumerate(zip(edges[:-1], edges[1:], thickness, strict=True)):
        half = (high - low) / 2
        radius = low + half * (1 + point)
        value, slope = across[0], across[1] / half
        fields = [np.kron(value, row) for row in np.eye(3)], [np.kron(slope, row) for row in np.eye(3)]
        block = slice(3 * degree * k, 3 * degree * (k + 1) + 3)
        strain, law = _bending(disc, h, order, radius, *(_turns(fields, part) for part in (0, 1)))
        share = half * weight * radius
        stiffness[block, block] += _energy(strain, law, share)
        shear = fields[1][0] + fields[0][1], fields[0][2] - order / radius[:, None] * fields[0][0]
        rigid = SHEAR * disc.young / (2 + 2 * disc.poisson) * h
        stiffness[block, block] += _energy(shear, rigid * np.eye(2), share)
        mass[block, block] += _energy(fields[0], disc.density * h * np.diag((1, h**2 / 12, h**2 / 12)), share)
    kept = np.arange(3, size)
    if order == 0:
        kept = kept[kept % 3 < 2]

    def rows(radius):
        values_at = np.zeros((2, len(radius), size))
        element = np.clip(np.searchsorted(edges, radius) - 1, 0, len(thickness) - 1)
        for j, (e, r) in enumerate(zip(element, radius, strict=True)):
            block = slice(3 * degree * e, 3 * degree * (e + 1) + 3)
            local = _lagrange(nodes, np.array([2 * (r - edges[e]) / (edges[e + 1] - edges[e]) - 1]))[0]
            for found_row, what in zip(values_at[:, j], (0, 2), strict=True):
                found_row[block] = np.kron(local[0], np.eye(3)[what])
        return values_at[..., kept]

    return _waves(order, stiffness, mass, kept, rows)


def thin(disc, order, parts=2):
    """Waves of a thin plate, ``parts`` cubic cells in web and in ring."""
    edges, thickness = disc.edges(parts)
    point, weight = legendre.leggauss(5)
    size = 2 * len(edges)
    stiffness, mass = np.zeros((2, size, size))
    for k, (low, high, h) in enumerate(zip(edges[:-1], edges[1:], thickness, strict=True)):
        radius = low + (high - low) / 2 * (1 + point)
        value, slope, curve = _hermite(radius, low, high)
        strain, law = _bending(disc, h, order, radius, *_following(order, radius, value, slope, curve))
        share, block = (high - low) / 2 * weight * radius, slice(2 * k, 2 * k + 4)
        stiffness[block, block] += _energy(strain, law, share)
        mass[block, block] += _energy((value,), disc.density * h * np.eye(1), share)
    kept = np.arange(2, size)

    def rows(radius):
        values_at = np.zeros((len(radius), size))
        element = np.clip(np.searchsorted(edges, radius) - 1, 0, len(thickness) - 1)
        for row, e, r in zip(values_at, element, radius, strict=True):
            row[2 * e:2 * e + 4] = _hermite(np.array([r]), *edges[e:e + 2])[0]
        return values_at[:, kept], order / np.asarray(radius)[:, None] * values_at[:, kept]

    return _waves(order, stiffness, mass, kept, rows)


def _waves(order, stiffness, mass, kept, rows):
    """Waves of the matrices without their angle; ``rows(radius)`` gives W and F per kept freedom."""
    whole = np.pi * (1 + (order == 0))
    held = np.ix_(kept, kept)
    squared, shape = eigh(whole * stiffness[held], whole * mass[held])
    return Waves(order, squared, lambda radius: tuple(part @ shape for part in rows(np.atleast_1d(radius))))


def _energy(fields, law, share):
    """int fields' law fields over the points, whose ``share`` (q,) holds weights and radii."""
    return np.einsum("aqi,ab,bqj,q->ij", fields, law, fields, share, optimize=True)


def _bending(disc, h, order, radius, turns, rates):
    """(k_r, k_t, k_rt) and their law of turns (P, F) and their rates of change along r, each (q, freedoms)."""
    r, v = radius[:, None], disc.poisson
    strain = rates[0], (turns[0] + order * turns[1]) / r, rates[1] - (order * turns[0] + turns[1]) / r
    law = disc.young * h**3 / (12 * (1 - v**2)) * np.array([[1, v, 0], [v, 1, 0], [0, 0, (1 - v) / 2]])
    return strain, law


def _turns(fields, part):
    return fields[part][1], fields[part][2]


def _following(order, radius, value, slope, curve):
    """Turns (P, F) of a thin plate, which stays square to its middle, and their rates."""
    r = radius[:, None]
    return (-slope, order * value / r), (-curve, order * (slope / r - value / r**2))


def _lagrange(nodes, point):
    """(values, slopes), each (q, nodes), of the polynomials that are 1 at one node."""
    degree = len(nodes) - 1
    inverse = np.linalg.inv(legendre.legvander(nodes, degree))
    rates = np.array([legendre.legval(point, legendre.legder(row)) for row in np.eye(degree + 1)]).T
    return legendre.legvander(point, degree) @ inverse, rates @ inverse


def _hermite(radius, low, high):
    """(values, slopes, curvatures), each (q, 4), of cubics given by height and slope at both ends."""
    size = high - low
    s = ((radius - low) / size)[:, None]
    powers = np.hstack((s**0, s, s**2, s**3))
    first = np.hstack((0 * s, s**0, 2 * s, 3 * s**2)) / size
    second = np.hstack((0 * s, 0 * s, 2 * s**0, 6 * s)) / size**2
    cubic = np.array([[1, 0, -3, 2], [0, 1, -2, 1], [0, 0, 3, -2], [0, 0, -1, 1]]).T * (1, size, 1, size)
    return powers @ cubic, first @ cubic, second @ cubic
