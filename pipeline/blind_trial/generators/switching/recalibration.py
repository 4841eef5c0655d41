"""What a recalibrated nominal model leaves of a motion: a linear rig refitted in closed form, starts and gains as well.

    d^2 = min |(seen - y(u)) / noise|^2 + |u|^2

u: values of the rig off by u standard deviations, of the gains, and of starts or blows, which are as good as free.
About four are needed to tell two laws apart.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.blind_trial.generators.switching.event_motion import Motion
from pipeline.contract.errors import ConvergenceError

#: standard deviation of the logarithm of a value, of a gain; of a start or blow in its own size
SPREAD, GAIN_SPREAD, _FREE = 0.2, 0.02, 3.0
#: size of what is unknown of the logarithm of the width of a blow
_WIDER = 0.2
#: most steps of a refit
_EVALUATIONS = 60
#: standard deviations by which values may be off where a refit begins
_ALONG = np.linspace(-2.5, 2.5, 51)
#: standard deviations beyond which a refit does not try values: a factor of 50
_FARTHEST = 20.0
#: motions that are remembered
_KEPT = 200
#: delays of a filter after which it shows a blow no longer
_REMEMBERED = 3
#: share of the largest of some changes below which what is new of others is rounding
_NEW = 1e-6
#: parts of an interval over which a blow is averaged
_PARTS = 64


@dataclass(frozen=True)
class Beginning:
    """A run: instants ``fine`` and samples ``time`` in s, its Drive, and the ``start`` (2 n,) at the first of ``fine``.

    ``free``: what of it the workshop does not know: '' nothing, start, or blow.
    """

    fine: np.ndarray
    time: np.ndarray
    drive: object
    start: np.ndarray
    free: str = ""

    def unknown(self):
        """Sizes (k,) of what is not known of the beginning."""
        if self.free == "start":
            half = len(self.start) // 2
            return np.repeat([np.linalg.norm(self.start[:half]), np.linalg.norm(self.start[half:])], half)
        return np.array([1.0, self.time[1] - self.time[0], _WIDER]) if self.free == "blow" else np.zeros(0)


def linear(rig, beginning, off=()):
    """Motion of a Rig alone, by its modes, exact for forces that are straight between the instants.

    ``off`` (k,): what the unknown of the beginning differs by, in SI; of a blow its relative size, its time in s, and
    the logarithm of its width.
    """
    mass, damping, stiffness = rig.matrices()
    n, drive, fine = len(mass), beginning.drive.of(rig), beginning.fine
    if beginning.free == "blow":
        start, force = beginning.start, _struck(drive, fine, *(off if len(off) else np.zeros(3)))
    else:
        start, force = beginning.start + (np.asarray(off) if len(off) else 0.0), drive.force(fine)
    inverse = np.linalg.inv(mass)
    system = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ stiffness, -inverse @ damping]])
    values, shapes = np.linalg.eig(system)
    weights = np.linalg.solve(shapes, np.concatenate((np.zeros(n), inverse @ drive.row)))
    begin = np.linalg.solve(shapes, start.astype(complex))
    step = fine[1] - fine[0]
    turn = np.exp(values * step)
    later = (turn - 1 - values * step) / (values**2 * step)
    now = (turn - 1) / values - later
    modes = []
    for k in range(2 * n):
        forced = scipy.signal.lfilter([later[k], now[k]], [1.0, -turn[k]], force, zi=[-later[k] * force[0]
                                      + 0j])[0] if force.any() else 0.0
        modes.append(weights[k] * forced + begin[k] * np.exp(values[k] * (fine - fine[0])))
    states = (shapes @ np.array(modes)).real
    acceleration = inverse @ (np.outer(drive.row, force) - stiffness @ states[:n] - damping @ states[n:])
    return Motion(states[:n], states[n:], acceleration, 0)


def _struck(drive, fine, size, late, wider):
    """Force of a blow of other size, later, wider about its middle, at the instants ``fine``.

    Averages over both intervals beside an instant, by how near it is: straight lines between them have the impulse of
    the blow, however short it is.
    """
    middle, stretch, step = np.mean(drive.breaks), np.exp(np.clip(wider, -2.0, 2.0)), fine[1] - fine[0]
    reach = stretch * (drive.breaks[1] - drive.breaks[0]) / 2 + step
    near = np.flatnonzero(abs(fine - late - middle) < reach)
    share = (np.arange(1 - _PARTS, _PARTS) / _PARTS)[:, None]
    course = drive.force(middle + (fine[near] + share * step - late - middle) / stretch)
    force = np.zeros(len(fine))
    force[near] = (1 + size) / stretch * np.sum((1 - abs(share)) * course, axis=0) / _PARTS
    return force


def _telling(run, sensors):
    """(sensor, n), 1 of samples that tell something, 0 where a blow of unknown course itself shows in accelerations, or
    how far it has got in velocities."""
    told = np.ones((len(sensors), len(run.time)))
    for k, sensor in enumerate(sensors):
        if run.free == "blow" and sensor.quantity != "displacement":
            first, last = run.drive.breaks
            told[k, (run.time >= first) & (run.time < last + _REMEMBERED * sensor.tau)] = 0.0
    return told


class Recalibration:
    """Refits of a true ``rig`` with ``sensors`` to what other physics shows in ``runs`` [Beginning].

    ``exact``: names of values that are known. ``base`` [(sensor, n)]: what the sensors show without it.
    """

    def __init__(self, rig, sensors, runs, exact, base):
        self.rig, self.sensors, self.runs, self.base = rig, sensors, runs, base
        self.names = [name for name in rig.names if name not in exact]
        self.unknown, self.telling = [run.unknown() for run in runs], [_telling(run, sensors) for run in runs]
        self.size = len(self.names) + len(sensors) + sum(map(len, self.unknown))
        self.kept = {}
        self.at_rest = self.shown(np.zeros(self.size))

    def shown(self, u):
        """[(sensor, n)] at values off by u (size,) standard deviations."""
        values, gains, rest = np.split(u, [len(self.names), len(self.names) + len(self.sensors)])
        shown = []
        for k, sizes in enumerate(self.unknown):
            off, rest = rest[:len(sizes)], rest[len(sizes):]
            shown.append((1 + GAIN_SPREAD * gains)[:, None] * self._without_gains(k, tuple(values), tuple(off)))
        return shown

    def _without_gains(self, k, values, off):
        """(sensor, n) of run ``k``; derivatives by values of other runs ask for the same again and again."""
        key = k, values, off
        if key not in self.kept:
            if len(self.kept) >= _KEPT:
                self.kept.clear()
            rig = self.rig.with_values({name: self.rig.value(name) * np.exp(SPREAD * np.clip(u, -_FARTHEST, _FARTHEST))
                                        for name, u in zip(self.names, values, strict=True)})
            run = self.runs[k]
            motion = linear(rig, run, _FREE * self.unknown[k] * np.array(off))
            self.kept[key] = np.array([s.shown(motion, run.fine, run.time) for s in self.sensors])
        return self.kept[key]

    def left(self, seen, noise, free=()):
        """d of what the sensors have ``seen`` [(sensor, n)] under ``noise`` (sensor,); infinite where not finite.

        ``free``: [[(sensor, n)]] of which any multiples are taken off as well, such as changes of a law that is known.
        Raises ConvergenceError: what an unfinished refit leaves would count as hidden physics.
        """
        wanted = [s - b + r for s, b, r in zip(seen, self.base, self.at_rest, strict=True)]
        per = [told / noise[:, None] for told in self.telling]
        if not all(np.isfinite(w).all() for w in wanted):
            return np.inf

        def weighed(shown):
            return np.concatenate([(part * p).ravel() for part, p in zip(shown, per, strict=True)])

        directions = _orthonormal(weighed(wanted), [weighed(each) for each in free])

        def residual(u):
            missed = weighed([w - y for w, y in zip(wanted, self.shown(u), strict=True)])
            return np.concatenate((missed - directions @ (directions.T @ missed), u))

        fits = [scipy.optimize.least_squares(residual, start, x_scale="jac", xtol=1e-4, ftol=1e-4,
                                             max_nfev=_EVALUATIONS)
                for start in (np.zeros(self.size), *self._nearest(residual))]
        ended = [fit.cost for fit in fits if fit.success]
        if not ended:
            raise ConvergenceError("recalibration of a switching rig", "a refit that ends",
                                   f"none after {_EVALUATIONS} evaluations", "draw another seed")
        return float(np.sqrt(2 * min(ended)))

    def _nearest(self, residual):
        """Starts [(size,)] of refits: what leaves least of a rig that is stiffer or softer throughout, and of one all
        of whose values are larger or smaller, where that is not the rig as it is.

        Where what is hidden moves frequencies, the phase of a decay slips by turns, and a refit that begins there
        without ends in a wrong optimum. Decays and moved walls show the ratios of all values alone: beside more of the
        one that is known the others are as much less.
        """
        stiffer = [1.0 if name.startswith("stiffness") else -1.0 if name.startswith("mass") else 0.0
                   for name in self.names]
        rest, starts = np.zeros(self.size - len(self.names)), []
        for along in (np.array(stiffer), 2 * np.ones(len(self.names))):
            tried = [np.append(k * along, rest) for k in _ALONG]
            starts.append(min(tried, key=lambda u: float(np.sum(residual(u) ** 2))))
        return [start for start in starts if start.any()]


def _orthonormal(like, columns):
    """(n, k) that spans ``columns`` [(n,)], none of which need be new; none of those not finite."""
    kept = [column for column in columns if np.isfinite(column).all()]
    vectors, sizes, _ = np.linalg.svd(np.column_stack([np.zeros_like(like), *kept]), full_matrices=False)
    return vectors[:, sizes > _NEW * sizes[0]]
