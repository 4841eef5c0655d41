"""Hertz: a paraboloid pressed on an elastic half-space (Johnson, Contact Mechanics, 1985, section 4.2)."""

import numpy as np


def contact_radius(load, radius, modulus):
    """a = (3 F R / (4 E*))^(1/3); load N, radius of curvature m, contact modulus Pa."""
    return np.cbrt(3.0 * load * radius / (4.0 * modulus))


def peak_pressure(load, radius, modulus):
    """p0 = 3 F / (2 pi a^2)."""
    return 1.5 * load / (np.pi * contact_radius(load, radius, modulus) ** 2)


def pressure(distance, load, radius, modulus):
    """p(r) = p0 sqrt(1 - r^2 / a^2) inside the contact, 0 outside."""
    share = 1.0 - (np.asarray(distance) / contact_radius(load, radius, modulus)) ** 2
    return peak_pressure(load, radius, modulus) * np.sqrt(np.maximum(share, 0.0))
