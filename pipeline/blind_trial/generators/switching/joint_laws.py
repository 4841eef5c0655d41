"""Known physics that switches in truth: friction that sticks, play with edges, elements that slip, beside smooth laws.

Each builder takes a Spot and a size, 1 of which makes a force about as large as that of the spring, and gives Laws.
"""

from dataclasses import dataclass

import numpy as np

from pipeline.blind_trial.generators.switching.event_motion import HELD, STOPS, Crossing, Law

#: elements of a joint that slips, and the share of its stiffness that they carry
_ELEMENTS, _SLIPPING = 6, 0.6


@dataclass(frozen=True)
class Spot:
    """Where physics is hidden: a ``row`` (n,) along which it acts; ``length`` m and ``speed`` m/s, root mean squares of
    the elongation and its rate without it; ``stiffness`` N/m and ``damping`` N s/m there; ``shape`` (3,), numbers drawn
    between 0 and 1."""

    row: np.ndarray
    length: float
    speed: float
    stiffness: float
    shape: tuple
    damping: float = 0.0

    @property
    def force(self):
        return self.stiffness * self.length

    @property
    def angular(self):
        """Typical angular frequency, rad/s."""
        return self.speed / self.length

    def between(self, part, low, high):
        """The drawn number ``part`` between ``low`` and ``high``, evenly in the logarithm."""
        return float(low * (high / low) ** self.shape[part])


def dry(row, forward, backward):
    """Friction of ``forward`` and ``backward`` N (both above 0) that really sticks."""
    return Law(row, lambda t, e, v, z, mode: forward if mode > 0 else -backward, first=rubbing,
               crossings=lambda mode: (reversal(mode),), limits=lambda t, e, z: (-backward, forward))


def rubbing(e, v):
    """Mode in which friction begins: as it slides, or as forces decide."""
    return int(np.sign(v)) if v != 0 else STOPS


def reversal(mode):
    """Crossing at which a slip in the direction of ``mode`` comes to rest."""
    return Crossing(lambda t, e, v, z: -mode * v, STOPS)


def coulomb(spot, size):
    return (dry(spot.row, size * spot.force, size * spot.force),)


def asymmetric(spot, size):
    """Friction that is 0.3 to 0.7 larger one way and as much smaller the other."""
    apart = spot.between(0, 0.3, 0.7) * (1 if spot.shape[1] < 0.5 else -1)
    return (dry(spot.row, size * spot.force * (1 + apart), size * spot.force * (1 - apart)),)


def viscous(spot, size):
    return (smooth(spot, lambda e, v: size * spot.force * v / spot.speed),)


def cubic(spot, size):
    return (smooth(spot, lambda e, v: size * spot.force * (e / spot.length) ** 3),)


def quadratic(spot, size):
    return (smooth(spot, lambda e, v: size * spot.force * (e / spot.length) ** 2),)


def drag(spot, size):
    return (smooth(spot, lambda e, v: size * spot.force * v * abs(v) / spot.speed**2),)


def smooth(spot, force):
    """Law of a ``force(e, v)`` without modes."""
    return Law(spot.row, lambda t, e, v, z, mode: force(e, v))


def play(spot, size):
    """The spring pushes only outside a gap: its edges are met exactly."""
    gap = size * spot.length

    def force(t, e, v, z, mode):
        return -spot.stiffness * (e if mode == 0 else mode * gap)

    def crossings(mode):
        if mode == 0:
            return (Crossing(lambda t, e, v, z: e - gap, 1), Crossing(lambda t, e, v, z: -e - gap, -1))
        return (Crossing(lambda t, e, v, z: gap - mode * e, 0),)

    return (Law(spot.row, force, first=lambda e, v: 0 if abs(e) <= gap else int(np.sign(e)), crossings=crossings),)


def slipping(spot, size):
    """Jenkins elements, of one stiffness and unequal limits, in place of a part of the spring."""
    stiffness = _SLIPPING * spot.stiffness / _ELEMENTS
    limits = stiffness * 4 * spot.length / size * (np.arange(_ELEMENTS) + 0.5) / _ELEMENTS

    def rates(t, e, v, z, mode):
        return np.where(np.array(mode) == HELD, stiffness * v, 0.0)

    def crossings(mode):
        listed = [Crossing(lambda t, e, v, z, k=k, s=s: s * z[k] - limits[k], (*mode[:k], s, *mode[k + 1:]))
                  for k in range(_ELEMENTS) if mode[k] == HELD for s in (1, -1)]
        way = next((m for m in mode if m != HELD), None)
        return (*listed, Crossing(lambda t, e, v, z: -way * v, (HELD,) * _ELEMENTS)) if way else tuple(listed)

    return (Law(spot.row, lambda t, e, v, z, mode: z.sum() - stiffness * _ELEMENTS * e, _ELEMENTS, rates,
                spot.force, (HELD,) * _ELEMENTS, crossings),)


def bouc_wen(spot, size):
    """z' = v (1 - |z| (b + (1 - b) sgn(v z))) in units of the yield displacement; R. Bouc 1967, Y.-K. Wen 1976."""
    yields, share = 2 * spot.length / size, _SLIPPING * spot.stiffness
    bend = spot.between(0, 0.5, 0.9)

    def rates(t, e, v, z, mode):
        return v / yields * (1 - abs(z) * (bend + (1 - bend) * np.sign(v * z)))

    return (Law(spot.row, lambda t, e, v, z, mode: share * (yields * z[0] - e), 1, rates),)


def relaxing(spot, size):
    """A Maxwell branch beside the spring: z' = g v - z / tau."""
    branch, time = size * spot.stiffness, spot.between(0, 0.5, 2.0) / spot.angular
    return (Law(spot.row, lambda t, e, v, z, mode: z[0], 1, lambda t, e, v, z, mode: branch * v - z / time,
                spot.force),)


def moving_base(spot, size):
    """The wall behind spring and damper is a mass on a spring of its own; z: its displacement and velocity, SI."""
    held = spot.stiffness / size
    angular = spot.angular * spot.between(0, 1.3, 2.2)
    mass = held / angular**2

    def rates(t, e, v, z, mode):
        pulled = spot.stiffness * (e - z[0]) + spot.damping * (v - z[1])
        return np.array([z[1], (pulled - held * z[0]) / mass])

    return (Law(spot.row, lambda t, e, v, z, mode: -spot.stiffness * z[0] - spot.damping * z[1], 2, rates,
                spot.length),)


def shaken_base(spot, size):
    """The wall behind the spring moves by one tone."""
    angular, phase = spot.angular * spot.between(0, 0.45, 0.8), 2 * np.pi * spot.shape[1]
    amplitude = size * spot.force
    return (Law(spot.row, lambda t, e, v, z, mode: -amplitude * np.cos(angular * t - phase)),)
