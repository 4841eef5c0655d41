"""Height variance of a periodic map by wavelength and direction: bands of the radially averaged spectrum, sectors."""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError

#: ratio of the wavelengths of a band, where bands are wider than one wave over the patch
RATIO = 1.35


@dataclass(frozen=True)
class Bands:
    """Wavelengths (bands + 1,) in m that bound the bands, falling; height variance of each over the whole (bands,).

    ``directions`` (bands, sectors): share of the variance of a band in sectors of the wave vector's angle to x over
    half a turn, the first about x; None for an isotropic surface.
    """

    wavelength: np.ndarray
    variance: np.ndarray
    directions: np.ndarray | None = None


def band_edges(length, shortest):
    """Wavelengths (bands + 1,) in m, falling: bands of one wave over the patch, further up of a constant ratio.

    They cover all waves of a patch of ``length`` m down to ``shortest`` m.
    """
    last, waves = length / shortest, [0.5]
    while waves[-1] <= last:
        waves.append(max(waves[-1] + 1.0, waves[-1] * RATIO))
    if len(waves) > 2 and last < np.sqrt(waves[-1] * waves[-2]):
        waves.pop(-2)
    return length / np.array([*waves[:-1], last * 1.001])


def measured_bands(heights, length, wavelength, sectors):
    """Bands of a periodic map (n, n) on a square of ``length`` m within the bounds ``wavelength`` (m)."""
    cells = Cells(heights.shape[0], length, wavelength, sectors)
    energy = cells.energy(scipy.fft.rfft2(heights)).reshape(len(wavelength) - 1, sectors)
    variance = energy.sum(axis=1)
    counts = cells.modes.reshape(energy.shape)
    shares = np.where(variance[:, None] > 0.0, energy, counts)
    return Bands(np.asarray(wavelength), variance / variance.sum(), _normalised(shares))


class Cells:
    """Waves of a square grid sorted into cells of a band and a sector, numbered band after band.

    Waves outside all bands or below ``shortest`` (m) belong to none.
    """

    def __init__(self, size, length, wavelength, sectors, shortest=0.0):
        wave_y = np.fft.fftfreq(size, length / size)[:, None]
        wave_x = np.fft.rfftfreq(size, length / size)[None, :]
        self.wave = np.hypot(wave_y, wave_x)
        band = np.searchsorted(1.0 / np.asarray(wavelength), self.wave, side="right") - 1
        sector = np.round(np.arctan2(wave_y, wave_x) / np.pi * sectors).astype(int) % sectors
        self.count = (len(wavelength) - 1) * sectors
        inside = (band >= 0) & (band < len(wavelength) - 1) & (self.wave * shortest <= 1.0 + 1e-9)
        self._cell = np.where(inside, band * sectors + sector, self.count)
        twice = np.full(self.wave.shape, 2.0)       # rfft2 holds one of each pair of conjugate waves ...
        twice[:, 0] = 1.0                           # ... both of those along y
        if size % 2 == 0:
            twice[:, -1] = 1.0
        self._weight = twice / size ** 4
        self.modes = self._sum(twice)

    def energy(self, spectrum):
        """Variance (cells,) of the map with the ``rfft2`` ``spectrum``."""
        return self._sum(self._weight * (spectrum.real ** 2 + spectrum.imag ** 2))

    def project(self, spectrum, target):
        """The spectrum scaled cell by cell to the variances ``target`` (cells,), without waves outside all cells."""
        energy = self.energy(spectrum)
        factor = np.sqrt(np.divide(target, energy, out=np.zeros_like(energy), where=energy > 0.0))
        return spectrum * np.append(factor, 0.0)[self._cell]

    def within(self, spectrum):
        """The spectrum without waves outside all cells."""
        return np.where(self._cell < self.count, spectrum, 0.0)

    def slope(self, bands):
        """Factor (size, size // 2 + 1) on white noise by which amplitudes fall within the bands, from each to the next.

        The logarithm of the spectral density is linear in that of the wave between the middles of the bands, and beyond
        the first and the last.
        """
        bound = 1.0 / np.asarray(bands.wavelength)
        middle, area = np.sqrt(bound[1:] * bound[:-1]), bound[1:] ** 2 - bound[:-1] ** 2
        filled = np.asarray(bands.variance) > 0.0
        density, middle = np.log(np.asarray(bands.variance)[filled] / area[filled]), np.log(middle[filled])
        if len(middle) == 1:
            return np.ones(self.wave.shape)
        wave = np.clip(np.log(np.where(self.wave > 0.0, self.wave, bound[0])), *np.log(bound[[0, -1]]))
        part = np.clip(np.searchsorted(middle, wave) - 1, 0, len(middle) - 2)
        rise = np.diff(density) / np.diff(middle)
        return np.exp(0.5 * (density[part] + rise[part] * (wave - middle[part])))

    def target(self, bands):
        """Variance (cells,) that Bands prescribe, where a cell has waves; its sum is 1.

        Raises ConfigError for a band without waves on this grid that has more than 1 % of the variance.
        """
        variance = np.asarray(bands.variance)
        modes = self.modes.reshape(len(variance), -1)
        empty = (modes.sum(axis=1) == 0) & (variance > 0.01)
        if empty.any():
            first = int(np.argmax(empty))
            raise ConfigError("rough surface", "a patch that holds waves of every band of the spectrum",
                              f"none from {bands.wavelength[first]:.3g} to {bands.wavelength[first + 1]:.3g} m",
                              "take patch length and shortest wavelength of the fit, or fit the scan for yours")
        shares = modes if bands.directions is None else np.where(modes > 0, bands.directions, 0.0)
        shares = np.where(shares.sum(axis=1, keepdims=True) > 0.0, shares, modes)
        target = variance[:, None] * _normalised(shares)
        return (target / target.sum()).ravel()

    def _sum(self, values):
        return np.bincount(self._cell.ravel(), values.ravel(), self.count + 1)[:-1]


def _normalised(shares):
    total = shares.sum(axis=1, keepdims=True)
    return np.divide(shares, total, out=np.zeros(shares.shape), where=total > 0.0)
