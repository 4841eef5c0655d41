"""Growth of slip on a weakening zone of fixed length between like solids, mode II, unbounded plane.

The zone |x| < a slips everywhere, its strength falls by W per slip, all around it sticks. Slip d(x) e^(s t) obeys
    (G / 2) |k| F(s / (|k| cS)) d^(k) = W d^(k)   on the zone,   F(r) = R / (a_s (1 - a_s^2)),
with Rayleigh's function R at the imaginary speed i r cS (Weertman, J. Geophys. Res. 85 (1980) 1455; Geubelle and Rice,
J. Mech. Phys. Solids 43 (1995) 1791). With x = a cos(q), d = sum b_n sin(n q) and d^_n ~ n J_n(k a) / k this is a small
symmetric eigenproblem; its least W grows with s. At s = 0 it is the limit of stability, 2 a W (1 - nu) / G = 1.158
(Dascalu, Campillo and Ionescu, Geophys. J. Int. 142 (2000); Uenishi and Rice, J. Geophys. Res. 108 (2003) 2042).
"""

import numpy as np
import scipy

from pipeline.physics.closed_form.wave_speeds import rayleigh_function

#: numbers n of the sines of a slip that is even in x; k a at which the inertial part is summed, evenly in log k
_TERMS, _WAVENUMBERS = np.arange(1, 16, 2), np.geomspace(1e-4, 300.0, 4001)


def growing_weakening(rate, solid, half_length):
    """Weakening W in Pa/m at which slip on a zone of ``half_length`` (m) grows at ``rate`` (1/s; 0 = the limit)."""
    stiffness = 0.25 * np.pi * _still(solid) * np.diag(_TERMS)
    if rate > 0.0:
        stiffness += _inertia(rate * half_length / solid.shear_speed, solid)
    overlap = _overlap(_TERMS[:, None] - _TERMS) - _overlap(_TERMS[:, None] + _TERMS)
    return float(scipy.linalg.eigh(stiffness, overlap, eigvals_only=True)[0]) * solid.shear_modulus / half_length


def _still(solid):
    """F(0) = 2 (1 - cS^2 / cP^2), which is 1 / (1 - nu) in plane strain."""
    return 2.0 * (1.0 - (solid.shear_speed / solid.dilatational_speed) ** 2)


def _overlap(number):
    """Integral of cos(number q) sin(q) / 2 over 0..pi for even numbers."""
    return 1.0 / (1.0 - number**2)


def _inertia(rate, solid):
    """What the growth rate, times a / cS, adds to the stiffness over G."""
    ratio = rate / _WAVENUMBERS
    response = rayleigh_function(1j * ratio * solid.shear_speed, solid).real / (-(ratio**2) * np.sqrt(1.0 + ratio**2))
    signs = (-1.0) ** (_TERMS // 2)
    slip = (signs * _TERMS)[:, None] * np.pi * scipy.special.jv(_TERMS[:, None], _WAVENUMBERS) / _WAVENUMBERS
    weight = _WAVENUMBERS**2 * np.log(_WAVENUMBERS[1] / _WAVENUMBERS[0]) * (response - _still(solid))
    return 0.5 / np.pi * (slip * weight) @ slip.T
