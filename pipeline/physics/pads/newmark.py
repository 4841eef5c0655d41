"""Newmark's average-acceleration rule for the pads on the rigid disc, compiled.

The rule and the tolerance of the exudyn model, which the main job uses. This integrator takes a third of its time and
serves sweeps, draws and tests; a test holds both together. Each step solves
M a1 + C v1 + K q1 = load + contact force by Newton's method with the inverse of an earlier state, which is renewed
when it stops contracting.
"""

import numpy as np

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.numerics.compiled import njit
from pipeline.physics.numerics.newmark import correct, predict
from pipeline.physics.pads.memory import accept, begun, remembers
from pipeline.physics.pads.pad_system import STEP_TOLERANCE, force, tangent

ITERATIONS = 30
CONTRACTION = 0.2
_DONE, _RENEW, _FAILED = range(3)


def integrate(system, start, step, steps, record_every=1, scale=None, tolerance=STEP_TOLERANCE):
    """(time (m,), displacement (m, n), velocity (m, n)) at every ``record_every``-th step from rest at ``start``.

    ``system`` is a PadSystem, ``step`` in s. Every step ends with a residual below ``tolerance`` times ``scale`` (N in
    the system's coordinates; default the load). Raises ConvergenceError naming the time and the residual otherwise.
    """
    scale = np.linalg.norm(system.load) if scale is None else scale
    system, memory = begun(system, start, step)
    recalls = remembers(system)
    motion = np.zeros((3, np.size(start)))
    motion[0] = start
    motion[2] = np.linalg.solve(system.mass, force(system, 0.0, motion[0], motion[1]))
    recorded = np.zeros((2, steps // record_every + 1, np.size(start)))
    recorded[0, 0] = start
    predicted, code, number, iteration = _predicted(motion, step), _RENEW, 1, 0
    while code == _RENEW:
        inverse = _inverse(system, number * step, motion, step)
        code, number, iteration, residual = _advance(system, memory, recalls, motion, predicted, inverse, step, number,
                                                     steps, iteration, tolerance * scale, recorded, record_every)
    if code == _FAILED:
        raise ConvergenceError(f"multibody: newmark at t = {number * step:.6g} s",
                               f"a residual below {tolerance:g} of the load", f"{residual / scale:.3g}",
                               "take a shorter step")
    return np.arange(recorded.shape[1]) * (step * record_every), *recorded


def _inverse(system, time, motion, step):
    """(n, n) change of the acceleration with the residual."""
    stiffness, damping = tangent(system, time, motion[0], motion[1])
    return np.linalg.inv(system.mass + 0.5 * step * damping + 0.25 * step**2 * stiffness)


@njit
def _predicted(motion, step):
    """(2, n) displacement and velocity at the end of the step without the acceleration there."""
    predicted = np.empty((2, motion.shape[1]))
    for i in range(motion.shape[1]):
        q, v, a = motion[0, i], motion[1, i], motion[2, i]
        predicted[0, i], predicted[1, i] = predict(q, v, a, step)
    return predicted


@njit
def _advance(system, memory, recalls, motion, predicted, inverse, step, number, steps, iteration, tolerance, recorded,
             record_every):
    """(code, step, iteration, residual) after stepping ``motion``: displacement, velocity and acceleration, (3, n).

    Goes on from ``iteration`` of step ``number`` to the last step, or to one that needs another ``inverse`` or fails.
    """
    last, q, v, a = np.inf, motion[0], motion[1], motion[2]
    while number <= steps:
        for i in range(q.size):
            q[i], v[i] = correct(predicted[0, i], predicted[1, i], a[i], step)
        residual, inertia = force(system, number * step, q, v), system.mass @ a
        size = 0.0
        for i in range(q.size):
            residual[i] -= inertia[i]
            size += residual[i] ** 2
        size = np.sqrt(size)
        if size <= tolerance:
            if number % record_every == 0:
                for i in range(q.size):
                    recorded[0, number // record_every, i], recorded[1, number // record_every, i] = q[i], v[i]
            if recalls:
                accept(system, memory, number * step, q, v, step)
            end = _predicted(motion, step)
            for i in range(q.size):
                predicted[0, i], predicted[1, i] = end[0, i], end[1, i]
            number, iteration, last = number + 1, 0, np.inf
            continue
        iteration += 1
        if iteration == ITERATIONS or not size < np.inf:
            return _FAILED, number, iteration, size
        if size > CONTRACTION * last:
            return _RENEW, number, iteration, size
        change, last = inverse @ residual, size
        for i in range(q.size):
            a[i] += change[i]
    return _DONE, number, iteration, 0.0
