"""How much of a change the values of a rig cannot explain: what a diagnosis has to go by.

With r the change over its noise, y(u) what sensors show with values off by u standard deviations, over its noise too,

    d^2 = min |r - y(u) + y(0)|^2 + |u|^2:

what is left of the change, and how odd the values are that explain the rest. About 4 is needed for two laws to be told
apart with a probability of 0.9; below 2 a change cannot be told from noise.
"""

from dataclasses import replace

import numpy as np

from pipeline.blind_trial.generators.spring_mass.linear_motion import linear
from pipeline.blind_trial.generators.spring_mass.rig import Rig, value_names

#: step of the differences: relative of values, or in standard deviations
_STEP = 1e-4
#: the same of a motion that is integrated to a tolerance
_WIDER = 3e-3
#: share of the objective that a step must gain for slopes to be updated only
_SERVES = 0.5
#: iterations of a refit, its longest step of a value in standard deviations, shares of a step that are tried, and the
#: gain of the objective below which it has settled
_ITERATIONS, _LONGEST, _SHARES, _SETTLED = 30, 1.5, (1.0, 0.5, 0.25, 0.1, 0.03, 0.01), 0.01


class Explained:
    """What other values explain, linearly: ``directions`` (value, run, sensor, n), a standard deviation of each."""

    def __init__(self, directions):
        self.directions = np.asarray(directions)

    def left(self, change, noise, colour=0.0, beside=()):
        """d of a ``change`` [(sensor, n)] under noise of standard deviation (sensor,) and colour.

        ``beside`` [change]: what of other physics may take part, in any amount of about one.
        """
        return self.taken(change, noise, colour, beside)[0]

    def taken(self, change, noise, colour=0.0, beside=()):
        """The same, linearly, and the amounts (size,) in which each of ``beside`` takes part."""
        r = whitened(np.array(change), noise, colour).ravel()
        rows = self._rows([*self.directions, *beside], noise, colour)
        u = np.linalg.solve(np.eye(len(rows)) + rows @ rows.T, rows @ r)
        return float(np.hypot(np.linalg.norm(r - u @ rows), np.linalg.norm(u))), u[len(self.directions):]

    def _rows(self, changes, noise, colour):
        return whitened(np.array(changes), noise, colour).reshape(len(changes), -1)


class Refitted(Explained):
    """What ``size`` other values explain however large their change: ``model(u)`` -> (run, sensor, n), NaN where it
    cannot; a value towards which it cannot stays as it is.

    ``costly``: the model integrates; between differences, slopes are updated by the secant (C. G. Broyden 1965).
    """

    def __init__(self, model, size, costly=False):
        self.model, self.at_rest, self.size, self.costly = model, np.array(model(np.zeros(size))), size, costly
        super().__init__(self._slopes(np.zeros(size), self.at_rest))

    def left(self, change, noise, colour=0.0, beside=(), enough=0.0):
        """As ``Explained.left``, by Gauss's iteration with steps that are halved until they help; ``enough``: d below
        which no more is looked for."""
        others = self._rows(beside, noise, colour) if len(beside) else np.zeros((0, np.size(change)))
        directions, fresh, u = self.directions, True, np.zeros(self.size + len(others))
        r, seen = self._residual(u, change, noise, colour, others)
        for _ in range(_ITERATIONS):
            rows, before = np.vstack((self._rows(directions, noise, colour), others)), r @ r + u @ u
            if before < enough**2:
                break
            asked = change, noise, colour, others
            moved = (self._nearer(u, self._step(rows, r, u), before, *asked)
                     or self._corrected(rows, u, r, self._step(rows, r, u), before, *asked) or (u, r, seen))
            way, shift = (moved[0] - u)[:self.size], moved[2] - seen
            u, r, seen = moved
            gained = before - r @ r - u @ u
            if not gained >= _SETTLED and fresh:
                break
            fresh = not (self.costly and gained > _SERVES * before)
            directions = self._slopes(u[:self.size], seen) if fresh else self._updated(directions, way, shift)
        return float(np.hypot(np.linalg.norm(r), np.linalg.norm(u))) if np.isfinite(r).all() else np.inf

    def _step(self, rows, r, u):
        step = np.linalg.solve(np.eye(len(u)) + rows @ rows.T, rows @ r - u)
        return step * min(1.0, _LONGEST / max(abs(step).max(), 1e-300))

    def _nearer(self, u, step, before, *asked):
        """(values, residual, what is seen) a share of a step on where that is nearer than ``before``, else None."""
        for share in _SHARES:
            r, seen = self._residual(u + share * step, *asked)
            if r @ r + (u + share * step) @ (u + share * step) < before:
                return u + share * step, r, seen
        return None

    def _corrected(self, rows, u, r, step, before, *asked):
        """The same where shares of a straight step leave a valley that bends: what was not foreseen is taken back."""
        for share in _SHARES:
            moved = u + share * step
            unforeseen = self._residual(moved, *asked)[0] - r + share * step @ rows
            if not np.isfinite(unforeseen).all():
                continue
            moved = moved + np.linalg.solve(np.eye(len(u)) + rows @ rows.T, rows @ unforeseen)
            left, seen = self._residual(moved, *asked)
            if left @ left + moved @ moved < before:
                return moved, left, seen
        return None

    def _updated(self, directions, way, change):
        """Directions that agree with the ``change`` seen on a ``way`` (size,)."""
        return directions + np.multiply.outer(way, change - np.tensordot(way, directions, 1)) / max(way @ way, 1e-300)

    def _residual(self, u, change, noise, colour, others):
        seen = np.array(self.model(u[:self.size]))
        return whitened(np.array(change) - seen + self.at_rest, noise, colour).ravel() - u[self.size:] @ others, seen

    def _slopes(self, u, seen):
        step = _WIDER if self.costly else _STEP
        slopes = np.array([(np.array(self.model(u + step * unit)) - seen) / step for unit in np.eye(self.size)])
        return np.where(np.isfinite(slopes), slopes, 0.0)


