"""Newmark's average-acceleration rule for the pads on the rigid disc, compiled: the cross-check of the exudyn model.

    q1 = q0 + h v0 + h^2 (a0 + a1) / 4,   v1 = v0 + h (a0 + a1) / 2   (Newmark, ASCE J. Eng. Mech. Div. 85 (1959) 67),
second order, without numerical damping. Each step solves M a1 + C v1 + K q1 = load + contact force by Newton's
method with a kept inverse, renewed when it stops contracting.
"""

import numpy as np

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.numerics.compiled import njit
from pipeline.physics.pads.pad_system import force, tangent

ITERATIONS = 30
CONTRACTION = 0.2
TOLERANCE = 1e-10


def integrate(system, start, step, steps, record_every=1, scale=None):
    """(time (m,), displacement (m, n), velocity (m, n)) at every ``record_every``-th step from rest at ``start``.

    ``system`` is a PadSystem, ``step`` in s. Every step ends with a residual below 1e-10 of ``scale`` (N in the
    system's coordinates; default the load). Raises ConvergenceError naming the time and the residual otherwise.
    """
    scale = np.linalg.norm(system.load) if scale is None else scale
    displacement, velocity, failed, residual = _integrate(
        system, np.array(start, dtype=float), step, steps, record_every, TOLERANCE * scale)
    if failed:
        raise ConvergenceError(f"multibody: newmark at t = {failed * step:.6g} s",
                               f"a residual below {TOLERANCE:g} of the load", f"{residual / scale:.3g}",
                               "take a shorter step")
    return np.arange(len(displacement)) * (step * record_every), displacement, velocity


@njit
def _integrate(system, start, step, steps, record_every, tolerance):
    n, kept = start.size, steps // record_every + 1
    displacements, velocities = np.zeros((kept, n)), np.zeros((kept, n))
    q, v = start, np.zeros(n)
    a = np.linalg.solve(system.mass, force(system, 0.0, q, v))
    displacements[0] = q
    inverse = _inverse(system, 0.0, q, v, step)
    for count in range(1, steps + 1):
        old_q, old_v, last, converged = q + step * v + 0.25 * step**2 * a, v + 0.5 * step * a, np.inf, False
        size = np.inf
        for _ in range(ITERATIONS):
            q, v = old_q + 0.25 * step**2 * a, old_v + 0.5 * step * a
            residual = force(system, count * step, q, v) - system.mass @ a
            size = np.linalg.norm(residual)
            if size <= tolerance:
                converged = True
                break
            if not size < np.inf:
                break
            if size > CONTRACTION * last:
                inverse = _inverse(system, count * step, q, v, step)
            a, last = a + inverse @ residual, size
        if not converged:
            return displacements, velocities, count, size
        if count % record_every == 0:
            displacements[count // record_every], velocities[count // record_every] = q, v
    return displacements, velocities, 0, 0.0


@njit
def _inverse(system, time, q, v, step):
    stiffness, damping = tangent(system, time, q, v)
    return np.linalg.inv(system.mass + 0.5 * step * damping + 0.25 * step**2 * stiffness)
