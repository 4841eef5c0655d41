"""What changes in the linear part of a step where the speed W of the drive does, compiled.

The linear step holds the gyroscopic and centrifugal terms of one speed W0. At another the coordinates carry

    p = -(W - W0) G q' - (W^2 - W0^2) Kc q

as well, taken linear over a step and solved for at its end: the error is of second order in the step. Terms with the
angular acceleration W' are left out: they vanish where the drive torque acts along the axis of the turning body.
"""

from typing import NamedTuple

import numpy as np

from pipeline.physics.numerics.compiled import borrowing
from pipeline.physics.time_stepping.linear_step import add_forces, project_rows
from pipeline.physics.time_stepping.normal_laws import contiguous

#: sweeps within which the force at the end of a step must settle, and the change that counts as settled
_SWEEPS, _SETTLED = 50, 1e-12


class TurningKernel(NamedTuple):
    """r coordinates with terms of the drive, seen and driven through one step; r = 0 where there are none."""

    rows: np.ndarray            # (2 r, 2, m) displacement, then velocity
    first: np.ndarray           # (r, 2, m) effect of forces at the begin of the step
    last: np.ndarray            # (r, 2, m) effect of forces at its end
    gyroscopic: np.ndarray      # (r, r) N s^2/m, per speed of the drive
    centrifugal: np.ndarray     # (r, r) kg, per squared speed
    speed: float                # rad/s, at which the linear step holds these terms


def turning_kernel(model, system, matrices, varies):
    """TurningKernel of a SlidingModel; ``matrices``: step matrices of its ModalSystem ``system``.

    Without coordinates where the speed of the drive does not vary.
    """
    terms = abs(model.gyroscopic) + abs(model.centrifugal)
    kept = np.flatnonzero(terms.any(axis=0) | terms.any(axis=1)) if varies else np.zeros(0, int)
    rows = np.eye(model.size)[kept]
    first, last = (np.einsum("bxy,ryb->rxb", matrix, system.driven(rows)) for matrix in matrices[1:])
    seen = system.observed(rows)
    block = np.ix_(kept, kept)
    return TurningKernel(*(contiguous(a) for a in (seen.reshape(-1, *seen.shape[2:]), first, last,
                                                   model.gyroscopic[block], model.centrifugal[block])),
                         float(model.speed))


@borrowing
def turning_force(turning, seen, speed, force):
    """Fill ``force`` (r,) with p at a ``speed`` of the drive; ``seen`` (2 r,) displacements, then velocities."""
    count = force.size
    by_gyroscopic, by_centrifugal = speed - turning.speed, speed * speed - turning.speed * turning.speed
    for i in range(count):
        total = 0.0
        for j in range(count):
            total += by_gyroscopic * turning.gyroscopic[i, j] * seen[count + j]
            total += by_centrifugal * turning.centrifugal[i, j] * seen[j]
        force[i] = -total


@borrowing
def turn(turning, pairs, speed, seen, force, change):
    """Add to the ``pairs`` (2, m) at the end of a step what p changes in them; whether it settles.

    ``force`` (r,) is p at the begin, then at the end; ``seen`` (2 r,) becomes the motion at the end, ``change`` (r,) is
    scratch.
    """
    add_forces(turning.first, force, pairs)
    add_forces(turning.last, force, pairs)
    settled, sweeps = False, 0
    while not settled and sweeps < _SWEEPS:
        settled = correct(turning, pairs, speed, seen, force, change)
        sweeps += 1
    return settled


@borrowing
def correct(turning, pairs, speed, seen, force, change):
    """One sweep of ``turn``: p of the ``pairs`` in place of ``force``; whether it has settled."""
    project_rows(turning.rows, pairs, seen)
    turning_force(turning, seen, speed, change)
    largest, moved = 0.0, 0.0
    for i in range(force.size):
        largest = max(largest, abs(change[i]))
        new = change[i]
        change[i] -= force[i]
        moved = max(moved, abs(change[i]))
        force[i] = new
    add_forces(turning.last, change, pairs)
    return moved <= _SETTLED * largest


@borrowing
def turning_work(begin, end, seen_begin, seen):
    """Work (J) of p from ``begin`` to ``end`` (r,) on the displacements, first half of ``seen`` (2 r,)."""
    work = 0.0
    for i in range(begin.size):
        work += 0.5 * (begin[i] + end[i]) * (seen[i] - seen_begin[i])
    return work


