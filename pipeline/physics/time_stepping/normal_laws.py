"""Normal laws of the contacts in time stepping, what they ask of gap and force, and their form for compiled steps."""

from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.contact.closure_law import damping_at_rest, force_at_rest, penalty_forces, table_forces
from pipeline.physics.contact.groups import parts, read
from pipeline.physics.friction.friction_table import straight_slope
from pipeline.physics.time_stepping.contact_solver import HARD, LAGRANGE, PENALTY, TABLE, NormalKernel, yielding_force


@dataclass(frozen=True)
class Hard:
    """Contacts that do not yield: Moreau-Jean, with Newton's restitution; ``gap`` () or (c,) m at rest."""

    restitution: float = 0.0
    gap: np.ndarray | float = 0.0


@dataclass(frozen=True)
class Penalty:
    """N = stiffness c + damping c' of ``closure_law``; each () or (c,), in N/m and N s/m.

    With a ``gamma`` bodies and contacts are stepped by Newmark's rule, as FE codes do, instead of exactly.
    """

    stiffness: np.ndarray | float
    damping: np.ndarray | float = 0.0
    gap: np.ndarray | float = 0.0
    gamma: float | None = None


@dataclass(frozen=True)
class Table:
    """The table of ``closure_law``: ``closure`` (k,) m and ``pressure`` (k,) Pa, both rising from 0.

    ``smooth``: the rows sample a curve closely, so that the slope for small motions does not jump at them.
    """

    closure: np.ndarray
    pressure: np.ndarray
    damping_speed: float = np.inf
    gap: np.ndarray | float = 0.0
    smooth: bool = False

    def at(self, closure):
        """Pressure (n,) at closures (n,) m."""
        return force_at_rest(closure, np.ones_like(closure), self.closure, self.pressure)[0]


@dataclass(frozen=True)
class Lagrange:
    """Contacts that do not yield, by multipliers on displacements under Newmark's rule with this ``gamma``."""

    gamma: float = 0.5
    gap: np.ndarray | float = 0.0


@dataclass(frozen=True)
class Forward:
    """Contacts that do not yield, by forward increments: the impulse at the begin of a step closes the gap at its end.

    Carpenter, Taylor & Katona (Int. J. Numer. Meth. Engng 32 (1991) 103), whose central differences are replaced by
    the exact linear part; rigid friction acts with it. Impacts come to rest within two steps.
    """

    gap: np.ndarray | float = 0.0


def normal_kernel(law, contacts):
    """NormalKernel of a law of Contacts, Grouped or not. ConfigError for values and mixtures that cannot be."""
    count = len(contacts.area)
    laws = parts(law, count)
    kinds = {type(each) for each, _ in laws}
    if len(kinds) > 1 and (kinds != {Penalty, Table} or any(getattr(each, "gamma", None) for each, _ in laws)):
        raise ConfigError("time stepping: laws of contact groups", "laws of one type, or Penalty and Table without"
                          " gamma", ", ".join(sorted(k.__name__ for k in kinds)))
    for each, _ in laws:
        _check_law(each)
    shared = {(getattr(each, "restitution", 0.0), getattr(each, "gamma", None)) for each, _ in laws}
    if len(shared) > 1:
        raise ConfigError("time stepping: laws of contact groups", "one restitution and one gamma", "several")
    restitution, gamma = shared.pop()
    tables = [(each, members) for each, members in laws if isinstance(each, Table)]
    closure, pressure, first = _stacked_tables(tables, count, fill=-1 if tables else 0)
    kind = {Hard: HARD, Penalty: PENALTY, Table: TABLE, Lagrange: LAGRANGE, Forward: LAGRANGE}[
        Table if tables else kinds.pop()]
    fixed = contacts.fixed
    return NormalKernel(kind, np.where(fixed, 0.0, read(law, "gap", count)),
                        np.where(fixed, contacts.preload, -1.0), contiguous(contacts.area),
                        read(law, "stiffness", count, 0.0), read(law, "damping", count, 0.0), closure, pressure, first,
                        read(law, "damping_speed", count, np.inf), float(restitution), gamma is not None)


def _check_law(law):
    if isinstance(law, Table) and (len(law.closure) < 2 or law.closure[0] != 0 or law.pressure[0] != 0
                                   or np.any(np.diff(law.closure) <= 0) or np.any(np.diff(law.pressure) <= 0)):
        raise ConfigError("time stepping: normal law", "closure and pressure that rise from 0", "another table")
    if isinstance(law, Hard) and not 0 <= law.restitution <= 1:
        raise ConfigError("time stepping: restitution", "between 0 and 1", f"{law.restitution:g}")
    gamma = getattr(law, "gamma", None)
    if gamma is not None and not 0.5 <= gamma <= 1:
        raise ConfigError("time stepping: gamma", "between 0.5 and 1", f"{gamma:g}")
    if isinstance(law, Penalty) and not np.all(np.asarray(law.stiffness) > 0):
        raise ConfigError("time stepping: contact stiffness", "above 0", f"{np.min(law.stiffness):g} N/m")


