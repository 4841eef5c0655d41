"""First values of a lumped model by least squares over the records: what a user replaces by what is known.

    M q'' + C q' + K q + f0 = f        M, K symmetric, C diagonal; without forces, or with a base that moves, M = 1
"""

import math
from dataclasses import dataclass
from itertools import combinations

import numpy as np
import scipy

#: density over that of the noise up to which a motion counts, and shares of the rate that bound its corner
_OVER, _LOWEST, _HIGHEST = 100.0, 1 / 200, 1 / 6
#: share of the rate beyond which motion is coarsely sampled, and share of the accelerations there that matters
_COARSE, _MATTERS = 0.2, 0.02
#: order of the spline whose derivatives are those of motions
_SPLINE = 5
#: samples kept per period of the corner; samples left out at an end, in periods of the corner
_KEPT, _TRIM = 3, 3
#: squared error with the other sign over that as recorded below which a force is turned
_FAR_BETTER = 0.25
#: force of a term over that of all below which it is left out
_LITTLE = 0.02
#: median absolute value of normal noise over its standard deviation
_MEDIAN = 0.6745


@dataclass(frozen=True)
class FirstValues:
    """``mass`` (n, n), ``damping`` (n,), ``stiffness`` (n, n), ``constant`` force (n,); ``left`` (n,) rms over ``size``
    (n,), that of the forces; ``noise`` (n,) of the forces; ``reversed`` (n,): forces that fit with the other sign
    alone; ``corner`` Hz, ``decimation``, ``trim``; ``coarse``: whether the motion stands out of its noise above every
    corner that the rate allows; ``fastest`` rad/s of the model."""

    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    constant: np.ndarray
    left: np.ndarray
    noise: np.ndarray
    size: np.ndarray
    reversed: np.ndarray
    corner: float
    decimation: int
    trim: int
    coarse: bool = False

    @property
    def fastest(self):
        if not np.diag(self.mass).all():
            return 0.0
        roots = scipy.linalg.eigvals(self.stiffness, self.mass)
        return float(np.sqrt(max(roots.real.max(), 0.0)))


