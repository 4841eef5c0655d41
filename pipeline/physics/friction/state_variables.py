"""What friction remembers: states of a contact that grow and decay while it slides, and what they do to friction.

Every state obeys x' = s - r x, with s and r from the load N, the slip speed v >= 0, the friction force T and the area
A of the contact:

    memory    s = (v / L) (N, v), r = v / L            T = mu x_N, mu read at the load x_N and the speed x_v
    evolving  s, r = a + b v + c p v + d q             mu f(x), p = N / A, q = |T| v / A; f of four forms
    healing   s = v_0 / L,        r = v / L            mu (1 + b ln(1 + x)), x = v_0 theta / L: Dieterich's ageing law
    distance  s = v,              r = 0                mu is read at the distance x
    film      s = v p / (d p_0),  r = v / d            mu (1 + g x), p = N / A
    fade      s = |T| v / (A q tau), r = 1 / tau       mu / (1 + d x)
    plateaus  s = (1 + k) / tau,  r = (1 + k p v / q) / tau     mu x
    scatter   none                                     mu (1 + a cos(n angle - phase))

Healing, film, fade and plateaus evolve; a law of one's own is one more ``Evolving``, whose slopes follow from it.
"""

from dataclasses import astuple, dataclass, replace

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.contact.groups import Grouped, parts
from pipeline.physics.friction.dry_friction import LOAD_KEPT, LOAD_SHARE, coefficient, coefficients, kernel
from pipeline.physics.friction.state_kernels import (
    AT_REST,
    DISTANCE,
    EVOLVING,
    INVERSE,
    ITSELF,
    LINEAR,
    LOGARITHMIC,
    MEMORY,
    PARAMETERS,
    SCATTER,
    StateKernel,
    expect,
    factor,
    settle,
    settles,
    source_and_rate,
)
from pipeline.physics.numerics.compiled import njit


@dataclass(frozen=True)
class Memory:
    """Load and slip speed reach friction over the sliding way ``length`` m (V. Prakash, J. Tribol. 120 (1998) 97)."""

    length: float


@dataclass(frozen=True)
class Evolving:
    """A state x' = s - r x, ``source`` s and ``rate`` r 1/s being sums over (1, v, p v, q), and friction times f(x).

    v m/s, p v and q W/m^2 as above; ``form``: LINEAR 1 + g x, LOGARITHMIC 1 + g ln(1 + x), INVERSE 1 / (1 + g x) or
    ITSELF x, with the ``gain`` g. ``settles``: motions begin where it has come to rest in steady sliding, s / r without
    heat, or ``at_rest`` where nothing lets it go; else at 0.
    """

    source: tuple[float, float, float, float]
    rate: tuple[float, float, float, float]
    form: int = LINEAR
    gain: float = 1.0
    settles: bool = True
    at_rest: float = 0.0

    def __post_init__(self):
        if self.settles and (self.source[3] or self.rate[3]):
            raise ConfigError("friction states", "no heat where a state settles, as that is not yet known there",
                              "a source or a rate by heat", "set settles to False")

    @property
    def parameters(self):
        """Row of a StateKernel."""
        return (*self.source, *self.rate, self.form, self.gain, float(self.settles), self.at_rest)


@dataclass(frozen=True)
class Healing:
    """Friction grows with the age of the contact: ``share`` b, ``speed`` v_0 m/s, ``length`` L m."""

    share: float
    speed: float
    length: float

    @property
    def law(self):
        """Evolving."""
        return Evolving((self.speed / self.length, 0.0, 0.0, 0.0), (0.0, 1 / self.length, 0.0, 0.0), LOGARITHMIC,
                        self.share, at_rest=1.0)


@dataclass(frozen=True)
class Distance:
    """The table of friction is read at the way slid so far, from ``Friction.distance`` on."""


@dataclass(frozen=True)
class Film:
    """A film that grows over the way ``length`` m to p / ``pressure`` (Pa) and adds ``gain`` times itself."""

    gain: float
    length: float
    pressure: float

    @property
    def law(self):
        """Evolving."""
        return Evolving((0.0, 0.0, 1 / (self.length * self.pressure), 0.0), (0.0, 1 / self.length, 0.0, 0.0), LINEAR,
                        self.gain, settles=False)


@dataclass(frozen=True)
class Fade:
    """A temperature with the time constant ``time`` s, 1 under ``heat`` W/m^2, and friction that falls by ``drop``."""

    drop: float
    heat: float
    time: float

    @property
    def law(self):
        """Evolving."""
        return Evolving((0.0, 0.0, 0.0, 1 / (self.heat * self.time)), (1 / self.time, 0.0, 0.0, 0.0), INVERSE,
                        self.drop, settles=False)


