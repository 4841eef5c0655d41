"""The path of an unstable mode over friction, from its operating point down to none, and the mode that it meets.

The friction of the steady state is scaled by a share from 1 to 0 while contact forces, stiffnesses and damping stay, so
that the path begins in the named root exactly. At every step the mode is the one of the nearest whose shape is most
like the last one, by the modal assurance criterion in the mass (Allemang, Sound and Vibration 37 (2003) 14),

    MAC(x, y) = |x^H M y|^2 / (x^H M x  y^H M y),

with shorter steps where that is ambiguous. Without friction and damping, modes are orthogonal in the mass (MAC 0);
where two coalesce, their shapes become one (MAC 1). So the mode that an unstable one meets is that of the largest MAC
with it anywhere on the path.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.modal.nearest_modes import modes_near

#: roots near the last one among which the next is sought
_NEAREST = 12
#: shares of friction from step to step, the shortest step as a part of it, and the longest, where the mode hardly
#: changes: its MAC with the last one from which on a step may be longer than the last, and one that is longer is taken
_STEP, _SHORTEST, _LONGEST, _STAYS, _TAKEN = 1 / 40, 2.0**-10, 4.0, 0.98, 0.9
#: a MAC below is ambiguous; so is a second candidate within the margin, unless the best lies far closer to 1
_LIKE, _MARGIN, _FAR = 0.6, 0.1, 0.25
#: shift of the target beside the root, and accepted distance of the first root from the named one, as shares of it
_BESIDE, _SAME = 1e-4, 1e-6
#: of two roots near each other, as of a motion that nothing holds, no more than half of the digits are known
_DOUBLE = np.sqrt(np.finfo(float).eps)
#: accuracy of the critical share
_CRITICAL = 1e-5
#: frequencies that differ by less are one mode at several operating points
_SAME_FREQUENCY = 5e-3


@dataclass(frozen=True)
class FrictionSystem:
    """((M, C, K), Settling or None) without friction and with all of it; linear in the share of friction between."""

    none: tuple
    full: tuple

    def __call__(self, share):
        """((M, C, K), Settling or None) at a ``share`` of the friction."""
        (mass, drag, spring), still = self.none
        (_, full_drag, full_spring), beside = self.full
        if beside is not None:
            beside = replace(beside, push=still.push + share * (beside.push - still.push))
        return (mass, drag + share * (full_drag - drag), spring + share * (full_spring - spring)), beside

    def with_losses(self, damping, stiffness):
        """The same with more ``damping`` and ``stiffness`` (n, n), which may be imaginary, at all shares."""
        ends = [((mass, drag + damping, spring + stiffness), beside)
                for (mass, drag, spring), beside in (self.none, self.full)]
        return FrictionSystem(*ends)


@dataclass(frozen=True)
class FrictionPath:
    """Roots (p,) 1/s at rising shares (p,) of the friction; ``meeting`` (p,) those of the mode met, 0 where not known.

    ``critical``: share from which on the mode is unstable up to the operating point; ``alike``: largest MAC of the two;
    ``start`` (n, 2): their shapes without friction, zero where not known.
    """

    share: np.ndarray
    root: np.ndarray
    meeting: np.ndarray
    critical: float
    alike: float
    start: np.ndarray


def enriched(basis, mass, shapes):
    """``basis`` (n, m), orthonormal in the ``mass``, with real and imaginary parts of ``shapes`` (n, g) beside it."""
    added = np.hstack((shapes.real, shapes.imag))
    for _ in range(2):
        added = added - basis @ (basis.T @ (mass @ added))
    upper = scipy.linalg.cholesky(mass)
    direction, size, _ = np.linalg.svd(upper @ added, full_matrices=False)
    return np.hstack((basis, scipy.linalg.solve_triangular(upper, direction[:, size > 1e-12])))


def friction_path(system, root, vector, neutral=1e-6):
    """FrictionPath of the mode (``root`` 1/s, ``vector`` (n,)) of ``system``, (M, C, K) and Settling over the share.

    A mode is unstable where its growth rate exceeds ``neutral`` times abs(root). Raises ConvergenceError where the
    system has no such root at share 1.
    """
    first = _Point.near(system, 1.0, root)
    here = abs(first.root - root) <= np.maximum(_SAME * abs(root), _DOUBLE * abs(first.root).max())
    if not here.any():
        raise ConvergenceError("path over friction", f"the root {root:.6g} 1/s in the system at its operating point",
                               f"{first.root[:1]} 1/s nearest to it", "lower smallest_correction")
    index = int(np.argmax(np.where(here, first.mac(vector / first.size(vector)), -1.0)))
    points, chosen = _followed(system, first, index)
    roots = np.array([p.root[k] for p, k in zip(points, chosen, strict=True)])
    critical = _critical(system, points, chosen, roots, neutral)
    partner, alike = _met(points, chosen)
    start = np.stack([points[0].vector[:, k] if k >= 0 else np.zeros(len(vector)) for k in (chosen[0], partner[0])], 1)
    meeting = np.array([p.root[k] if k >= 0 else 0.0 for p, k in zip(points, partner, strict=True)], complex)
    return FrictionPath(np.array([p.share for p in points]), roots, meeting, critical, alike, start)


@dataclass(frozen=True)
class _Point:
    """The modes near a target at one share: roots (g,), vectors (n, g) of unit size in the mass."""

    share: float
    root: np.ndarray
    vector: np.ndarray
    mass: np.ndarray

    @classmethod
    def near(cls, system, share, target):
        matrices, beside = system(share)
        roots, vectors = modes_near(*matrices, target * (1 + _BESIDE), _NEAREST, beside)
        upper = roots.imag >= 0
        return cls(share, roots[upper], vectors[:, upper], matrices[0])

    def size(self, vector):
        return np.sqrt((vector.conj() @ self.mass @ vector).real)

    def mac(self, vector):
        """MAC (g,) of all with a ``vector`` (n,) of unit size."""
        return abs((self.mass @ vector).conj() @ self.vector) ** 2


def _followed(system, point, index):
    """(points by rising share, index of the mode at each) from share 1 to 0."""
    points, chosen, step = [point], [index], _STEP
    while points[-1].share > 0:
        last, member = points[-1], chosen[-1]
        share = max(last.share - step, 0.0)
        trial = _Point.near(system, share, last.root[member])
        mac = trial.mac(last.vector[:, member])
        likest = mac.max(initial=0.0)
        if step > _STEP * _SHORTEST and _ambiguous(mac) or step > _STEP and likest < _TAKEN:
            step /= 2
            continue
        points.append(trial)
        chosen.append(_best(mac, trial.root, _expected(points, chosen)))
        step = min(2 * step, _STEP * (_LONGEST if likest > _STAYS else 1))
    return points[::-1], chosen[::-1]


def _ambiguous(mac):
    if not len(mac):
        return True
    best, second = np.sort(np.append(mac, 0.0))[:-3:-1]
    return best < _LIKE or (second > best - _MARGIN and 1 - best > _FAR * (1 - second))


def _expected(points, chosen):
    """Root at the last of ``points``, extrapolated from those before."""
    roots, shares = [p.root[k] for p, k in zip(points[-3:-1], chosen[-2:], strict=True)], [p.share for p in points[-3:]]
    if len(roots) < 2:
        return roots[0]
    return roots[1] + (roots[1] - roots[0]) * (shares[2] - shares[1]) / (shares[1] - shares[0])


def _best(mac, roots, expected):
    """Index of the largest MAC; where another is as good, as at a coalescence, that of the root nearer to expected."""
    if not _ambiguous(mac):
        return int(np.argmax(mac))
    rivals = np.flatnonzero(mac > mac.max() - _MARGIN)
    return int(rivals[np.argmin(abs(roots[rivals] - expected))])


def _critical(system, points, chosen, roots, neutral):
    """Share at which growth begins, of the last beginning before the operating point; 0 where it grows at any."""
    stable = np.flatnonzero(roots.real <= neutral * abs(roots))
    if not len(stable):
        return 0.0
    k = stable[-1]
    if k == len(roots) - 1:
        return 1.0
    below, above = (points[j].vector[:, chosen[j]] for j in (k, k + 1))

    def growth(share):
        point = _Point.near(system, share, roots[k + 1])
        best = point.root[np.argmax(np.maximum(point.mac(below), point.mac(above)))]
        return best.real - neutral * abs(best)

    ends = points[k].share, points[k + 1].share
    signs = [growth(share) for share in ends]
    if signs[0] * signs[1] >= 0:
        return float(ends[1] if signs[1] <= 0 else ends[0])
    return float(scipy.optimize.brentq(growth, *ends, xtol=_CRITICAL))


def _met(points, chosen):
    """(index at each point of the mode with the largest MAC anywhere, -1 where out of reach; that MAC)."""
    alike = [p.mac(p.vector[:, k]) for p, k in zip(points, chosen, strict=True)]
    for mac, k in zip(alike, chosen, strict=True):
        mac[k] = -1.0
    top = int(np.argmax([mac.max() for mac in alike]))
    index = np.full(len(points), -1)
    if alike[top].max() < 0:
        return index, 0.0
    index[top] = np.argmax(alike[top])
    for order in (range(top + 1, len(points)), range(top - 1, -1, -1)):
        before = top
        for k in order:
            mac = points[k].mac(points[before].vector[:, index[before]])
            mac[chosen[k]] = -1.0
            if mac.max(initial=0.0) < _LIKE:
                break
            index[k], before = np.argmax(mac), k
    return index, float(alike[top].max())


def first_of_each(roots):
    """Index (g,) of the first of the ``roots`` (g,) that has the same frequency as each, within 0.5 %."""
    first = []
    for root in roots:
        same = (k for k in dict.fromkeys(first) if abs(root.imag / roots[k].imag - 1) <= _SAME_FREQUENCY)
        first.append(next(same, len(first)))
    return np.array(first, int)
