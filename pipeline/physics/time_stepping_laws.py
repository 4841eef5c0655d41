"""Normal laws of the contacts in time stepping, and their form for the compiled steps."""

from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.time_stepping_contact import HARD, LAGRANGE, PENALTY, TABLE, NormalKernel


@dataclass(frozen=True)
class Hard:
    """Contacts that do not yield: Moreau-Jean, with Newton's restitution; ``gap`` () or (c,) m at rest."""

    restitution: float = 0.0
    gap: np.ndarray | float = 0.0


@dataclass(frozen=True)
class Penalty:
    """N = stiffness c + damping c' at closure c, never below 0; each () or (c,), in N/m and N s/m.

    With a ``gamma`` bodies and contacts are stepped by Newmark's rule, as FE codes do, instead of exactly.
    """

    stiffness: np.ndarray | float
    damping: np.ndarray | float = 0.0
    gap: np.ndarray | float = 0.0
    gamma: float | None = None


@dataclass(frozen=True)
class Table:
    """N = A p(c) (1 + c' / damping_speed): ``closure`` (k,) m and ``pressure`` (k,) Pa, both rising from 0."""

    closure: np.ndarray
    pressure: np.ndarray
    damping_speed: float = np.inf
    gap: np.ndarray | float = 0.0


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
    """NormalKernel of a law for these contacts; ConfigError for a law that cannot be."""
    count = len(contacts.area)

    def each(value):
        return contiguous(np.broadcast_to(np.asarray(value, float), count))

    kind = {Hard: HARD, Penalty: PENALTY, Table: TABLE, Lagrange: LAGRANGE, Forward: LAGRANGE}[type(law)]
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
    table = [contiguous(getattr(law, name, [0.0, 1.0])) for name in ("closure", "pressure")]
    fixed = contacts.fixed
    return NormalKernel(kind, np.where(fixed, 0.0, each(law.gap)), contiguous(np.where(fixed, contacts.preload, -1.0)),
                        each(contacts.area), each(getattr(law, "stiffness", 0.0)),
                        each(getattr(law, "damping", 0.0)), *table, float(getattr(law, "damping_speed", np.inf)),
                        float(getattr(law, "restitution", 0.0)), gamma is not None)


def contiguous(values):
    """A writable, contiguous copy: one type of array for all compiled calls."""
    return np.array(values, dtype=float, order="C")
