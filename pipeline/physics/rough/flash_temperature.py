"""Flash temperature of the contact spots: heat sources that rest on the pad and move over the disc.

Quasi-steady conduction into two half-spaces, solved per wavenumber: surface rise = heat flux / (conductivity * root),
root^2 = k^2 + i kx speed / diffusivity (Carslaw & Jaeger's moving source in Fourier form). The uniform part
(wavenumber 0) is bulk heating and not a flash; heat is shared by Blok's rule of equal mean rise of the spots.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy


@dataclass(frozen=True)
class ThermalSolid:
    """Thermal data of one solid: conductivity W/m/K, density kg/m^3, heat capacity J/K/kg."""

    conductivity: float
    density: float
    capacity: float

    @property
    def diffusivity(self):
        """Thermal diffusivity in m^2/s."""
        return self.conductivity / (self.density * self.capacity)


def surface_rise(flux, spacing, solid, speed):
    """Temperature rise (ny, nx) in K by a heat ``flux`` map in W/m^2 that moves along x at ``speed`` over ``solid``."""
    return scipy.fft.irfft2(scipy.fft.rfft2(flux) * _rise_of_waves(flux.shape, spacing, solid, speed), s=flux.shape)


def spot_heating(contact, spacing, resting, passing, speeds):
    """Mean flash rise of the contact spots per shear limit at each of the ``speeds`` (n,), in K/Pa.

    ``contact`` (ny, nx) is the mask of spots, each dissipating shear limit * speed; ``resting`` and ``passing`` are
    the ThermalSolids on which the spots rest and over which they move.
    """
    power = np.abs(scipy.fft.rfft2(contact.astype(float))) ** 2 / (contact.size * np.count_nonzero(contact))
    shape, spacing, speeds = contact.shape, tuple(spacing), np.asarray(speeds, float)
    rest = speeds * np.vdot(power, _mean_rise(shape, spacing, resting, 0.0))
    passed = speeds * [np.vdot(power, _mean_rise(shape, spacing, passing, speed)) for speed in speeds.tolist()]
    return rest * passed / (rest + passed)


def _rise_of_waves(shape, spacing, solid, speed):
    """Rise (ny, nx // 2 + 1) in K of each wave of a heat flux of 1 W/m^2, 0 of the uniform one."""
    wave_y = 2 * np.pi * np.fft.fftfreq(shape[0], spacing[0])[:, None]
    wave_x = 2 * np.pi * np.fft.rfftfreq(shape[1], spacing[1])[None, :]
    root = np.sqrt(wave_y ** 2 + wave_x ** 2 + 1j * wave_x * speed / solid.diffusivity)
    root[0, 0] = 1.0
    rise = 1.0 / (solid.conductivity * root)
    rise[0, 0] = 0.0
    return rise


@lru_cache(maxsize=16)
def _mean_rise(shape, spacing, solid, speed):
    """Weight (ny, nx // 2 + 1) of the power of each wave in the mean rise of the spots (Parseval)."""
    rise = _rise_of_waves(shape, spacing, solid, speed).real
    rise[:, 1:(shape[1] + 1) // 2] *= 2.0       # a wave and its mirror image
    rise.flags.writeable = False
    return rise
