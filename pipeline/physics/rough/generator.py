"""Seeded rough surfaces: a turned cast-iron disc and a brake pad. Periodic, with a physical shortest wavelength.

Every surface is composed on its own construction grid (a fixed number of nodes per shortest wavelength), cut at the
shortest wavelength and only then resampled: the same seed gives the same surface on every grid. Heights point out of
the solid, have zero mean and the rms asked for; x (last axis) is the sliding direction.
"""

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError

CONSTRUCTION_NODES = 4


def turned_disc(nodes, length, shortest, rms_height, *, seed, feed, marks_share, roughness_wavelength, hurst,
                outbreak_share, outbreak_size, outbreak_depth):
    """Turned cast iron (nodes, nodes) in m on a square patch of ``length`` m.

    Tool marks run along x with a whole number of feeds near ``feed`` (m) in the patch and carry ``marks_share`` of the
    variance, a self-affine roughness (``hurst``, roll-off ``roughness_wavelength`` in m) the rest. Grain outbreaks are
    round pits of diameter ``outbreak_size`` (m) on ``outbreak_share`` of the area, ``outbreak_depth`` times the
    rms of the rest deep at their centre. Raises ConfigError for feeds below ``shortest``.
    """
    size, random = construction_size(length, shortest), np.random.default_rng(seed)
    fed = length / max(round(length / feed), 1)
    if fed < 0.99 * shortest:
        raise ConfigError("feed of the turned disc", f"at least {shortest:g} m, the shortest wavelength of the surface",
                          f"{fed:g} m", "raise surface.disc.feed, or surface.nodes and lower the wavelength")
    phase = np.arange(size) / size * max(round(length / feed), 1)
    cusp = (2.0 * np.abs(phase - np.round(phase))) ** 2
    marks = np.repeat(_standard(cusp)[:, None], size, axis=1)
    rough = self_affine(random, size, length, shortest, roughness_wavelength, hurst)
    heights = np.sqrt(marks_share) * marks + np.sqrt(1.0 - marks_share) * rough
    pits = _pits(random, size, length, outbreak_share, outbreak_size)
    return _finish(heights - outbreak_depth * pits, nodes, length, shortest, rms_height)


def plateau_pad(nodes, length, shortest, rms_height, *, seed, plateau_share, plateau_size, plateau_height,
                plateau_roughness, edge_width, roughness_wavelength, hurst):
    """Brake pad (nodes, nodes) in m: rough plateaus (hard particles) over a smoother matrix (resin).

    Plateaus cover ``plateau_share`` of the patch, are ``plateau_size`` (m) apart, stand ``plateau_height`` times the
    rms of the matrix above it and are ``plateau_roughness`` times as rough; the step is ``edge_width`` of the plateau
    field's rms wide. Both textures are self-affine (``hurst``, roll-off ``roughness_wavelength`` in m).
    """
    random = np.random.default_rng(seed)
    size = construction_size(length, shortest)
    field = self_affine(random, size, length, shortest, plateau_size, 1.0)
    threshold = np.quantile(field, 1.0 - plateau_share)
    plateau = 0.5 + 0.5 * np.tanh((field - threshold) / edge_width)
    rough, matrix = (self_affine(random, size, length, shortest, roughness_wavelength, hurst) for _ in range(2))
    heights = plateau * (plateau_height + plateau_roughness * rough) + (1.0 - plateau) * matrix
    return _finish(heights, nodes, length, shortest, rms_height)


def self_affine(random, size, length, shortest, roll_off, hurst):
    """Gaussian roughness (size, size) of unit rms: spectrum flat down to ``roll_off``, then as k^(-2 - 2 hurst)."""
    wave = _wavenumber((size, size), length)
    knee = 2 * np.pi / roll_off
    amplitude = np.maximum(wave, knee) ** (-1.0 - hurst) * (wave <= 2 * np.pi / shortest)
    noise = random.standard_normal((size, size))
    return _standard(scipy.fft.irfft2(amplitude * scipy.fft.rfft2(noise), s=(size, size)))


def band_limit(heights, length, shortest, longest=np.inf):
    """Periodic map with wavelengths from ``shortest`` to ``longest`` (m) only, zero mean; ``length`` is (y, x) in m."""
    wave = _wavenumber(heights.shape, length)
    keep = (wave <= 2 * np.pi / shortest * (1 + 1e-12)) & (wave >= 2 * np.pi / longest * (1 - 1e-12)) & (wave > 0)
    return scipy.fft.irfft2(keep * scipy.fft.rfft2(heights), s=heights.shape)


def resample(heights, shape):
    """Fourier interpolation of a periodic map to ``shape``; exact for what both grids resolve."""
    spectrum = np.fft.fftshift(np.fft.fft2(heights))
    result = np.zeros(shape, dtype=complex)
    common = [min(a, b) // 2 * 2 - 1 for a, b in zip(heights.shape, shape, strict=True)]
    cut = tuple(slice(n // 2 - c // 2, n // 2 + c // 2 + 1) for n, c in zip(heights.shape, common, strict=True))
    paste = tuple(slice(n // 2 - c // 2, n // 2 + c // 2 + 1) for n, c in zip(shape, common, strict=True))
    result[paste] = spectrum[cut]
    return np.fft.ifft2(np.fft.ifftshift(result)).real * (np.prod(shape) / heights.size)


def construction_size(length, shortest):
    """Nodes along the edge of the construction grid; ConfigError unless 0 < ``shortest`` <= ``length`` (m)."""
    if not 0.0 < shortest <= length:
        raise ConfigError("rough surface", "0 < shortest wavelength <= patch length", f"{shortest:g} m, {length:g} m")
    return int(np.ceil(CONSTRUCTION_NODES * length / shortest / 2.0)) * 2


def _pits(random, size, length, share, diameter):
    """Pits of unit depth: as many cosine bowls at random places as fill ``share`` of the area."""
    position = np.arange(size) * (length / size)
    pits = np.zeros((size, size))
    for centre in random.uniform(0.0, length, (round(share * length ** 2 / (np.pi / 4.0 * diameter ** 2)), 2)):
        away = [np.abs((position - c + length / 2.0) % length - length / 2.0) for c in centre]
        radius = np.hypot(away[0][:, None], away[1][None, :])
        bowl = np.where(radius < diameter / 2.0, 0.5 + 0.5 * np.cos(2 * np.pi * radius / diameter), 0.0)
        pits = np.maximum(pits, bowl)
    return pits


def _finish(heights, nodes, length, shortest, rms_height):
    limited = band_limit(heights, (length, length), shortest)
    return rms_height * _standard(resample(limited, (nodes, nodes)))


def _standard(values):
    centred = values - values.mean()
    return centred / centred.std()


def _wavenumber(shape, length):
    length_y, length_x = np.broadcast_to(length, 2)
    wave_y = 2 * np.pi * np.fft.fftfreq(shape[0], length_y / shape[0])[:, None]
    wave_x = 2 * np.pi * np.fft.rfftfreq(shape[1], length_x / shape[1])[None, :]
    return np.hypot(wave_y, wave_x)
