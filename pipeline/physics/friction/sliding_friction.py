"""Friction of a contact that slides in its plane, compiled: force on the body, and slopes over normal force and slip.

    F = N mu(p, |v|) g(|v|) v / |v|,    v = (v_x, v_y): slip of the drive against the body, p = N / A

g = 1 except for |v| < v_s, where it is the cubic x (3 - x^2) / 2 of x = |v| / v_s: sticking is replaced by creep slower
than that. The friction coefficient and its slopes come from ``dry_friction.characteristic``.
"""

from typing import NamedTuple

from pipeline.physics.numerics.compiled import njit


class SlidingForce(NamedTuple):
    """Friction on a body and its slopes: force in N, over the normal force, and over the slip velocity in N s/m."""

    x: float
    y: float
    x_by_normal: float
    y_by_normal: float
    xx: float
    xy: float       # dF_x/dv_y = dF_y/dv_x
    yy: float


@njit(inline="always")
def sliding_part(slip, stick_speed):
    """(g, dg/dslip in s/m): 1 from the ``stick_speed`` m/s on, a cubic without kinks below it; slip >= 0 m/s."""
    if slip >= stick_speed:
        return 1.0, 0.0
    x = slip / stick_speed
    return x * (3.0 - x * x) / 2.0, 1.5 * (1.0 - x * x) / stick_speed


@njit(inline="always")
def sliding_friction(normal, pressure, slip, slip_x, slip_y, mu, by_pressure, by_speed, stick_speed, share=1.0):
    """SlidingForce under the force ``normal`` N at ``pressure`` Pa and the slip velocity (slip_x, slip_y) m/s.

    ``slip`` is the size of the slip velocity; ``mu``, ``by_pressure`` (1/Pa) and ``by_speed`` (s/m) are the friction
    coefficient and its slopes at that pressure and slip speed; ``stick_speed`` v_s in m/s; ``share``: what is heard at
    once of a change of the normal force.
    """
    part, part_slope = sliding_part(slip, stick_speed)
    x, y = (slip_x / slip, slip_y / slip) if slip > 0.0 else (1.0, 0.0)
    force, slide = normal * mu * part, share * part * (mu + pressure * by_pressure)
    along = normal * (mu * part_slope + by_speed * part)
    across = force / slip if slip > 0.0 else along
    return SlidingForce(force * x, force * y, slide * x, slide * y, along * x * x + across * y * y,
                        (along - across) * x * y, along * y * y + across * x * x)
