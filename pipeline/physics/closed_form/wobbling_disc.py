"""Stability of an elastically hinged disc that wobbles between two pads, in closed form.

Tilts q1 (which moves the disc by q1 r at the pads) and q2 about the other axis; inertia T, polar inertia J, hinge k_t
and damper d of both tilts, pads of stiffness k on both faces at radius r, thickness h, speed W, friction mu. Friction
acts on the faces, h / 2 from the middle, so that both pads turn the disc about q2 by mu h k r q1:

    (T s^2 + d s + k_t + 2 k r^2)(T s^2 + d s + k_t) + (J W s)^2 + J W mu h k r s = 0.                             (1)

The pads of von Wagner, Hochlenert & Hagedorn, J. Sound Vib. 302 (2007) 527, follow the tilting face as well; here
their forces keep their direction.
"""

import numpy as np


def polynomial(inertia, polar_inertia, hinge, damping, pad, radius, thickness, speed, friction):
    """Coefficients (5,) of (1), highest power first."""
    first, second, turning = hinge + 2 * pad * radius**2, hinge, polar_inertia * speed
    return np.array([inertia**2, 2 * inertia * damping, damping**2 + inertia * (first + second) + turning**2,
                     damping * (first + second) + turning * friction * thickness * pad * radius, first * second])


def onset_friction(inertia, polar_inertia, hinge, damping, pad, radius, thickness, speed):
    """Friction at which (1) has imaginary roots: a3 a2 a1 = a4 a1^2 + a3^2 a0 (Hurwitz), for a positive speed."""
    a4, a3, a2, least, a0 = polynomial(inertia, polar_inertia, hinge, damping, pad, radius, thickness, speed, 0.0)
    largest = a3 * (a2 + np.sqrt(a2**2 - 4 * a4 * a0)) / (2 * a4)
    return (largest - least) / (polar_inertia * speed * thickness * pad * radius)


def onset_frequency(*parameters):
    """Frequency (Hz) of the imaginary roots at the onset, sqrt(a1 / a3); parameters as of ``onset_friction``."""
    _, a3, _, a1, _ = polynomial(*parameters, onset_friction(*parameters))
    return np.sqrt(a1 / a3) / (2 * np.pi)
