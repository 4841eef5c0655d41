"""Friction that a trial hides in a contact on a belt, written from its own laws.

The belt drags a body with T(slip v, place x of the body, states z) under the load of a run,

    T = mu N f tanh(v / v_0),    f = 1 for the friction that the workshop knows,

``size`` 1 makes f change about as much as friction itself.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pipeline.blind_trial.generators.spring_mass.hidden_laws import Drawn

#: speed at which smoothed friction has 3/4 of its size, as a share of the typical slip
_SMOOTH = 3e-4


@dataclass(frozen=True)
class Rubbed:
    """A run of a contact: coefficient, load N and humidity."""

    friction: float
    load: float
    humidity: float


@dataclass(frozen=True)
class Contact(Drawn):
    """Where friction is hidden: typical slip ``speed`` m/s, ``length`` m of the motion, ``load`` N, ``time`` s of a
    run, a drawn ``shape`` (3,)."""

    speed: float
    length: float
    load: float
    time: float
    shape: tuple
    index: int = 0

    def sign(self, slip):
        """Smoothed sign of a slip."""
        return np.tanh(slip / (_SMOOTH * self.speed))


@dataclass(frozen=True)
class Drag:
    """``force(run, v, x, z)`` N along the belt, with ``states`` z that change by ``rates(run, v, T, z)``."""

    force: Callable
    states: int = 0
    rates: Callable | None = None


@dataclass(frozen=True)
class Friction:
    """One piece of friction: ``build(contact, size)`` -> Drag; ``tell(contact, size)`` its values in common words."""

    name: str
    build: Callable
    tell: Callable = lambda contact, size: {}
    known: bool = True
    place: str = "contact"
    exact: str = ""


def plain(contact, size=0.0):
    """Drag of the friction that the workshop knows."""
    return _times(lambda c, size: lambda run, v, x, z: 1.0)(contact, size)


def _times(factor, states=0, rates=None):
    """Builder of a Drag with ``factor(contact, size)`` -> f(run, v, x, z)."""
    def build(contact, size):
        share = factor(contact, size)

        def force(run, v, x, z):
            return run.friction * run.load * share(run, v, x, z) * contact.sign(v)

        return Drag(force, states, rates and rates(contact, size))
    return build


def _yielding(contact, size):
    """T' = k v (1 - |T| / mu N) towards the limit, k in proportion to the load."""
    stiffness = contact.load / _compliance(contact, size)

    def rates(run, v, drawn, z):
        limit = run.friction * run.load
        return np.array([stiffness * run.load / contact.load * v * (1 - np.sign(v) * drawn / limit)])

    return Drag(lambda run, v, x, z: z[0], 1, rates)


def _compliance(contact, size):
    """m, of the way over which friction under the typical load builds up, times the load."""
    return size * contact.length


def _ageing_rates(contact, size):
    """theta' = 1 - |v| theta / L (Dieterich 1979); 1 + z is theta in units of L over the typical speed, its begin."""
    length = _memory(contact)
    return lambda run, v, drawn, z: np.array([contact.speed / length - abs(v) / length * (1 + z[0])])


def _memory(contact):
    return 0.03 * contact.speed * contact.time * contact.between(0, 0.5, 2)


def _way(contact):
    return contact.speed * contact.time * contact.between(0, 0.2, 0.6)


def _late(contact):
    return contact.time * contact.between(0, 0.15, 0.5)


def _heat(contact):
    """Power of friction that makes a difference, W over the coefficient."""
    return contact.load * contact.speed


def _plateau_rates(contact, size):
    """tau x' = 1 + k - (1 + k p |v| / q) x (Ostermeyer 2003); x is 1 + k + z, what it comes to at rest."""
    def rates(run, v, drawn, z):
        worn = 1 + size * run.load * abs(v) / _heat(contact)
        return np.array([(1 + size - worn * (1 + size + z[0])) / _late(contact)])
    return rates


_PIECES = (
    Friction("falling_friction", _times(lambda c, size: lambda run, v, x, z: 1 + size * np.exp(
        -abs(v) / (c.speed * c.between(0, 0.3, 1)))),
        lambda c, size: {"rise": size, "decay_speed": c.speed * c.between(0, 0.3, 1)}),
    Friction("directional_friction", _times(lambda c, size: lambda run, v, x, z: 1 + min(size, 0.45) * c.sign(v)),
             lambda c, size: {"asymmetry": min(size, 0.45)}),
    Friction("viscous", _times(lambda c, size: lambda run, v, x, z: 1 + size * abs(v) / c.speed),
             lambda c, size: {"slope": size / c.speed}),
    Friction("pressure_dependent_friction", _times(lambda c, size: lambda run, v, x, z: (run.load / c.load) ** -size),
             lambda c, size: {"exponent": size}),
    Friction("contact_ageing", _times(lambda c, size: lambda run, v, x, z: 1 + size * np.log1p(max(1 + z[0], 0.0)), 1,
                                      _ageing_rates), lambda c, size: {"share": size}),
    Friction("friction_over_distance", _times(
        lambda c, size: lambda run, v, x, z: 1 + min(size, 0.9) * np.exp(-z[0] / _way(c)), 1,
        lambda c, size: lambda run, v, drawn, z: np.array([abs(v)])),
        lambda c, size: {"rise": min(size, 0.9), "distance": _way(c)}),
    Friction("thermal_fade", _times(
        lambda c, size: lambda run, v, x, z: 1 / (1 + size * z[0]), 1,
        lambda c, size: lambda run, v, drawn, z: np.array([(abs(drawn * v) / (0.3 * _heat(c)) - z[0]) / _late(c)])),
        lambda c, size: {"time": _late(c)}),
    Friction("third_body_film", _times(
        lambda c, size: lambda run, v, x, z: 1 + size * z[0], 1,
        lambda c, size: lambda run, v, drawn, z: np.array([abs(v) / _way(c) * (run.load / c.load - z[0])])),
        lambda c, size: {"distance": _way(c)}),
    Friction("plateau_dynamics", _times(lambda c, size: lambda run, v, x, z: 1 + size + z[0], 1, _plateau_rates),
             lambda c, size: {"time": _late(c)}),
    Friction("moisture", _times(lambda c, size: lambda run, v, x, z: 1 + size * (run.humidity - 0.5)),
             lambda c, size: {"slope": size}),
    Friction("micro_slip", _yielding, lambda c, size: {"compliance": _compliance(c, size) / c.load}),
    Friction("wedging", _times(lambda c, size: lambda run, v, x, z: max(1 + 0.5 * size * x / c.length, 0.0)),
             known=False),
    Friction("patchy", _times(lambda c, size: lambda run, v, x, z: 1 + min(size, 0.9) * np.sin(3 * x / c.length)),
             known=False),
    Friction("dithered", lambda c, size: Drag(
        lambda run, v, x, z: run.friction * run.load * v / np.hypot(v, (size + _SMOOTH) * c.speed)), known=False),
)
FRICTION = {piece.name: piece for piece in _PIECES}