def first_values(runs, forces, rate, order, quasi_static=False):
    """FirstValues of ``runs`` [(n, m)] of motions in SI, their ``order`` of derivative; ``forces`` [(n, m)], None of
    free motions. ``quasi_static``: without a time, so that stiffness alone counts."""
    corner, coarse = _corner(runs, rate)
    decimation = max(1, int(rate / (_KEPT * corner)))
    shortest = min(run.shape[1] for run in runs)
    trim = int(min(np.ceil(_TRIM * rate / corner), shortest // 10))
    parts = [_terms(run, None if force is None else force, rate, order, corner, trim, decimation)
             for run, force in zip(runs, forces or [None] * len(runs), strict=True)]
    q, v, a, f = (np.concatenate(each, axis=1) for each in zip(*parts, strict=True))
    free = forces is None
    wanted = {"constant"} | (set() if free and not _swings(v) else {"stiffness"})
    wanted |= set() if quasi_static else {"damping"} if free else {"damping", "mass"}
    turned = np.zeros(len(q), bool) if free else _turned(q, v, a, f, wanted)
    target = -a if free else np.where(turned[:, None], -f, f)
    fitted = _fitted(q, v, a, target, wanted)
    if quasi_static and len(q) == 1:        # loops: as steep as behind a reversal, not as the chord
        fitted["stiffness"][0, 0] = _steep([run[0] for run in runs], [force[0] for force in forces])
    mass = np.eye(len(q)) if free else fitted["mass"]
    left = target - _force(q, v, a, fitted)
    size = np.sqrt(np.mean(target**2, axis=1))
    noise = np.maximum(_white(left, 2), 1e-3 * size)
    return FirstValues(mass, fitted["damping"], fitted["stiffness"], fitted["constant"],
                       np.sqrt(np.mean(left**2, axis=1)) / np.maximum(size, 1e-300), noise, size, turned,
                       corner, decimation, trim, coarse and not quasi_static)


def channel_noise(values):
    """Standard deviation of white noise in samples (m,) by sixth differences, in which a motion of ten samples a period
    leaves little; at least that of their rounding."""
    values = values[np.isfinite(values)]
    steps = np.abs(np.diff(values))
    rounding = steps[steps > 0].min() / np.sqrt(12) if (steps > 0).any() else 0.0
    return float(max(_white(values[None], 6)[0], rounding, 1e-4 * values.std()))


def _steep(motions, forces):
    """Slope of loops behind their reversals: the median over the two steps that follow one."""
    slopes = []
    for motion, force in zip(motions, forces, strict=True):
        moved = np.diff(motion) != 0
        steps, lifts = np.diff(motion)[moved], np.diff(force)[moved]
        behind = np.append(False, steps[1:] * steps[:-1] < 0)
        behind[1:] |= behind[:-1]
        slopes.append(lifts[behind] / steps[behind])
    slopes = np.concatenate(slopes)
    return float(np.median(slopes[slopes > 0])) if (slopes > 0).any() else 0.0


def _turned(q, v, a, f, wanted):
    """(n,) whether the forces on each coordinate alone fit far better with the other sign; all terms are positive."""
    turned = []
    for k in range(len(q)):
        parts = [each[k:k + 1] for each in (q, v, a)]
        left = [np.mean((sign * f[k] - _force(*parts, _fitted(*parts, sign * f[k:k + 1], wanted)))**2)
                for sign in (1, -1)]
        turned.append(left[1] < _FAR_BETTER * left[0])
    return np.array(turned)


def _swings(speed):
    """Whether all motions of speeds (n, m) reverse more than once, as those of springs do."""
    signs = [np.sign(row[np.abs(row) > 0.05 * np.abs(row).max()]) for row in speed]
    return all(np.sum(np.diff(sign) != 0) > 2 for sign in signs)


def _white(values, order):
    """(n,) standard deviation of the white noise whose differences of this order the samples (n, m) have."""
    differences = np.diff(values, order, axis=1)
    if not differences.shape[1]:
        return np.zeros(len(values))
    return np.median(np.abs(differences), axis=1) / (_MEDIAN * np.sqrt(math.comb(2 * order, order)))


def _corner(runs, rate):
    """(Frequency up to which the motions stand out of their noise, whether they do beyond what the rate allows)."""
    highest, coarse = _LOWEST * rate, False
    for run in runs:
        for values in run:
            frequency, density = scipy.signal.welch(scipy.signal.detrend(values), rate,
                                                    nperseg=min(len(values), 1024))
            floor = np.median(density[frequency > 0.35 * rate])
            over = density > _OVER * max(floor, 1e-30 * density.max())
            highest = max(highest, frequency[over].max(initial=0.0))
            inertia = np.where(over, density * frequency**4, 0.0)
            coarse |= bool(inertia[frequency > _COARSE * rate].sum() > _MATTERS * inertia.sum())
    return float(f"{np.clip(highest, _LOWEST * rate, _HIGHEST * rate):.2g}"), coarse


def _terms(run, force, rate, order, corner, trim, decimation):
    """(q, v, a, f), each (n, kept): filtered alike, differentiated or integrated from the ``order`` measured."""
    low = scipy.signal.butter(4, min(2 * corner / rate, 0.99), output="sos")

    def smooth(values):
        return scipy.signal.sosfiltfilt(low, values, axis=1, padlen=min(30, values.shape[1] - 1))

    chain, spline = {order: smooth(run)}, None
    if order < 2 and run.shape[1] > _SPLINE:        # differences lose much of an acceleration of a few samples a period
        at = np.arange(run.shape[1])
        spline = scipy.interpolate.make_interp_spline(at, chain[order], k=_SPLINE, axis=1)
    for k in range(order + 1, 3):
        chain[k] = (np.gradient(chain[k - 1], 1 / rate, axis=1) if spline is None else
                    spline.derivative(k - order)(at) * rate**(k - order))
    for k in range(order - 1, -1, -1):
        chain[k] = scipy.signal.detrend(scipy.integrate.cumulative_trapezoid(
            chain[k + 1] - chain[k + 1].mean(axis=1, keepdims=True), dx=1 / rate, axis=1, initial=0.0), axis=1)
    every = slice(trim, run.shape[1] - trim, decimation)
    applied = np.zeros_like(run) if force is None else smooth(force)
    return tuple(values[:, every] for values in (chain[0], chain[1], chain[2], applied))


def _columns(q, v, a, wanted):
    """[(kind, i, j)], [(n, m)]: what each unknown does to the forces on the coordinates."""
    n, keys, columns = len(q), [], []
    for kind, motion in (("mass", a), ("stiffness", q)):
        for i, j in ((*((i, i) for i in range(n)), *combinations(range(n), 2)) if kind in wanted else ()):
            column = np.zeros_like(q)
            column[i] += motion[j]
            if i != j:
                column[j] += motion[i]
            keys.append((kind, i, j))
            columns.append(column)
    for kind, motion in (("damping", v), ("constant", np.ones_like(q))):
        for i in range(n if kind in wanted else 0):
            column = np.zeros_like(q)
            column[i] = motion[i]
            keys.append((kind, i, i))
            columns.append(column)
    return keys, columns


def _fitted(q, v, a, target, wanted):
    """{kind: array} by least squares; what is too small or of a sign that no part has is left out, one by one."""
    n = len(q)
    keys, columns = _columns(q, v, a, wanted)
    scale = 1 / np.maximum(np.sqrt(np.mean(target**2, axis=1, keepdims=True)), 1e-300)
    while keys:
        matrix = np.array([(scale * c).ravel() for c in columns]).T
        norm = np.maximum(np.linalg.norm(matrix, axis=0), 1e-300)
        solution = np.linalg.lstsq(matrix / norm, (scale * target).ravel(), rcond=1e-10)[0]
        share = np.abs(solution) / np.linalg.norm(scale * target)
        negative = [kind in ("mass", "stiffness", "damping") and i == j and x <= 0
                    for (kind, i, j), x in zip(keys, solution, strict=True)]
        poor = [k for k, (kind, i, j) in enumerate(keys) if negative[k] or (
            share[k] < _LITTLE and kind not in ("mass", "damping"))]
        if not poor:
            break
        worst = min(poor, key=lambda k: (not negative[k], share[k]))
        del keys[worst], columns[worst]
    found = {"mass": np.zeros((n, n)), "stiffness": np.zeros((n, n)), "damping": np.zeros(n), "constant": np.zeros(n)}
    for (kind, i, j), x in zip(keys, (solution / norm) if keys else (), strict=True):
        if found[kind].ndim == 2:
            found[kind][i, j] = found[kind][j, i] = x
        else:
            found[kind][i] = x
    return found


def _force(q, v, a, values):
    return values["mass"] @ a + values["damping"][:, None] * v + values["stiffness"] @ q + values["constant"][:, None]