@dataclass(frozen=True)
class Plateaus:
    """Contact plateaus that friction power wears off: ``strength`` k, ``heat`` q W/m^2, ``time`` tau s."""

    strength: float
    heat: float
    time: float

    @property
    def law(self):
        """Evolving."""
        return Evolving(((1 + self.strength) / self.time, 0.0, 0.0, 0.0),
                        (1 / self.time, 0.0, self.strength / (self.heat * self.time), 0.0), ITSELF)


@dataclass(frozen=True)
class Scatter:
    """Friction that varies around the drive: ``amplitude``, ``order``, ``phase`` rad, () or (c,)."""

    amplitude: float
    order: float
    phase: np.ndarray | float


_KIND = {Memory: MEMORY, Distance: DISTANCE, Scatter: SCATTER, Evolving: EVOLVING}


def state_kernel(friction, area):
    """StateKernel of a Friction, or of Grouped ones, for contacts of ``area`` (c,) m^2."""
    rows, begin = [], np.zeros(len(area))
    for law, members in parts(friction, len(area)):
        begin[members] = law.distance
        for state in law.states:
            state, values = getattr(state, "law", state), np.zeros((len(area), PARAMETERS))
            for k, value in enumerate(getattr(state, "parameters", None) or astuple(state)):
                values[:, k] = value
            rows += [(_KIND[type(state)], i, *values[i]) for i in members]
    rows = np.array(rows, float).reshape(-1, 2 + PARAMETERS)
    if not np.isfinite(rows).all():
        raise ConfigError("friction states", "finite values", str(rows[~np.isfinite(rows).all(axis=1), 2:]))
    return StateKernel(rows[:, 0].astype(np.int64), rows[:, 1].astype(np.int64), np.array(rows[:, 2:]),
                       np.array(area, float), begin)


def started(states, load, speed):
    """States (k, 2) of contacts under ``load`` (c,) N that slide steadily at ``speed`` (c,) m/s, of either sign.

    Films are not yet there, heat neither; what starts at rest has just come to rest from the speed v_0 of its law.
    """
    value, settled = np.zeros((len(states.kind), 2)), settles(states)
    for k, (kind, i) in enumerate(zip(states.kind, states.contact, strict=True)):
        swift = abs(speed[i])
        if kind == MEMORY:
            value[k] = load[i], swift
        elif kind == DISTANCE:
            value[k, 0] = states.begin[i]
        elif settled[k]:
            source, rate = source_and_rate(kind, states.parameter[k], load[i], states.area[i], swift, 0.0)
            value[k, 0] = source / rate if rate > 0 else states.parameter[k, AT_REST]
    return value


def factors(states, value, angle):
    """Factor (c,) of states (k, 2) on friction, the drive standing at ``angle`` rad."""
    product = np.ones(len(states.area))
    for k, (kind, i) in enumerate(zip(states.kind, states.contact, strict=True)):
        product[i] *= factor(kind, states.parameter[k], value[k, 0], angle)
    return product


def shapeless(friction):
    """The friction without what varies around the drive."""
    def still(law):
        return replace(law, states=tuple(s for s in law.states if not isinstance(s, Scatter)))

    if isinstance(friction, Grouped):
        return replace(friction, laws=tuple(still(law) for law in friction.laws))
    return still(friction)


def friction_along(friction, area, load, slip, angle, interval):
    """Friction force (c, samples) N along given loads (c, samples) N and slip speeds of either sign, in full sliding.

    ``angle`` (samples,) rad of the drive, ``interval`` s between samples; states start as ``started`` says.
    """
    states = state_kernel(friction, area)
    if not len(states.kind):
        return np.sign(slip) * coefficients(friction, slip, load / area[:, None]) * load
    value = started(states, load[:, 0], slip[:, 0])
    return _along(states, value, kernel(friction, len(area)), load, slip, np.array(angle, float), float(interval))


@njit
def _along(states, value, friction, load, slip, angle, interval):
    drawn, forces, last = np.zeros_like(load), np.zeros(load.shape[0]), load.shape[1] - 1
    for s in range(last + 1):
        # over no time: friction as the states stand
        expect(states, value, friction, load[:, s], slip[:, s], forces, angle[s], angle[s], 0.0, False)
        for i in range(load.shape[0]):
            j = friction.contact[i]
            heard = j[LOAD_KEPT] + j[LOAD_SHARE] * load[i, s]
            drawn[i, s] = np.sign(slip[i, s]) * heard * coefficient(friction, i, heard / states.area[i], slip[i, s],
                                                                    slip[i, s])
        if s < last:
            for i in range(load.shape[0]):
                forces[i] = drawn[i, s] * (0.5 * (load[i, s] + load[i, s + 1]) / load[i, s] if load[i, s] > 0 else 1.0)
            settle(states, value, load[:, s], load[:, s + 1], slip[:, s], slip[:, s + 1], forces, interval)
    return drawn
