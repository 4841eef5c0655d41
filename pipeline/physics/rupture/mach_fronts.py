"""Mach fronts of shear waves behind fast ruptures, measured in the velocity field.

A front faster than the shear waves trails a straight ridge of rotation rate under the angle asin(cS / speed). It is
found by summing the rotation rate along straight lines behind the tip and taking the strongest (a slant stack). The
ridge of the paper's left front is 15 nodes deep at 25 um: there a source of known speed reads some 10 % low in the
slower solid and right to 4 % in the faster one, at 6.25 um 5 % low and right to 1 % (its test).
"""

from typing import NamedTuple

import numpy as np

from pipeline.physics.closed_form.wave_speeds import mach_angle
from pipeline.physics.rupture.fronts import outwards, straight_speed

#: when a front is looked at: share of the time at which it arrives at its last node
_SHARE = 2.0 / 3.0
#: depths of the ridge: nodes below, share of the depth down to which the circular wave of the nucleation is behind
_NODES, _DEPTH = 2.0, 0.9
#: nodes behind the tip within which the ridge may leave the interface
_LAG = 8.0
#: fewest nodes through whose arrivals a speed is drawn
_FEWEST = 5


class View(NamedTuple):
    """Velocity of one plate next to the interface at some times, as seen from the interface."""

    time: np.ndarray            # (f,) s
    velocity: tuple             # f arrays (2, rows, columns), row 0 on the interface
    spacing: float              # m
    shear_speed: float          # m/s


def front_angle(view, arrival, x, centre, run_in, side):
    """(measured, expected) angle in rad of the front on one side; nan where there is none or it is too slow.

    Expected from the speed between ``run_in`` m from the centre and the place of the front when it is looked at: what
    radiated the ridge, not what the front did afterwards.
    """
    nodes = outwards(x, centre, run_in, side)
    nodes = nodes[arrival.reached[nodes]]
    if not nodes.size:
        return np.nan, np.nan
    look = int(np.abs(view.time - _SHARE * arrival.arrival[nodes].max()).argmin())
    passed = nodes[arrival.arrival[nodes] <= view.time[look]]
    if passed.size < _FEWEST:
        return np.nan, np.nan
    expected = mach_angle(view.shear_speed, straight_speed(x[passed], arrival.arrival[passed])[0])
    if np.isnan(expected):
        return np.nan, np.nan
    tangent = view.shear_speed * view.time[look] * np.cos(expected)
    return mach_angle_of(view.velocity[look], view.spacing, side * (side * x[passed]).max(), side,
                         (_NODES * view.spacing, _DEPTH * tangent), _LAG * view.spacing), expected


def mach_angle_of(velocity, spacing, tip, side, depths, lag):
    """Angle in rad between the interface and the strongest straight ridge of rotation rate behind a front tip.

    ``velocity`` (2, rows, columns) with row 0 at the interface, ``tip`` m from the left edge, ``depths`` (low, high) m
    between which the ridge is summed, ``lag`` m: how far behind the tip it may leave the interface. nan where fewer
    than four rows lie between the depths, or where the strongest line is the flattest or steepest tried.
    """
    turning = np.gradient(velocity[1], spacing, axis=1) - np.gradient(velocity[0], spacing, axis=0)
    deepest = min(int(depths[1] / spacing), velocity.shape[1] - 1)
    rows = np.arange(max(1, int(np.ceil(depths[0] / spacing))), deepest + 1)
    if rows.size < 4:
        return np.nan
    angles = np.radians(np.arange(15.0, 86.0, 1.0))
    x = spacing * np.arange(velocity.shape[2])
    best, angle = -1.0, np.nan
    for behind in np.arange(0.0, lag + 0.25 * spacing, 0.5 * spacing):
        position = tip - side * (behind + rows[:, None] * spacing / np.tan(angles))
        stack = np.abs(np.mean([np.interp(p, x, turning[r]) for r, p in zip(rows, position, strict=True)], axis=0))
        top = int(stack.argmax())
        if stack[top] > best:
            best, angle = stack[top], angles[top] if 0 < top < angles.size - 1 else np.nan
    return float(angle)
