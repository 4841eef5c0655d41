"""Newmark's average-acceleration rule for the pads on the rigid disc, compiled: the cross-check of the exudyn model.

    q1 = q0 + h v0 + h^2 (a0 + a1) / 4,   v1 = v0 + h (a0 + a1) / 2   (Newmark, ASCE J. Eng. Mech. Div. 85 (1959) 67),
second order, without numerical damping. Each step solves M a1 + C v1 + K q1 = load + contact force by Newton's
method with a kept inverse, renewed when it stops contracting.
"""

import numpy as np
from numba import njit

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.patch_contact import contact_force, contact_tangent

ITERATIONS = 30
CONTRACTION = 0.2
TOLERANCE = 1e-10


def newmark(system, start, step, steps, record_every=1):
    """(time (m,), displacement (m, n), velocity (m, n)) at every ``record_every``-th step from rest at ``start``.

    ``system`` is a PadSystem, ``step`` in s. Raises ConvergenceError naming the time and the residual of the first
    step that did not converge; a result is never returned then.
    """
    displacement, velocity, failed, residual = _integrate(
        *system[:4], system.contact, np.array(start, dtype=float), step, steps, record_every)
    if failed:
        raise ConvergenceError(f"multibody: newmark at t = {failed * step:.6g} s",
                               f"a residual below {TOLERANCE:g} of the load", f"{residual:.3g}", "take a shorter step")
    return np.arange(displacement.shape[0]) * (step * record_every), displacement, velocity


@njit(cache=True)
def _integrate(mass, damping, stiffness, load, contact, start, step, steps, record_every):
    n, kept = start.size, steps // record_every + 1
    displacements, velocities = np.zeros((kept, n)), np.zeros((kept, n))
    scale = np.linalg.norm(load)
    linear = mass + 0.5 * step * damping + 0.25 * step**2 * stiffness
    q, v = start, np.zeros(n)
    a = np.linalg.solve(mass, load + contact_force(contact, 0.0, q, v) - damping @ v - stiffness @ q)
    displacements[0] = q
    inverse = _inverse(linear, contact, 0.0, q, v, step)
    for count in range(1, steps + 1):
        time, predicted_v = count * step, v + 0.5 * step * a
        predicted_q = q + step * v + 0.25 * step**2 * a
        known = load - damping @ predicted_v - stiffness @ predicted_q
        inertia, last, converged = linear @ a, np.inf, False
        for _ in range(ITERATIONS):
            q, v = predicted_q + 0.25 * step**2 * a, predicted_v + 0.5 * step * a
            residual = known + contact_force(contact, time, q, v) - inertia
            size = np.linalg.norm(residual) / scale
            if size <= TOLERANCE:
                converged = True
                break
            if size > CONTRACTION * last:
                inverse = _inverse(linear, contact, time, q, v, step)
            correction, last = inverse @ residual, size
            a, inertia = a + correction, inertia + linear @ correction
        if not converged:
            return displacements, velocities, count, size
        if count % record_every == 0:
            displacements[count // record_every], velocities[count // record_every] = q, v
    return displacements, velocities, 0, 0.0


@njit(cache=True)
def _inverse(linear, contact, time, q, v, step):
    stiffness, damping = contact_tangent(contact, time, q, v)
    return np.linalg.inv(linear + 0.5 * step * damping + 0.25 * step**2 * stiffness)
