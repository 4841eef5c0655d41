"""Westergaard (1939): a one-dimensional sine wave pressed on a half-space (Johnson 1985, section 13.2)."""

import numpy as np


def full_contact_pressure(amplitude, wavelength, modulus):
    """Mean pressure p* = pi E* amplitude / wavelength that flattens the wave amplitude cos(2 pi x / wavelength)."""
    return np.pi * modulus * amplitude / wavelength


def contact_share(mean_pressure, amplitude, wavelength, modulus):
    """Share 2 a / wavelength of the contact strip, from mean / p* = sin^2(pi a / wavelength)."""
    return 2.0 / np.pi * np.arcsin(np.sqrt(mean_pressure / full_contact_pressure(amplitude, wavelength, modulus)))


def pressure(position, mean_pressure, amplitude, wavelength, modulus):
    """Contact pressure at ``position`` (crest at 0), 0 outside the strip."""
    sine_square = mean_pressure / full_contact_pressure(amplitude, wavelength, modulus)
    angle = np.pi * (np.mod(np.asarray(position) / wavelength + 0.5, 1.0) - 0.5)
    inside = np.maximum(sine_square - np.sin(angle) ** 2, 0.0)
    return 2.0 * mean_pressure * np.cos(angle) / sine_square * np.sqrt(inside)