def _stacked_tables(tables, count, fill):
    """(closure (k,), pressure (g k,), first (c,)) of Tables [(law, contacts)] on the closures of all."""
    first = np.full(count, fill, np.int64)
    if not tables:
        return np.array([0.0, 1.0]), np.array([0.0, 1.0]), first
    closure = contiguous(tables[0][0].closure)
    if len(tables) > 1:
        closure = np.unique(np.concatenate([table.closure for table, _ in tables]))
    for k, (_, members) in enumerate(tables):
        first[members] = k * len(closure)
    return closure, np.concatenate([table.at(closure) for table, _ in tables]), first


def normal_force(kernel, gap, rate):
    """Force (c,) of contacts that yield at gaps (c,) and opening rates (c,), and which of them yield."""
    yields = np.full(len(gap), kernel.kind in (PENALTY, TABLE))
    return np.array([yielding_force(kernel, i, -gap[i], -rate[i])[0] if yields[i] else 0.0
                     for i in range(len(gap))]), yields


def first_slopes(kernel):
    """Stiffness (c,) N/m of the contacts of a NormalKernel, all of which yield, where they have just closed."""
    tabled, first = kernel.first >= 0, np.maximum(kernel.first, 0)
    rise = (kernel.pressure[first + 1] - kernel.pressure[first]) / (kernel.closure[1] - kernel.closure[0])
    return np.where(tabled & (kernel.kind == TABLE), kernel.area * rise, kernel.stiffness)


def closing(law, force, area):
    """(slope, rest) (c,) of the closure of contacts about their ``force``: c = slope N + rest; 0 where none yields."""
    slope, rest = np.zeros((2, len(force)))
    for each, members in parts(law, len(force)):
        if isinstance(each, Penalty):
            slope[members] = np.broadcast_to(1 / np.asarray(each.stiffness, float), len(force))[members]
        elif isinstance(each, Table):
            closure, pressure, k = _row(each, force[members] / area[members])
            give = (closure[k + 1] - closure[k]) / (pressure[k + 1] - pressure[k])
            slope[members], rest[members] = give / area[members], closure[k] - give * pressure[k]
    return slope, rest


def tangent(law, force, area):
    """(stiffness, damping) (c,) about the ``force`` on contacts, 0 where open; ConfigError where one cannot yield."""
    stiffness, damping = np.zeros((2, len(force)))
    for each, members in parts(law, len(force)):
        if isinstance(each, Penalty):
            stiffness[members], damping[members] = (np.broadcast_to(v, len(force))[members]
                                                    for v in (each.stiffness, each.damping))
        elif isinstance(each, Table):
            stiffness[members] = area[members] * _slope(each, force[members] / area[members])
            damping[members] = damping_at_rest(force[members], each.damping_speed)
        elif np.any(force[members] > 0):
            raise ConfigError("small motions about steady sliding", "contacts that yield", type(each).__name__,
                              "give them a stiffness")
    return tuple(np.where(force > 0, each, 0.0) for each in (stiffness, damping))


def _slope(table, pressure):
    """Pa/m at ``pressure`` (c,)."""
    closure, known, k = _row(table, pressure)
    if table.smooth:
        return 1 / straight_slope(known, closure, pressure)
    return (known[k + 1] - known[k]) / (closure[k + 1] - closure[k])


def _row(table, pressure):
    """(closures, pressures, rows before ``pressure``) of a Table."""
    known = np.asarray(table.pressure, float)
    k = np.clip(np.searchsorted(known, pressure, side="right") - 1, 0, len(known) - 2)
    return np.asarray(table.closure, float), known, k


def force_along(law, i, area, closure, closing):
    """Normal force (...) of contact ``i`` along closures (...) m, below 0 where open, and closing rates (...) m/s.

    ``area`` is that of all contacts. ConfigError where the contact does not yield.
    """
    each = next(each for each, members in parts(law, len(area)) if i in members)
    shape = np.shape(closure)
    motion = contiguous(np.broadcast_to(closure, shape).ravel()), contiguous(np.broadcast_to(closing, shape).ravel())
    if isinstance(each, Penalty):
        given = (float(np.broadcast_to(v, len(area))[i]) for v in (each.stiffness, each.damping))
        return penalty_forces(*motion, *given)[0].reshape(shape)
    if not isinstance(each, Table):
        raise ConfigError(f"contact {i}", "one that yields", type(each).__name__, "give it a stiffness, or simulate")
    return table_forces(*motion, np.full(len(motion[0]), float(area[i])), contiguous(each.closure),
                        contiguous(each.pressure), float(each.damping_speed))[0].reshape(shape)


def contiguous(values):
    """A writable, contiguous copy: one type of array for all compiled calls."""
    return np.array(values, dtype=float, order="C")
