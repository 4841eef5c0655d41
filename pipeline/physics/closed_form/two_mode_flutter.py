"""Mode coupling (flutter) of two undamped modes under friction, in closed form.

Unit masses and K = [[k11, k12 - mu k_friction], [k12, k22]]: the friction force that follows the contact pressure of
mode 2 acts on mode 1 (Hoffmann, Fischer, Allgaier & Gaul, Mech. Res. Commun. 29 (2002) 197). Stiffnesses in 1/s^2.
"""

import numpy as np


def onset_friction(k11, k22, k12, k_friction, damping=0.0):
    """Friction above which the motion grows: (k11 - k22)^2 / 4 + k12 (k12 - mu k_friction) = -d^2 (k11 + k22) / 2.

    Both modes have the same ``damping`` d (1/s); without it both squared frequencies coalesce there.
    """
    return (k12**2 + (k11 - k22) ** 2 / 4 + damping**2 * (k11 + k22) / 2) / (k12 * k_friction)


def growth_rate(k11, k22, k12, k_friction, friction, damping=0.0):
    """Largest real part (1/s) of the roots of s^2 + d s = r^2, r being the undamped roots."""
    undamped = roots_over_friction(k11, k22, k12, k_friction, friction)
    return float((-damping / 2 + np.sqrt(damping**2 / 4 + undamped**2)).real.max())


def roots_over_friction(k11, k22, k12, k_friction, friction):
    """The four roots s (1/s), from s^2 = -(k11 + k22) / 2 +- sqrt((k11 - k22)^2 / 4 + k12 (k12 - mu k_friction))."""
    spread = np.sqrt(complex((k11 - k22) ** 2 / 4 + k12 * (k12 - friction * k_friction)))
    squares = -(k11 + k22) / 2 + spread * np.array([1, -1])
    return np.concatenate((np.sqrt(squares), -np.sqrt(squares)))
