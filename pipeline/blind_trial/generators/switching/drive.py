"""What sets a rig in motion, as functions of continuous time: shakers, a shaken wall, blows, releases.

A Drive pushes with ``row`` times ``force(t)``; what was recorded of it are the samples of ``shown(t)``.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import scipy

#: ways in which a case is excited
WAYS = ("multisine", "sweep", "steps", "wall", "release", "blow")
#: share of a record over which shakers are faded in and out
_FADE = 0.08
_TONES = 14


@dataclass(frozen=True)
class Drive:
    """``row`` (n,), ``force(t)`` N along it for an instant or instants (n,), ``shown(t)`` as a channel records it, in
    N or m; ``breaks`` s where it jumps.

    ``behind``: number of the spring whose far wall is moved, by ``shown``, whose rate of change is ``rate(t)`` m/s.
    """

    row: np.ndarray
    force: Callable
    shown: Callable
    breaks: tuple = ()
    behind: int | None = None
    rate: Callable | None = None

    def of(self, rig):
        """The Drive of a Rig of other values: a wall pulls by the spring and the damper that are there."""
        if self.behind is None:
            return self
        stiffness, damping = rig.stiffness[self.behind], rig.damping[self.behind]
        return replace(self, force=lambda t: stiffness * self.shown(t) + damping * self.rate(t))

    def scaled(self, factor):
        """The same ``factor`` times as strong."""
        rate = self.rate and (lambda t: factor * self.rate(t))
        return replace(self, force=lambda t: factor * self.force(t), shown=lambda t: factor * self.shown(t), rate=rate)

    def pushing(self, fine):
        """push(t) (n,) N of one instant within the even instants ``fine``, by a cubic spline between the breaks."""
        if self.breaks:
            return lambda t: self.row * float(self.force(t))
        step, begin, last = fine[1] - fine[0], fine[0], len(fine) - 2
        parts = scipy.interpolate.CubicSpline(fine, self.force(fine)).c.T.tolist()

        def push(t):
            k = min(max(int((t - begin) / step), 0), last)
            x = t - fine[k]
            a, b, c, d = parts[k]
            return self.row * (((a * x + b) * x + c) * x + d)

        return push


def still(row):
    return Drive(row, lambda t: 0.0 * np.asarray(t), lambda t: 0.0 * np.asarray(t))


def course(random, way, low, high, duration, rate):
    """(course(t) of root mean square about 1, its rate of change, breaks) of a shaker between ``low`` and ``high`` Hz
    that rests before 0 and after ``duration`` s."""
    if way == "steps":
        return _steps(random, high, duration, rate)
    fade = _FADE * duration
    if way == "sweep":
        first, last = (low, high) if random.uniform() < 0.5 else (high, low)
        phases = ((np.sqrt(2), first, (last - first) / (2 * duration), 0.0),)
    else:
        tones = np.sort(random.uniform(low, high, _TONES))
        phases = tuple((np.sqrt(2 / _TONES), f, 0.0, p) for f, p in
                       zip(tones, random.uniform(0, 2 * np.pi, _TONES), strict=True))
    sizes, tone, chirp, phase = np.array(phases).T

    def signal(t):
        t = np.asarray(t, float)[..., None]
        angle = 2 * np.pi * (tone + chirp * t) * t + phase
        inside = np.clip(np.minimum(t, duration - t) / fade, 0.0, 1.0)
        rate_in = np.where(inside < 1, np.pi / (2 * fade) * np.sin(np.pi * inside) * np.sign(duration / 2 - t), 0.0)
        window = np.sin(np.pi * inside / 2) ** 2
        turning = 2 * np.pi * (tone + 2 * chirp * t)
        return (np.sum(sizes * window * np.sin(angle), -1),
                np.sum(sizes * (window * turning * np.cos(angle) + rate_in * np.sin(angle)), -1))

    return (lambda t: signal(t)[0]), (lambda t: signal(t)[1]), ()


def _steps(random, high, duration, rate):
    """Levels held for one to four periods of the highest frequency each, changing at samples."""
    edges, now = [0.0], 0.0
    while now < duration:
        now += np.ceil(random.uniform(1.0, 4.0) / high * rate) / rate
        edges.append(now)
    levels = random.choice((-1.4, -0.7, 0.0, 0.7, 1.4), len(edges))
    edges = np.array(edges) - 1e-9 / rate           # a sample at an edge shows the level behind it

    def signal(t):
        k = np.searchsorted(edges, t, side="right") - 1
        return np.where(k >= 0, levels[np.maximum(k, 0)], 0.0)

    return signal, None, tuple(map(float, edges))


def shaker(row, level, shape):
    signal, _, breaks = shape
    return Drive(row, lambda t: level * signal(t), lambda t: level * signal(t), breaks)


def wall(rig, spring, level, shape):
    """The wall behind a ``spring`` of a Rig is moved; the channel shows its displacement in m."""
    signal, change, breaks = shape
    moved = Drive(rig.rows[spring], None, lambda t: level * signal(t), breaks, spring, lambda t: level * change(t))
    return moved.of(rig)


def blow(row, impulse, instant, width):
    """A half sine of ``impulse`` N s that begins at ``instant``."""
    def force(t):
        since = np.asarray(t) - instant
        inside = (since > 0) & (since < width)
        return np.where(inside, impulse * np.pi / (2 * width) * np.sin(np.pi * since / width), 0.0)

    return Drive(row, force, force, (instant, instant + width))
