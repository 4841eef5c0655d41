"""Dry friction for time stepping: a characteristic mu(pressure, slip speed) and three descriptions of sticking.

Allgaier, Gaul, Keiper & Willner, Mode lock-in and friction modelling (1999), section 4, with the limit L = mu N, the
friction force T on the body and the slip s of the drive against it:

- ``evolution``: dT/ds = k (1 - T / L)^m for ds > 0 (mirrored for ds < 0), gradual from micro- to macroslip;
- ``elastic``: T = k s while |T| < L, sliding at |T| = L (penalty);
- ``rigid``: no slip while |T| < L (Lagrange multiplier).

A contact that sticks is held up to ``static_factor`` times mu at slip speed 0; one that slides sticks again as soon as
mu itself can hold it.
"""

import operator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.contact.groups import Grouped, parts, read
from pipeline.physics.friction.friction_table import AXES, FrictionLaw, friction_at
from pipeline.physics.numerics.compiled import borrowing, njit

RIGID, ELASTIC, EVOLUTION = 0, 1, 2
DESCRIPTIONS = {"rigid": RIGID, "elastic": ELASTIC, "evolution": EVOLUTION}
#: samples of a falling characteristic per decay speed, and decay speeds that its table spans
_SAMPLES, _SPAN = 100, 20
#: under the evolution rule a contact slides where the slope of T over s is below this share of its stiffness
SLIDING_SLOPE = 0.01
#: columns of FrictionKernel.contact. What friction hears of load and slip speed is kept + share x (value of the step);
#: DELAYED is 1 where that is not the present load and speed
(FIRST, READ_AT, STATIC, BACKWARD, STIFFNESS, EXPONENT, FACTOR, DELAYED, LOAD_KEPT, LOAD_SHARE, SPEED_KEPT,
 SPEED_SHARE) = range(12)


@dataclass(frozen=True)
class Condition:
    """Friction times 1 + ``slope`` (value - ``reference``), never below 0, ``name`` being a condition of the run."""

    name: str
    slope: float
    reference: float


@dataclass(frozen=True)
class Friction:
    """Friction of all contacts, or, within Grouped, of some.

    ``law`` is read at ``distance`` (m); ``stiffness`` (c,) or () N/m is the tangential stiffness of the elastic and
    the evolution description, ``exponent`` the m of the latter; ``backward``: mu of slip below 0 over that of slip
    above 0; ``states``: laws of ``friction_states``, whose factors come on top of ``law``; ``conditions``: each a
    Condition, which ``under`` brings in.
    """

    law: FrictionLaw
    static_factor: float = 1.0
    description: str = "rigid"
    stiffness: np.ndarray | float = 0.0
    exponent: float = 1.0
    distance: float = 0.0
    backward: float = 1.0
    states: tuple = ()
    conditions: tuple = ()

    def __post_init__(self):
        if self.description not in DESCRIPTIONS:
            raise ConfigError("friction: description", f"one of {', '.join(DESCRIPTIONS)}", repr(self.description))
        if np.any(self.law.friction < 0):
            raise ConfigError("friction: coefficient", "no value below 0", f"{np.min(self.law.friction):g}")
        if self.static_factor < 1:
            raise ConfigError("friction: static_factor", "at least 1", f"{self.static_factor:g}")
        if self.description != "rigid" and not np.all(np.asarray(self.stiffness) > 0):
            raise ConfigError("friction: stiffness", f"above 0 for the {self.description} description",
                              str(self.stiffness))
        if not (self.exponent > 0 and self.backward >= 0):
            raise ConfigError("friction: exponent, backward", "above 0, and at least 0",
                              f"{self.exponent:g}, {self.backward:g}")

    def with_state(self, state):
        """The friction with one more state."""
        return replace(self, states=(*self.states, state))

    def at_speed(self, speed, pressure=0.0):
        """Coefficient at sliding speeds (m/s, either sign)."""
        value = self.law.evaluate(pressure, np.abs(speed), self.distance)[0]
        return value if self.backward == 1 else np.where(np.asarray(speed) < 0, self.backward, 1.0) * value


