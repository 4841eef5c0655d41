"""Cattaneo (1938), Mindlin (1949): partial slip of a Hertz contact under a tangential load (Johnson 1985, 7.2)."""

import numpy as np


def stick_radius(contact_radius, tangential_load, friction, normal_load):
    """c = a (1 - Q / (mu P))^(1/3)."""
    return contact_radius * np.cbrt(1.0 - tangential_load / (friction * normal_load))


def shear(distance, contact_radius, peak_pressure, stick_radius, friction):
    """q(r) = mu p0 (sqrt(1 - r^2 / a^2) - (c / a) sqrt(1 - r^2 / c^2)), each root 0 where negative."""
    full = np.sqrt(np.maximum(1.0 - (distance / contact_radius) ** 2, 0.0))
    held = np.sqrt(np.maximum(1.0 - (distance / stick_radius) ** 2, 0.0))
    return friction * peak_pressure * (full - stick_radius / contact_radius * held)


def tangential_load(displacement, sliding_displacement, friction_limit):
    """Q = mu P (1 - (1 - d / D)^(3/2)) of first loading; D = 3 mu P (2 - nu) / (16 G a) where all of it slides."""
    return friction_limit * (1.0 - (1.0 - displacement / sliding_displacement) ** 1.5)


def loop_loss(amplitude, sliding_displacement, friction_limit):
    """Energy of one cycle of tangential displacement +-``amplitude`` <= D (Mindlin & Deresiewicz 1953).

    Unloading and reloading repeat first loading at twice the scale (Masing), so the loop encloses
    8 int_0^d Q dd - 4 Q d, with int Q dd = mu P (d - 2/5 D (1 - (1 - d / D)^(5/2))).
    """
    d, limit = amplitude, sliding_displacement
    area = friction_limit * (d - 0.4 * limit * (1.0 - (1.0 - d / limit) ** 2.5))
    return 8.0 * area - 4.0 * tangential_load(d, limit, friction_limit) * d
