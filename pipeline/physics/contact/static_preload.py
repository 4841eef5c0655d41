"""Static preload of elastic bodies through contact patches with a nonlinear normal law.

Each patch i of area A_i carries N_i = A_i p(c_i) at its closure c_i = -(n_i u); p is the table of
``closure_law``. The bodies are condensed to the patches: c = c_free - compliance N.
"""

from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.contact.closure_law import force_at_rest
from pipeline.physics.numerics.damped_newton import damped_newton
from pipeline.physics.numerics.sparse_solver import factorise

#: forces that are solved for at once
_COLUMNS = 128
_STEPS = 100
_HALVINGS = 30
#: largest accepted imbalance of a contact force, as a share of the largest
BALANCED = 1e-10


@dataclass(frozen=True)
class Preload:
    """Contact forces (c,) [N], stiffness dN/dclosure (c,) [N/m] and closure (c,) [m]."""

    force: np.ndarray
    stiffness: np.ndarray
    closure: np.ndarray

    @property
    def closed(self):
        """True where the patch touches."""
        return self.closure > 0


def condense(stiffness, normal, load, solver):
    """Compliance (c, c) [m/N] of the patches and their closure (c,) [m] under ``load`` without contact.

    ``stiffness`` (n, n) sparse [N/m] regular without contact; ``normal`` (c, n) sparse, positive opens.
    """
    factor = factorise(stiffness, solver)
    blocks = (normal[k:k + _COLUMNS].T.toarray() for k in range(0, normal.shape[0], _COLUMNS))
    compliance = np.hstack([normal @ factor.solve(block) for block in blocks])
    return (compliance + compliance.T) / 2, -(normal @ factor.solve(load))


def contact_law(pressure, stiffness, largest):
    """Closure [m] and pressure [Pa], both from 0, of an interface with dp/dclosure = ``stiffness`` at ``pressure``.

    Between the given pressures the stiffness runs linearly. Towards zero pressure it falls as the
    pressure does, which makes the law exponential; its last hundredth is replaced by the tangent
    to zero. Beyond the last pressure, up to ``largest`` [Pa], the stiffness stays constant.
    """
    pressure, stiffness = np.asarray(pressure, float), np.asarray(stiffness, float)
    if not (stiffness > 0).all() or not (pressure > 0).all():
        raise ConfigError("normal contact law", "positive pressures and stiffnesses",
                          f"{pressure} Pa, {stiffness} Pa/m")
    low = pressure[0] * np.geomspace(0.01, 1, 60)
    middle = np.interp(np.linspace(0, len(pressure) - 1, 20 * len(pressure)), np.arange(len(pressure)), pressure)
    p = np.unique(np.r_[low, middle, max(largest, pressure[-1])])
    k = np.where(p < pressure[0], stiffness[0] * p / pressure[0], np.interp(p, pressure, stiffness))
    ratio = k[1:] / k[:-1]
    growing = np.abs(ratio - 1) > 1e-9
    mean = np.where(growing, (k[1:] - k[:-1]) / np.log(np.where(growing, ratio, 2.0)), k[:-1])
    closure = p[0] / k[0] + np.r_[0, np.cumsum(np.diff(p) / mean)]
    return np.r_[0, closure], np.r_[0, p]


def solve_preload(compliance, free_closure, area, law_closure, law_pressure):
    """Preload of the patches: Newton's method on the closures, with halved steps where needed.

    Raises ConfigError where no patch touches under the load, ConvergenceError where the
    forces do not balance.
    """
    if (free_closure <= 0).all():
        raise ConfigError("preload", "pads that touch the disc under the load",
                          f"gaps of at least {-free_closure.max():g} m", "check the piston force and the positions")
    first = first_slope(area, law_closure, law_pressure)

    def equation(closure):
        force, slope = force_at_rest(closure, area, law_closure, law_pressure)
        return closure - free_closure + compliance @ force, np.eye(len(area)) + compliance * slope, force, slope

    closure, imbalance = balance(equation, np.full_like(free_closure, law_closure[1]), first,
                                 (first * np.abs(free_closure)).max())
    if not imbalance <= BALANCED:
        raise ConvergenceError("preload", f"contact forces that balance within {BALANCED:g}", f"{imbalance:.1e}",
                               "raise structure.pressures, or soften the contact law")
    return Preload(*force_at_rest(closure, area, law_closure, law_pressure), closure)


def balance(equation, closure, first, reference):
    """(closures (c,) m, imbalance): Newton's method on ``equation``, from ``closure``, steps halved where needed.

    ``equation(closure)`` gives what is missing (c,) m, its derivative (c, c) or LowRank, force (c,) N and its slope
    (c,) N/m. The imbalance is the largest change of a force that one more step would make, as a share of the largest
    force or of ``reference`` N; an open contact counts with the stiffness ``first`` (c,) N/m of one that has just
    closed. At most BALANCED where the method converged, infinite where the derivative is singular.
    """
    def imbalance(step, force, slope):
        return np.abs(np.maximum(slope, first) * step).max() / (max(force.max(), reference) or 1.0)

    reached = damped_newton(equation, closure, imbalance, BALANCED, _STEPS, _HALVINGS)
    return reached.unknown, reached.error


def first_slope(area, law_closure, law_pressure):
    """Stiffness (c,) N/m of patches that have just closed."""
    return area * law_pressure[1] / law_closure[1]
