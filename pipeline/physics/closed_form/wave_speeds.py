"""Speeds of plane, surface and interface waves in isotropic solids, and of steady slip pulses on an interface.

With a_p^2 = 1 - c^2 / cP^2 and a_s^2 = 1 - c^2 / cS^2, Rayleigh's function of one half-space is
    R(c) = 4 a_p a_s - (1 + a_s^2)^2,   zero at the Rayleigh speed (Rayleigh, Proc. London Math. Soc. 17 (1885) 4).
Two half-spaces that slide without friction and without opening carry the generalised Rayleigh wave
    G1 R1 a_p2 (1 - a_s2^2) + G2 R2 a_p1 (1 - a_s1^2) = 0     (Weertman, J. Mech. Phys. Solids 11 (1963) 197;
Achenbach and Epstein, ASCE J. Eng. Mech. 93 (1967) EM5 27). It exists while its speed lies below both shear speeds.
"""

from typing import NamedTuple

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.closed_form.elastic_constants import first_modulus, shear_modulus


class Solid(NamedTuple):
    """An isotropic elastic solid, plane strain or plane stress."""

    youngs_modulus: float   # Pa
    poisson_ratio: float
    density: float          # kg/m^3
    plane_stress: bool = False

    @property
    def shear_modulus(self):
        """G in Pa."""
        return shear_modulus(self.youngs_modulus, self.poisson_ratio)

    @property
    def first_modulus(self):
        """Lame's lambda in Pa, of the plane problem."""
        return first_modulus(self.youngs_modulus, self.poisson_ratio, self.plane_stress)

    @property
    def dilatational_speed(self):
        """cP in m/s."""
        return np.sqrt((self.first_modulus + 2.0 * self.shear_modulus) / self.density)

    @property
    def shear_speed(self):
        """cS in m/s."""
        return np.sqrt(self.shear_modulus / self.density)


def checked(solid, where):
    """``solid``; ConfigError for moduli, densities or Poisson ratios that no wave speed belongs to."""
    if not (solid.youngs_modulus > 0.0 and solid.density > 0.0):
        raise ConfigError(where, "a positive modulus and density", f"{solid.youngs_modulus:g} Pa,"
                          f" {solid.density:g} kg/m^3")
    if not -1.0 < solid.poisson_ratio < 0.5:
        raise ConfigError(f"{where}.poisson_ratio", "a value between -1 and 0.5, both excluded",
                          f"{solid.poisson_ratio:g}", "an incompressible solid has no dilatational wave")
    return solid


def rayleigh_function(speed, solid):
    """R(c), without dimension; ``speed`` below the shear speed."""
    along, across = _decay(speed, solid)
    return 4.0 * along * across - (1.0 + across**2) ** 2


def rayleigh_speed(solid):
    """Speed in m/s of the surface wave of ``solid``."""
    slowest, fastest = 0.2 * solid.shear_speed, (1.0 - 1e-13) * solid.shear_speed
    return scipy.optimize.brentq(rayleigh_function, slowest, fastest, args=(solid,), xtol=1e-12 * solid.shear_speed)


def sliding_function(speed, first, second):
    """Left side of the equation of the generalised Rayleigh wave, Pa; ``speed`` below both shear speeds."""
    (along_1, across_1), (along_2, across_2) = _decay(speed, first), _decay(speed, second)
    return (first.shear_modulus * rayleigh_function(speed, first) * along_2 * (1.0 - across_2**2)
            + second.shear_modulus * rayleigh_function(speed, second) * along_1 * (1.0 - across_1**2))


def generalised_rayleigh_speed(first, second):
    """Speed in m/s of the wave on an interface that slides without friction and without opening; None where none is.

    It lies between the Rayleigh speeds of the two solids and ends where it would pass the slower shear speed.
    """
    slower = min(first.shear_speed, second.shear_speed)
    low = min(rayleigh_speed(first), rayleigh_speed(second))
    high = (1.0 - 1e-13) * slower
    if sliding_function(high, first, second) > 0.0:
        return None
    if abs(rayleigh_speed(first) - rayleigh_speed(second)) < 1e-12 * low:
        return low
    return scipy.optimize.brentq(sliding_function, low * (1.0 - 1e-12), high, args=(first, second), xtol=1e-12 * slower)


def _decay(speed, solid):
    """(a_p, a_s): decay of both potentials away from the surface, over the wavenumber along it."""
    return (np.sqrt(1.0 - (speed / solid.dilatational_speed) ** 2), np.sqrt(1.0 - (speed / solid.shear_speed) ** 2))


def mach_angle(wave_speed, speed):
    """Half angle in rad of the Mach cone of a front at ``speed``; nan where the front is not faster than the wave."""
    return np.arcsin(wave_speed / speed) if speed > wave_speed else np.nan
