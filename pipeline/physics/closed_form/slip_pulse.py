"""Steady slip pulses on the interface of two half-spaces, at any speed.

The lower solid slides towards +x over the upper one; friction f acts wherever it slips. In coordinates that move with
the pulse, the shear and the pressure that a slip rate V makes on the interface are
    shear = p_s V + q_s H[V],   pressure = p_n V + q_n H[V],   H[V](x) = (1 / pi) PV int V(s) / (s - x) ds,
as given by Adams (J. Appl. Mech. 68 (2001) 81) for every speed: below the shear speeds p_s = q_n = 0 (Weertman, J.
Geophys. Res. 85 (1980) 1455), and q_s vanishes at the generalised Rayleigh speed. On the slipping strip (-1, 1)
    p V + q H[V] = f sigma - tau > 0,   p = p_s - f p_n,  q = q_s - f q_n,
is solved by V ~ ((1 + x) / (1 - x))^a with tan(pi a) = q / p. Where p > 0 and q > 0 the slip rate is positive, weakly
singular at the leading edge (0 < a < 1/2) and zero at the trailing edge: Adams' intersonic pulse.
"""

from typing import NamedTuple

import numpy as np
import scipy

#: directions in which a pulse runs: with the slip of the lower solid, or against it
WITH_LOWER, AGAINST_LOWER = 1, -1


class PulseStress(NamedTuple):
    """Stress per slip rate in Pa s/m: local part and part of the Hilbert transform."""

    shear_local: float
    shear_hilbert: float
    pressure_local: float
    pressure_hilbert: float


def pulse_stress(speed, upper, lower, direction):
    """PulseStress of a pulse at ``speed`` in m/s; x points along its motion."""
    compliance = np.linalg.inv(_impedance(speed, lower, False)) - np.linalg.inv(_impedance(speed, upper, True))
    shear, normal = np.linalg.inv(compliance) @ np.array([1.0, 0.0]) * 1j / speed
    shear, pressure = -shear, -normal * direction
    return PulseStress(shear.real, shear.imag, pressure.real, pressure.imag)


def pulse_exponent(speed, upper, lower, friction, direction):
    """Exponent a of the leading edge where a steady pulse exists, nan elsewhere."""
    local, hilbert = _acting(speed, upper, lower, friction, direction)
    return np.arctan2(hilbert, local) / np.pi if local > 0.0 and hilbert > 0.0 else np.nan


def intersonic_pulse_speeds(upper, lower, friction):
    """(lowest, highest) speed in m/s of the pulse against the lower (slower) solid's slip; None where none exists.

    The highest is the slower dilatational speed; the pulse asks for enough friction and a modest mismatch.
    """
    highest = min(upper.dilatational_speed, lower.dilatational_speed)
    lowest = max(min(upper.shear_speed, lower.shear_speed), 0.8 * highest)
    top = (1.0 - 1e-9) * highest
    if np.isnan(pulse_exponent(top, upper, lower, friction, AGAINST_LOWER)):
        return None

    def hilbert(speed):
        return _acting(speed, upper, lower, friction, AGAINST_LOWER)[1]

    speeds = highest - (highest - lowest) * np.geomspace(1e-9, 1.0, 400)
    below = next((speed for speed in speeds if hilbert(speed) < 0.0), None)
    return (lowest, highest) if below is None else (scipy.optimize.brentq(hilbert, below, top), highest)


def _acting(speed, upper, lower, friction, direction):
    stress = pulse_stress(speed, upper, lower, direction)
    return (stress.shear_local - friction * stress.pressure_local,
            stress.shear_hilbert - friction * stress.pressure_hilbert)


def _impedance(speed, solid, is_upper):
    """(2, 2) stress (xy, yy) over displacement (x, y) of the surface, per positive wavenumber; outgoing waves."""
    along, across = (np.conj(np.sqrt(complex(1.0 - (speed / wave) ** 2))) * (1.0 if is_upper else -1.0)
                     for wave in (solid.dilatational_speed, solid.shear_speed))
    square = 1.0 - (speed / solid.shear_speed) ** 2
    displacement = np.array([[1j, -across], [-along, -1j]])
    stress = solid.shear_modulus * np.array([[-2j * along, 1.0 + square], [1.0 + square, 2j * across]])
    return stress @ np.linalg.inv(displacement)