def under(friction, given, where):
    """The Friction, Grouped or not, under conditions ``given`` {name: value}. ConfigError at ``where`` for those that
    it asks for and does not find.
    """
    if isinstance(friction, Grouped):
        laws = tuple(under(law, given, where) for law in friction.laws)
        return friction if all(map(operator.is_, laws, friction.laws)) else replace(friction, laws=laws)
    factor = 1.0
    for condition in friction.conditions:
        value = given.get(condition.name)
        if value is None or np.ndim(value) or not np.isfinite(value):
            raise ConfigError(f"{where}: condition {condition.name}", "one value, on which friction depends",
                              "none" if value is None else str(value), "add it to the run")
        factor *= max(1.0 + condition.slope * (float(value) - condition.reference), 0.0)
    if not friction.conditions:
        return friction
    return replace(friction, law=replace(friction.law, friction=factor * friction.law.friction), conditions=())


class FrictionKernel(NamedTuple):
    """What the compiled loops need of the friction of c contacts: tables of g laws on common axes, stacked."""

    pressure: np.ndarray    # (P,)
    speed: np.ndarray       # (V,)
    distance: np.ndarray    # (S,)
    table: np.ndarray       # (g P, V, S)
    contact: np.ndarray     # (c, 12) the columns FIRST to SPEED_SHARE
    description: int


def constant(coefficient, **options):
    """Friction with one coefficient at all pressures and speeds; ``options`` as of Friction."""
    return Friction(FrictionLaw([0.0], [0.0], [0.0], [[[coefficient]]]), **options)


def tabulated(speed, coefficient, **options):
    """Friction over slip speed ``speed`` (v,) m/s from 0: linear between, constant beyond."""
    return Friction(FrictionLaw([0.0], speed, [0.0], np.reshape(coefficient, (1, -1, 1))), **options)


def falling(static, kinetic, decay_speed, **options):
    """Friction kinetic + (static - kinetic) exp(-|v| / decay_speed), as a table within 2e-5 of static - kinetic.

    One value where both are the same: tables over pressure and distance, which effects add, multiply its size.
    """
    if static == kinetic:
        return constant(kinetic, **options)
    if not decay_speed > 0:
        raise ConfigError("friction: decay_speed", "above 0", f"{decay_speed:g}")
    over = np.linspace(0, _SPAN, _SPAN * _SAMPLES + 1)
    return tabulated(decay_speed * over, kinetic + (static - kinetic) * np.exp(-over), **options)


def kernel(friction, contacts):
    """FrictionKernel of a Friction, or of Grouped ones, for so many contacts. ConfigError for mixed descriptions."""
    laws = parts(friction, contacts)
    if any(law.conditions for law, _ in laws):
        raise ConfigError("friction", "conditions that are given", "some that are not", "take `under` first")
    described = {law.description for law, _ in laws}
    if len(described) > 1:
        raise ConfigError("friction of contact groups", "one description for all contacts",
                          " and ".join(sorted(described)))
    contact = np.zeros((contacts, SPEED_SHARE + 1))
    for column, name in ((READ_AT, "distance"), (STATIC, "static_factor"), (BACKWARD, "backward"),
                         (STIFFNESS, "stiffness"), (EXPONENT, "exponent")):
        contact[:, column] = read(friction, name, contacts)
    contact[:, [FACTOR, LOAD_SHARE, SPEED_SHARE]] = 1.0
    axes, tables = common([law.law for law, _ in laws])
    for k, (_, members) in enumerate(laws):
        contact[members, FIRST] = k * len(axes[0])
    return FrictionKernel(*axes, np.concatenate(tables), contact, DESCRIPTIONS[described.pop()])


def at_one_distance(kernel):
    """The same FrictionKernel with tables at the distance where all contacts read them; itself where they differ."""
    place, axis = kernel.contact[:, READ_AT], kernel.distance
    if len(axis) == 1 or not len(place) or (place != place[0]).any():
        return kernel
    low = min(max(int(np.searchsorted(axis, place[0], side="right")) - 1, 0), len(axis) - 2)
    weight = min(max((place[0] - axis[low]) / (axis[low + 1] - axis[low]), 0.0), 1.0)
    table = kernel.table[..., low] * (1.0 - weight) + kernel.table[..., low + 1] * weight
    return kernel._replace(distance=np.array([place[0]]), table=np.ascontiguousarray(table[..., None]))


