"""Flash temperature of the contact spots: heat sources that rest on the pad and move over the disc.

Quasi-steady conduction into two half-spaces, solved per wavenumber: surface rise = heat flux / (conductivity * root),
root^2 = k^2 + i kx speed / diffusivity (Carslaw & Jaeger's moving source in Fourier form). The uniform part
(wavenumber 0) is bulk heating and not a flash; heat is shared by Blok's rule of equal mean rise of the spots.
"""

from dataclasses import dataclass

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
    wave_y = 2 * np.pi * np.fft.fftfreq(flux.shape[0], spacing[0])[:, None]
    wave_x = 2 * np.pi * np.fft.rfftfreq(flux.shape[1], spacing[1])[None, :]
    root = np.sqrt(wave_y ** 2 + wave_x ** 2 + 1j * wave_x * speed / solid.diffusivity)
    heat = scipy.fft.rfft2(flux)
    root[0, 0], heat[0, 0] = 1.0, 0.0
    return scipy.fft.irfft2(heat / (solid.conductivity * root), s=flux.shape)


def spot_heating(contact, spacing, resting, passing, speed):
    """Mean flash rise of the contact spots per shear limit, in K/Pa.

    ``contact`` (ny, nx) is the mask of spots, each dissipating shear limit * ``speed``; ``resting`` and ``passing`` are
    the ThermalSolids on which the spots rest and over which they move.
    """
    flux = np.where(contact, speed, 0.0)
    rest = surface_rise(flux, spacing, resting, 0.0)[contact].mean()
    passed = surface_rise(flux, spacing, passing, speed)[contact].mean()
    return rest * passed / (rest + passed)
