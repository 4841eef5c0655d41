"""How much of a change the values of a rig cannot explain: what a diagnosis has to go by.

With r the change over its noise, J the change of what sensors show by each value over its standard deviation,

    d^2 = min |r - J u|^2 + |u|^2 = r' (1 + J J')^-1 r,

J by differences of the linear rig, whose motion is exact for forces that are linear between samples. About 4 is needed
to name what is missing; below 2 it cannot be told from noise.
"""

from dataclasses import replace

import numpy as np
from scipy.linalg import expm
from scipy.signal import lfilter

from pipeline.trial.motion import PARTS

#: relative step of the differences
_STEP = 1e-4


def linear(rig, force, interval, corner):
    """Filtered displacements (sensor, instant) of a rig alone, as ``motion.moved``, by its exponential over a step."""
    return _states(rig, force, interval, corner)[:, 2 * len(rig.mass):].T


def coarse(rig, force, interval, corner):
    """The same where displacements count as straight between samples: what a model of so long a step shows."""
    states, reach = _states(rig, force, interval, corner), np.array([[-2 * np.pi * corner]])
    instants = np.arange(len(states)) / PARTS
    kept, now, ramp = _held(reach, -reach[0], interval / PARTS)
    found = []
    for place in states[:, :len(rig.mass)].T:
        straight = np.interp(instants, instants[::PARTS], place[::PARTS])
        driven = now * straight[:-1] + ramp * np.diff(straight)
        found.append(lfilter([1.0], [1.0, -kept.item()], np.append(0.0, driven)))
    return np.array(found)


def _states(rig, force, interval, corner):
    """(instant, displacements, velocities and filtered displacements) of a rig alone."""
    size, rows, reach = len(rig.mass), rig.rows, 2 * np.pi * corner
    inverse = np.diag(1 / np.array(rig.mass))
    stiffness, damping = (rows.T @ np.diag([getattr(link, what) for link in rig.links]) @ rows
                          for what in ("stiffness", "damping"))
    none, one = np.zeros((size, size)), np.eye(size)
    rates = np.block([[none, one, none], [-inverse @ stiffness, -inverse @ damping, none],
                      [reach * one, none, -reach * one]])
    push = np.concatenate((np.zeros(size), inverse[rig.pushed], np.zeros(size)))
    step = interval / PARTS
    kept, now, ramp = _held(rates, push, step)
    fine = np.interp(np.arange(PARTS * (len(force) - 1) + 1) / PARTS, np.arange(len(force)), force)
    states = np.zeros((len(fine), 3 * size))
    driven = np.outer(fine[:-1], now) + np.outer(np.diff(fine), ramp)
    for k, gained in enumerate(driven):
        states[k + 1] = kept @ states[k] + gained
    return states


def _held(rates, push, step):
    """(transition, answer to a constant, answer to a ramp from 0 to 1) over a step: C. Van Loan (1978)."""
    size = len(push)
    whole = np.zeros((size + 2, size + 2))
    whole[:size, :size], whole[:size, size], whole[size, size + 1] = rates * step, push * step, 1.0
    found = expm(whole)
    return found[:size, :size], found[:size, size], found[:size, size + 1]


class Explained:
    """What other values explain: ``directions`` (value, run, sensor, n), a standard deviation of each value."""

    def __init__(self, directions):
        self.directions = np.asarray(directions)

    def left(self, change, noise, colour=0.0):
        """d of a ``change`` [(sensor, n)] under noise of standard deviation (sensor,) and colour."""
        r = whitened(np.array(change), noise, colour).ravel()
        rows = whitened(self.directions, noise, colour).reshape(len(self.directions), -1)
        u = np.linalg.solve(np.eye(len(rows)) + rows @ rows.T, rows @ r)
        return float(np.sqrt(max(r @ r - (rows @ r) @ u, 0.0)))


def explained(seen, values, spread, gain_spread, step=_STEP):
    """Explained by all ``values``, the first as it is, then with one after the other larger by a relative ``step``.

    ``seen(values)`` -> [(sensor, n)] is what sensors show; ``spread``: standard deviation of the logarithm of each
    value, ``gain_spread`` of the gain of each sensor.
    """
    base, *others = (np.array(seen(one)) for one in values)
    found = [spread * (other - base) / step for other in others]
    for k in range(base.shape[1]):
        found.append(np.zeros_like(base))
        found[-1][:, k] = gain_spread * base[:, k]
    return Explained(found)


def of_rig(recorder, rig, runs, spread, gain_spread):
    """Explained by other values of a ``rig`` alone, in the first ``runs`` of a Recorder."""
    def seen(one):
        return recorder.seen([linear(one, f, 1 / recorder.rate, recorder.corner) for f in recorder.runs[:runs]])

    return explained(seen, nudged(rig), spread, gain_spread)


def whitened(samples, noise, colour):
    """Samples (..., sensor, n) over first-order autoregressive noise of standard deviation (sensor,)."""
    own = samples / np.asarray(noise)[:, None]
    later = (own[..., 1:] - colour * own[..., :-1]) / np.sqrt(1 - colour**2)
    return np.concatenate((own[..., :1], later), axis=-1)


def nudged(rig, step=_STEP):
    """The rig, then rigs with one value after the other larger by a relative ``step``."""
    yield rig
    for k in range(len(rig.mass)):
        yield replace(rig, mass=tuple(m * (1 + step * (k == i)) for i, m in enumerate(rig.mass)))
    for k, link in enumerate(rig.links):
        for what in ("stiffness", "damping"):
            larger = replace(link, **{what: getattr(link, what) * (1 + step)})
            yield replace(rig, links=(*rig.links[:k], larger, *rig.links[k + 1:]))
