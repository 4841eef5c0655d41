"""Physics that a trial hides, written from its own laws: at links, masses, the shaker and sensors.

``size`` 1 makes a force about as large as what the link carries; a trial scales it until the motion changes as much as
it wants. ``known``: whether the catalogue of the diagnosis is meant to hold it.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from pipeline.blind_trial.generators.spring_mass.motion import Law, World
from pipeline.blind_trial.generators.spring_mass.rig import Link
from pipeline.blind_trial.generators.spring_mass.sensors import Chain

#: speed at which smoothed dry friction has 3/4 of its size, as a share of the typical speed
_SMOOTH = 3e-3


class Drawn:
    """What has a drawn ``shape`` (3,), each number between 0 and 1."""

    def between(self, part, low, high):
        """The drawn shape ``part`` between ``low`` and ``high``, evenly in the logarithm."""
        return float(low * (high / low) ** self.shape[part])


@dataclass(frozen=True)
class Spot(Drawn):
    """Where physics is hidden: link, mass or channel ``index`` of a rig, typical sizes there, a drawn ``shape`` (3,).

    ``length`` m, ``speed`` m/s, ``force`` N (root mean squares without the hidden physics), ``time`` s of a run.
    """

    rig: object
    index: int
    length: float
    speed: float
    force: float
    time: float
    shape: tuple

    @property
    def row(self):
        return self.rig.rows[self.index]

    @property
    def link(self):
        return self.rig.links[self.index]

    @property
    def angular(self):
        """Typical angular frequency, rad/s."""
        return self.speed / self.length


@dataclass(frozen=True)
class Hidden:
    """One piece of physics: ``build(spot, size)`` -> World, or the Chain of a channel.

    ``timed``: whether it has times of its own, which follow the typical ones of the spot.
    """

    name: str
    place: str
    build: Callable
    known: bool = True
    exact: str = ""
    timed: bool = False


def _along(force, states=0, rates=None):
    """Builder of a World with one law at a link; ``force(spot, size)`` -> F(t, e, v, z)."""
    def build(spot, size):
        count = states(spot) if callable(states) else states
        return World(spot.rig, (Law(spot.row, force(spot, size), count, rates and rates(spot, size)),))
    return build


def _dry(spot, v):
    return np.tanh(v / (_SMOOTH * spot.speed))


def _polynomial(power):
    return _along(lambda s, size: lambda t, e, v, z: size * s.force * (e / s.length) ** power)


def _drag(power):
    return _along(lambda s, size: lambda t, e, v, z: size * s.force * np.sign(v) * abs(v / s.speed) ** power)


def _backlash(spot, size):
    gap, stiffness = 0.3 * size * spot.length, spot.link.stiffness
    return lambda t, e, v, z: -stiffness * min(max(e, -gap), gap)


_SLIDERS = (np.arange(16) + 0.5) / 16


def _slip_force(spot, size):
    """Masing: 16 sliders of one stiffness, ways evenly spread up to where all slip; they take a share of the link."""
    stiffness = 0.5 * spot.link.stiffness / len(_SLIDERS)
    return lambda t, e, v, z: z.sum() - stiffness * len(_SLIDERS) * e


def _slip_rates(spot, size):
    stiffness = 0.5 * spot.link.stiffness / len(_SLIDERS)
    limit = stiffness * 3 * spot.length * _SLIDERS / size
    return lambda t, e, v, z: stiffness * v * np.where(z * v > 0, 1 - np.minimum(abs(z / limit), 1.0) ** 8, 1.0)


def _branches(weights, times, held=0.0):
    """Relaxing branches z' = g v - z / tau beside a link, with ``weights`` and ``times`` in its own units.

    ``held``: what the stated stiffness of the link has of theirs already, as one that is measured in motion has.
    """
    def stiffness(spot, size):
        return size * spot.link.stiffness * np.asarray(weights(spot))

    return _along(lambda s, size: lambda t, e, v, z: z.sum() - size * s.link.stiffness * held * e,
                  lambda s: len(times(s)),
                  lambda s, size: lambda t, e, v, z: stiffness(s, size) * v - z / times(s))


#: branches of a shim, evenly spread over three decades: their times in radians and weight; what all hold at one radian
_SHIM, _OF_SHIM = 10 ** np.linspace(-1.5, 1.5, 9), 0.12
_HELD = _OF_SHIM * np.sum(_SHIM**2 / (1 + _SHIM**2))
_DECADES = 10 ** np.linspace(-2, 2, 17)


def _fractional_weights(order):
    """Spectrum of s^order over the decades: H(tau) = sin(pi a) / (pi a) tau^-a; R. L. Bagley, P. J. Torvik (1983)."""
    return 0.3 * np.sin(np.pi * order) / np.pi * np.log(_DECADES[1] / _DECADES[0]) * _DECADES**-order


def _shaken(spot, size):
    """The far end of the link moves by one tone."""
    angular, far, phase = spot.angular * spot.between(0, 0.5, 0.9), size * spot.length, 6 * spot.shape[1]
    link = spot.link
    return lambda t, e, v, z: -far * (link.stiffness * np.cos(angular * t - phase)
                                      - link.damping * angular * np.sin(angular * t - phase))


def _arm(spot, size):
    links = list(spot.rig.links)
    links[spot.index] = replace(spot.link, stiffness=spot.link.stiffness / (1 + size))
    return World(replace(spot.rig, links=tuple(links)))


def _base(spot, size):
    """The far wall of a link becomes a mass on a spring of its own."""
    base, wall = len(spot.rig.mass), spot.link.stiffness / size
    links = list(spot.rig.links)
    links[spot.index] = replace(spot.link, far=base)
    frequency = spot.angular * spot.between(0, 1.2, 2.0)
    mass = (*spot.rig.mass, wall / frequency**2)
    return World(replace(spot.rig, mass=mass, links=(*links, Link(base, -1, wall, 0.0))))


def _carried(spot, size):
    mass = list(spot.rig.mass)
    mass[spot.index] *= 1 + size
    return World(replace(spot.rig, mass=tuple(mass)))


def _held(spot, size):
    stiffness = size * spot.rig.links[spot.index].stiffness
    return World(replace(spot.rig, links=(*spot.rig.links, Link(spot.index, -1, stiffness, 0.0))))


def _at_shaker(force, states=0, rates=None):
    """A law along the push of the shaker."""
    def build(spot, size):
        row = np.eye(len(spot.rig.mass))[spot.rig.pushed]
        return World(spot.rig, (Law(row, force(spot, size), states, rates and rates(spot, size)),))
    return build


def _ripple(spot, size):
    angular, phase = spot.angular * spot.between(0, 0.5, 0.9), 6 * spot.shape[1]
    return lambda t, e, v, z: -size * spot.force * np.cos(angular * t - phase)


def _leaking(spot, size):
    """The mass loses what it holds at a steady rate and without thrust."""
    mass, where = np.array(spot.rig.mass), np.arange(len(spot.rig.mass)) == spot.index
    return World(spot.rig, mass=lambda t: mass * (1 - where * min(0.5 * size, 0.9) * t / spot.time))


def _bouncing(spot, size):
    """A hard stop in front of a mass: it rebounds with 0.7 of its speed (I. Newton)."""
    wall = spot.length / size

    def jump(x, v):
        turned = v.copy()
        if x[spot.index] > wall and v[spot.index] > 0:
            turned[spot.index] *= -0.7
        return turned

    return World(spot.rig, jump=jump)


def _magnet(spot, size):
    """Two magnets beside a link pull it over: the force grows without bound towards them."""
    reach = 6 * spot.length
    return lambda t, e, v, z: -0.5 * size * spot.force * reach**2 * (
        1 / max(reach - e, 0.1 * reach) ** 2 - 1 / max(reach + e, 0.1 * reach) ** 2)


def _modulated(spot, size):
    angular, phase = spot.angular * spot.between(0, 0.3, 1.5), 6 * spot.shape[1]
    return lambda t, e, v, z: 0.5 * size * spot.link.stiffness * np.cos(angular * t + phase) * e


def _rough(spot, size):
    """Friction that changes from place to place."""
    return lambda t, e, v, z: size * spot.force * (1 + 0.8 * np.sin(3 * e / spot.length)) * _dry(spot, v)


def _dithered(spot, size):
    """Dry friction under a vibration across: the friction force is turned out of the way (Thomsen 1999)."""
    return lambda t, e, v, z: size * spot.force * v / np.hypot(v, 0.7 * spot.speed)


def _dwelling(spot, size):
    """Friction that grows while the contact rests and is worn down by sliding (Dieterich 1979, ageing)."""
    return lambda t, e, v, z: size * spot.force * (1 + 3 * z[0]) * _dry(spot, v)


def _dwelling_rates(spot, size):
    def rates(t, e, v, z):
        return np.array([(1 - z[0]) * np.exp(-abs(v) / (0.1 * spot.speed)) * 8 * spot.angular
                         - z[0] * abs(v) / (0.3 * spot.length)])
    return rates


def _channel(**change):
    return lambda spot, size: Chain(**{name: value(spot, size) for name, value in change.items()})


_PIECES = (
    Hidden("coulomb", "link", _along(lambda s, size: lambda t, e, v, z: size * s.force * _dry(s, v))),
    Hidden("asymmetric_friction", "link", _along(
        lambda s, size: lambda t, e, v, z: size * s.force * max(_dry(s, v), 0.0))),
    Hidden("joint_damping", "link", _drag(1), exact="damping"),
    Hidden("cubic_stiffness", "link", _polynomial(3)),
    Hidden("quadratic_stiffness", "link", _polynomial(2)),
    Hidden("quadratic_damping", "link", _drag(2)),
    Hidden("hysteretic_joint", "link", _along(_slip_force, len(_SLIDERS), _slip_rates)),
    Hidden("backlash", "link", _along(_backlash)),
    Hidden("viscoelastic_pad", "link", _branches(
        lambda s: [1.0], lambda s: np.array([s.between(0, 0.5, 2) / s.angular])), timed=True),
    Hidden("shim_damping", "link", _branches(
        lambda s: np.full(len(_SHIM), _OF_SHIM), lambda s: _SHIM / s.angular, _HELD), exact="stiffness", timed=True),
    Hidden("thermal_softening", "link", _along(
        lambda s, size: lambda t, e, v, z: -min(size, 0.8) * s.link.stiffness * e
        * (1 - np.exp(-t / (s.time * s.between(0, 0.2, 0.8)))))),
    Hidden("base_shake", "link", _along(_shaken)),
    Hidden("compliant_arm", "link", _arm, exact="stiffness"),
    Hidden("moving_base", "wall link", _base),
    Hidden("attached_mass", "mass", _carried, exact="mass"),
    Hidden("added_stiffness", "mass", _held, exact="stiffness"),     # beside a wall link it is that link's stiffness
    Hidden("pressure_ripple", "shaker", _at_shaker(_ripple)),
    Hidden("hydraulic_compliance", "shaker", _at_shaker(
        lambda s, size: lambda t, e, v, z: z[0], 1, lambda s, size: lambda t, e, v, z: np.array(
            [size * s.link.stiffness * v - z[0] / (s.between(0, 1, 3) / s.angular)]))),
    Hidden("sensor_gain", "channel", _channel(gain=lambda s, size: 1 + size)),
    Hidden("sensor_delay", "channel", _channel(delay=lambda s, size: size / s.angular)),
    Hidden("sensor_offset_drift", "channel", _channel(
        offset=lambda s, size: size * s.length, drift=lambda s, size: size * (s.shape[0] - 0.5) * s.length / s.time)),
    Hidden("clipping", "channel", _channel(limit=lambda s, size: 2 * s.length / size)),
    Hidden("film_drag", "link", _drag(1.5), known=False),
    Hidden("parametric_stiffness", "link", _along(_modulated)),
    Hidden("impact", "mass", _bouncing),
    Hidden("magnetic_softening", "link", _along(_magnet), known=False),
    Hidden("fractional_damping", "link", _branches(
        lambda s: _fractional_weights(0.5), lambda s: _DECADES / s.angular), known=False),
    Hidden("leaking_mass", "mass", _leaking, known=False),
    Hidden("rough_friction", "link", _along(_rough), known=False),
    Hidden("dithered_friction", "link", _along(_dithered), known=False),
    Hidden("dwell_friction", "link", _along(_dwelling, 1, _dwelling_rates), known=False),
    Hidden("quintic_stiffness", "link", _polynomial(5), known=False),
)
HIDDEN = {piece.name: piece for piece in _PIECES}