def common(laws):
    """(axes, tables) of FrictionLaws on the axes that hold the values of all."""
    if len(laws) == 1:
        *axes, table = (np.array(part) for part in laws[0].table)
        return axes, [table]
    axes = [np.unique(np.concatenate([getattr(law, name) for law in laws])) for name in AXES]
    return axes, [law.on(*axes).friction for law in laws]


def coefficients(friction, speed, pressure):
    """mu (c,) or (c, samples) at sliding speeds of either sign (m/s) and pressures (Pa) of that shape."""
    speed, pressure = np.broadcast_arrays(speed, pressure)
    values = np.empty(speed.shape)
    for law, members in parts(friction, len(values)):
        values[members] = law.at_speed(speed[members], pressure[members])
    return values


@borrowing
def coefficient(friction, i, pressure, speed, sign):
    """mu of contact ``i`` at a pressure and a slip speed whose sign counts as ``sign``."""
    if friction.table.size == 1:
        mu = friction.contact[i, FACTOR] * friction.table[0, 0, 0]
        return mu * friction.contact[i, BACKWARD] if sign < 0 else mu
    return characteristic(friction, i, pressure, speed, friction.contact[i, READ_AT], sign)[0]


@borrowing(inline="always")
def characteristic(friction, i, pressure, speed, distance, sign):
    """(mu, dmu/dpressure in 1/Pa, dmu/dspeed in s/m, outside) of contact ``i`` of a FrictionKernel.

    At a ``pressure`` Pa, a slip ``speed`` m/s whose sign counts as ``sign``, and a sliding ``distance`` m; ``outside``
    is 1 where the table does not reach.
    """
    contact = friction.contact
    factor = contact[i, FACTOR]
    if sign < 0:
        factor *= contact[i, BACKWARD]
    heard = contact[i, SPEED_KEPT] + contact[i, SPEED_SHARE] * abs(speed)
    mu, by_pressure, by_speed, outside = friction_at(pressure, heard, distance, friction.pressure, friction.speed,
                                                     friction.distance, friction.table, int(contact[i, FIRST]))
    return factor * mu, factor * by_pressure, factor * contact[i, SPEED_SHARE] * by_speed, outside


@borrowing
def elastic_stick(force, slip, limit, stiffness):
    """(T, dT/ds) after a slip increment from ``force``: a spring that slides at the limit."""
    trial = force + stiffness * slip
    if abs(trial) <= limit:
        return trial, stiffness
    return np.sign(trial) * limit, 0.0


@borrowing
def evolution_rule(force, slip, limit, stiffness, exponent):
    """(T, dT/ds) after a slip increment from ``force``: dT/ds = k (1 - T sgn(s) / L)^m integrated exactly.

    With r = 1 - T sgn(s) / L, dr/d|s| = -(k / L) r^m: r = r0 exp(-k |s| / L) for m = 1, else
    r^(1 - m) = r0^(1 - m) + (m - 1) k |s| / L, which reaches full sliding, r = 0, where m < 1 (m = 1/3: one
    Hertz contact, Cattaneo and Mindlin).
    """
    if limit <= 0.0:
        return 0.0, 0.0
    sign = 1.0 if slip >= 0 else -1.0
    missing = max(1.0 - min(max(force, -limit), limit) * sign / limit, 0.0)
    way = stiffness * abs(slip) / limit
    if missing > 0.0:
        if exponent == 1.0:
            missing *= np.exp(-way)
        else:
            base = 1.0 + (exponent - 1.0) * way * missing ** (exponent - 1.0)
            missing = missing * base ** (-1.0 / (exponent - 1.0)) if base > 0.0 else 0.0
    return sign * limit * (1.0 - missing), stiffness * missing**exponent


@njit
def evolution_curve(displacement, limit, stiffness, exponent):
    """Forces (d,) of the evolution rule at the slips ``displacement`` (d,) from rest."""
    force = np.empty(len(displacement))
    for k in range(len(displacement)):
        force[k] = evolution_rule(0.0, displacement[k], limit, stiffness, exponent)[0]
    return force
