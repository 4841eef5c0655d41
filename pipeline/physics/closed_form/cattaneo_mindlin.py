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
