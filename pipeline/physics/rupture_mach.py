"""Mach fronts of shear waves behind fast ruptures, measured in the velocity field.

A front faster than the shear waves trails a straight ridge of rotation rate under the angle asin(cS / speed). It is
found by summing the rotation rate along straight lines behind the tip and taking the strongest (a slant stack).
"""

from typing import NamedTuple

import numpy as np

from pipeline.physics.closed_form.wave_speeds import mach_angle
from pipeline.physics.rupture_fronts import outwards

#: when a front is looked at: share of the time at which it arrives at its last node
_SHARE = 2.0 / 3.0
#: depths of the ridge: nodes below, share of the depth down to which the circular wave of the nucleation is behind
_NODES, _DEPTH = 2.0, 0.9
#: nodes behind the tip within which the ridge may leave the interface
_LAG = 8.0


class View(NamedTuple):
    """Velocity of one plate next to the interface at some times, as seen from the interface."""

    time: np.ndarray            # (f,) s
    velocity: tuple             # f arrays (2, rows, columns), row 0 on the interface
    spacing: float              # m
    shear_speed: float          # m/s


def front_angle(view, arrival, x, centre, half_width, speed, side):
    """(measured, expected) angle in rad of the front at ``speed`` (m/s) on one side; nan where there is none."""
    nodes = outwards(x, centre, half_width, side)
    nodes = nodes[arrival.reached[nodes]]
    expected = mach_angle(view.shear_speed, speed) if speed > 0.0 else np.nan
    if not nodes.size or np.isnan(expected):
        return np.nan, np.nan
    look = int(np.abs(view.time - _SHARE * arrival.arrival[nodes].max()).argmin())
    passed = x[nodes[arrival.arrival[nodes] <= view.time[look]]]
    if not passed.size:
        return np.nan, expected
    tangent = view.shear_speed * view.time[look] * np.cos(expected)
    return mach_angle_of(view.velocity[look], view.spacing, side * (side * passed).max(), side,
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
    best, found = -1.0, np.nan
    for behind in np.arange(0.0, lag + 0.25 * spacing, 0.5 * spacing):
        place = tip - side * (behind + rows[:, None] * spacing / np.tan(angles))
        stack = np.abs(np.mean([np.interp(p, x, turning[r]) for r, p in zip(rows, place, strict=True)], axis=0))
        top = int(stack.argmax())
        if stack[top] > best:
            best, found = stack[top], angles[top] if 0 < top < angles.size - 1 else np.nan
    return float(found)
