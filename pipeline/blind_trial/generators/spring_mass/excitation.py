"""Excitations of a shaker: multisine of random phases, sweep, band noise; each of root mean square 1."""

import numpy as np

KINDS = ("multisine", "sweep", "band_noise")


def force(kind, random, samples, interval, band):
    """(samples,) of ``kind`` between the frequencies ``band`` (low, high) Hz, of root mean square 1."""
    shaped = {"multisine": _multisine, "sweep": _sweep, "band_noise": _band_noise}[kind](
        random, interval * np.arange(samples), band)
    return shaped / np.sqrt(np.mean(shaped**2))


def _multisine(random, time, band):
    """Lines of one size at even distances: M. R. Schroeder, IEEE Trans. Inf. Theory 16 (1970) 85, phases random."""
    lines = np.linspace(*band, 8)
    return np.cos(2 * np.pi * np.outer(lines, time) + random.uniform(0, 2 * np.pi, (8, 1))).sum(axis=0)


def _sweep(random, time, band):
    low, high = band
    return np.sin(2 * np.pi * (low + 0.5 * (high - low) * time / time[-1]) * time + random.uniform(0, 2 * np.pi))


def _band_noise(random, time, band):
    spectrum = np.fft.rfft(random.standard_normal(len(time)))
    frequency = np.fft.rfftfreq(len(time), time[1])
    return np.fft.irfft(np.where((frequency >= band[0]) & (frequency <= band[1]), spectrum, 0), len(time))