def explained(seen, values, spread, gain_spread, step=_STEP):
    """Explained by all ``values``, the first as it is, then with one after the other larger by a relative ``step``.

    ``seen(values)`` -> [(sensor, n)] is what sensors show; ``spread``: standard deviation of the logarithm of each
    value, ``gain_spread`` of the gain of each sensor.
    """
    base, *others = (np.array(seen(value)) for value in values)
    directions = [spread * (other - base) / step for other in others]
    for k in range(base.shape[1]):
        directions.append(np.zeros_like(base))
        directions[-1][:, k] = gain_spread * base[:, k]
    return Explained(directions)


class Values:
    """Values of a ``rig`` and gains of its sensors, off by u (size,) in standard deviations.

    Spreads as in ``explained``; ``exact``: names of values that are known (see ``rig.value_names``).
    """

    def __init__(self, rig, spread, gain_spread, exact=()):
        self.rig, self.spread, self.gain_spread = rig, spread, gain_spread
        self.free = np.array([name not in exact for name in value_names(rig)] + [True] * len(rig.mass))
        self.size = int(self.free.sum())

    def at(self, u):
        """(Rig, factors (sensor,) of the gains)."""
        whole, masses, links = np.zeros(len(self.free)), len(self.rig.mass), len(self.rig.links)
        whole[self.free] = u
        factor = np.exp(self.spread * whole[:masses + 2 * links])
        rig = Rig(tuple(self.rig.mass * factor[:masses]), tuple(
            replace(link, stiffness=link.stiffness * k, damping=link.damping * c) for link, (k, c) in zip(
                self.rig.links, factor[masses:].reshape(links, 2), strict=True)), self.rig.pushed)
        return rig, 1 + self.gain_spread * whole[masses + 2 * links:]


def of_rig(recorder, values, runs):
    """Refitted by Values of a rig alone, in the first ``runs`` of a Recorder."""
    def model(u):
        rig, gains = values.at(u)
        seen = recorder.seen([linear(rig, f, 1 / recorder.rate, recorder.corner) for f in recorder.runs[:runs]])
        return np.array(seen) * gains[:, None]

    return Refitted(model, values.size)


def whitened(samples, noise, colour):
    """Samples (..., sensor, n) over first-order autoregressive noise of standard deviation (sensor,)."""
    scaled = samples / np.asarray(noise)[:, None]
    later = (scaled[..., 1:] - colour * scaled[..., :-1]) / np.sqrt(1 - colour**2)
    return np.concatenate((scaled[..., :1], later), axis=-1)


def nudged(rig, step=_STEP):
    """The rig, then rigs with one value after the other larger by a relative ``step``."""
    yield rig
    for k in range(len(rig.mass)):
        yield replace(rig, mass=tuple(m * (1 + step * (k == i)) for i, m in enumerate(rig.mass)))
    for k, link in enumerate(rig.links):
        for what in ("stiffness", "damping"):
            larger = replace(link, **{what: getattr(link, what) * (1 + step)})
            yield replace(rig, links=(*rig.links[:k], larger, *rig.links[k + 1:]))
