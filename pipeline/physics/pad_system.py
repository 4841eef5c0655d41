"""Reduced pads and caliper on a rigid disc: M q'' + C q' + K q = load + contact force, and its equilibria."""

from typing import NamedTuple

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.patch_contact import PatchContact, contact_force, contact_tangent

STATIC_ITERATIONS = 100
STATIC_TOLERANCE = 1e-12


class PadSystem(NamedTuple):
    """Equation of motion of the assembly without its disc; n coordinates, SI units."""

    mass: np.ndarray        # (n, n) kg
    damping: np.ndarray     # (n, n) N s/m, bodies and joints
    stiffness: np.ndarray   # (n, n) N/m, bodies and joints
    load: np.ndarray        # (n,) N, generalised force of the pistons
    contact: PatchContact


def static_start(system, where="static start"):
    """Displacement (n,) in equilibrium with the load before friction acts.

    Newton's method on K q = load + n^T N(q) from closed contacts, each step shortened until the residual
    falls. The problem is convex, since the normal law rises. Raises ConvergenceError.
    """
    frictionless = system.contact._replace(friction=np.zeros_like(system.contact.friction))
    return _equilibrium(system._replace(contact=frictionless), _all_closed(frictionless, system), where)


def sliding_state(system, start, where="steady sliding"):
    """Displacement (n,) in equilibrium with the load and full friction, from ``start``. Raises ConvergenceError."""
    return _equilibrium(system._replace(contact=system.contact._replace(ramp=0.0)), start, where)


def linearised(system, displacement):
    """(damping, stiffness), both (n, n), of small motions about steady sliding at ``displacement``.

    Stiffness: K + k n^T n + (mu + p dmu/dp) k t^T n; damping: C + N dmu/dv t^T t, with full friction.
    """
    contact = system.contact._replace(ramp=0.0)
    stiffness, damping = contact_tangent(contact, 0.0, displacement, np.zeros_like(displacement))
    return system.damping + damping, system.stiffness + stiffness


def _all_closed(contact, system):
    slope = contact.area * (contact.pressure[1] - contact.pressure[0]) / (contact.closure[1] - contact.closure[0])
    closed = system.stiffness + (contact.normal.T * slope) @ contact.normal
    return cho_solve(cho_factor(closed), system.load)


def _equilibrium(system, displacement, where):
    rest = np.zeros_like(displacement)

    def residual_of(q):
        return system.load + contact_force(system.contact, 0.0, q, rest) - system.stiffness @ q

    scale, residual = np.linalg.norm(system.load), residual_of(displacement)
    for _ in range(STATIC_ITERATIONS):
        if np.linalg.norm(residual) <= STATIC_TOLERANCE * scale:
            return displacement
        stiffness, _ = contact_tangent(system.contact, 0.0, displacement, rest)
        step, length = np.linalg.solve(system.stiffness + stiffness, residual), 1.0
        while length > 1e-6:
            candidate = displacement + length * step
            remaining = residual_of(candidate)
            if np.linalg.norm(remaining) < np.linalg.norm(residual):
                break
            length /= 2
        displacement, residual = candidate, remaining
    raise ConvergenceError(where, f"a residual below {STATIC_TOLERANCE:g} of the load",
                           f"{np.linalg.norm(residual) / scale:.3g} after {STATIC_ITERATIONS} steps",
                           "check that the joints hold every rigid motion and that the contact law rises")
