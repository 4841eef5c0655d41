"""Elements of effects in the sliding motion, compiled: what their forces hold beyond the slopes of small motions.

An element along a row b has the elongation e = b x and resists it with a force F(e, e') of what it remembers. Beside e0
and F0 of steady sliding, and the slopes k and c that the modes know,

    r = -(F - F0 - k (e - e0) - c e')

acts along b. Elements stand behind the patches, as if each were one that moves along its normal alone. Friction that
turns with the slip is that of the patches; as an element it stays what small motions have of it.
"""

from typing import NamedTuple

import numpy as np

from pipeline.physics.numerics.compiled import njit
from pipeline.physics.time_stepping.element_forces import MAXWELL, TURNING, LawKernel, element_force, laws_of
from pipeline.physics.time_stepping.elements import alone


class AttachedKernel(NamedTuple):
    """e elements about steady sliding, SI units."""

    laws: LawKernel
    place: np.ndarray       # (e,) m, elongation there
    force: np.ndarray       # (e,) N
    slope: np.ndarray       # (2, e) N/m, N s/m
    speed: float            # rad/s, of the drive
    branch: np.ndarray      # (b,) what of their memory are forces of Maxwell branches


def attached(elements, place, slopes, memory, speed):
    """(AttachedKernel of Elements, what they remember (s,)) at elongations ``place`` (e,) m, with the ``slopes`` (2, e)
    of small motions; ``memory`` (s,) of steady sliding, None for none."""
    laws, count = laws_of(alone(elements)), len(elements)
    held = np.zeros(int(laws.first[-1])) if memory is None else np.array(memory, float)
    force, instant = np.zeros(count), (0.0, 0.0, float(speed))
    turning = laws.kind == TURNING
    laws.parameter[turning, 2] = np.asarray(slopes)[1, turning]
    held[laws.first[1:][laws.kind == MAXWELL] - 1] = 0.0
    for k in range(count):
        force[k] = element_force(laws, k, place[k], 0.0, place[k], held, held.copy(), instant)[0]
    of_branches = [np.arange(laws.first[k], laws.first[k + 1] - 1) for k in np.flatnonzero(laws.kind == MAXWELL)]
    branch = np.concatenate([np.empty(0, int), *of_branches])
    return AttachedKernel(laws, np.array(place, float), force, np.array(slopes, float).reshape(2, count), float(speed),
                          branch[laws.stiffness[branch] > 0]), held


@njit
def beyond_slopes(k, held, begun, time, y, rest, slope, after):
    """Fill the columns of the elements, the last ones, of ``rest`` (3, n) and ``slope`` (3, 4, n) as ``beyond_linear``
    does those of the patches, at the motion ``y`` (4, n) and a ``time`` s.

    ``held`` (s,) is remembered from the elongations ``begun`` (e,) m; ``after`` (s,) is filled with what will be.
    """
    first = y.shape[1] - k.place.size
    for j in range(k.place.size):
        i = first + j
        force, by_place, by_rate = element_force(k.laws, j, k.place[j] + y[0, i], y[1, i], begun[j], held, after,
                                                 (time, 0.0, k.speed))
        rest[:, i], slope[:, :, i] = 0.0, 0.0
        rest[0, i] = k.force[j] + k.slope[0, j] * y[0, i] + k.slope[1, j] * y[1, i] - force
        slope[0, 0, i], slope[0, 1, i] = k.slope[0, j] - by_place, k.slope[1, j] - by_rate
