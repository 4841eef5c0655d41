"""Stress under a rough surface: that of a half-space under normal and tangential tractions, one wavenumber at a time.

Along its wave vector a harmonic traction deforms the half-space in plane strain (Airy's function (A + B z) exp(-k z)),
across it in antiplane shear (Johnson, Contact Mechanics, 1985, sections 2.1 and 13.2). Axes: x along sliding, y across,
z inwards.
"""

import numpy as np
import scipy


def stress_at(depth, pressure, shear, spacing, poisson_ratio):
    """Stress (6, ny, nx) in Pa: xx, yy, zz, yz, xz, xy at a ``depth`` in m.

    ``pressure`` and ``shear`` along x, both (ny, nx) in Pa, act on the surface from outside; ``spacing`` (dy, dx) in m.
    Their means act as on a body that cannot widen.
    """
    shape, nu = pressure.shape, poisson_ratio
    wave_y = 2 * np.pi * np.fft.fftfreq(shape[0], spacing[0])[:, None]
    wave_x = 2 * np.pi * np.fft.rfftfreq(shape[1], spacing[1])[None, :]
    wave = np.hypot(wave_y, wave_x)
    uniform = wave == 0.0
    wave[uniform] = 1.0
    cosine, sine = np.where(uniform, 1.0, wave_x / wave), np.where(uniform, 0.0, wave_y / wave)
    load, drag = scipy.fft.rfft2(pressure), -scipy.fft.rfft2(shear)         # xz on the surface: what acts along x, < 0
    along, across = drag * cosine, -drag * sine
    deep = np.where(uniform, 0.0, wave * depth)
    decay = np.exp(-deep)
    zz = -(load * (1.0 + deep) + 1j * along * deep) * decay
    kz = (along * (1.0 - deep) + 1j * load * deep) * decay
    kk = (load * (deep - 1.0) + 1j * along * (deep - 2.0)) * decay
    kk = np.where(uniform, nu / (1.0 - nu) * zz, kk)
    tt = np.where(uniform, kk, nu * (kk + zz))
    tz, kt = across * decay, np.where(uniform, 0.0, -1j * across * decay)
    fields = (kk * cosine**2 + tt * sine**2 - 2 * kt * sine * cosine,
              kk * sine**2 + tt * cosine**2 + 2 * kt * sine * cosine, zz,
              kz * sine + tz * cosine, kz * cosine - tz * sine,
              (kk - tt) * sine * cosine + kt * (cosine**2 - sine**2))
    return np.array([scipy.fft.irfft2(field, s=shape) for field in fields])


def von_mises(stress):
    """Equivalent stress (...) of ``stress`` (6, ...) in the order of ``stress_at``."""
    xx, yy, zz, yz, xz, xy = stress
    return np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3.0 * (yz**2 + xz**2 + xy**2))
