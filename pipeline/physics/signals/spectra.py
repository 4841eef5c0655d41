"""Power spectra, third-octave bands and levels of vibration signals."""

import numpy as np
import scipy

#: base-ten octave ratio of IEC 61260-1
_OCTAVE = 10**0.3
#: pole frequencies of the A-weighting [Hz]
_A_POLES = (20.598997, 107.65265, 737.86223, 12194.217)
#: sound pressure of 0 dB [Pa] (ISO 1683)
HEARING = 20e-6
#: level of silence: a mean square of zero has no logarithm
LOWEST_LEVEL = -200.0


def power_spectrum(signal, rate, resolution):
    """One-sided power spectral density of the last axis: Welch, Hann segments, half overlapped, mean removed.

    ``rate`` [Hz], ``resolution`` distance of the lines [Hz]; a signal too short for it gives one
    segment. Returns frequency (line,) [Hz] and density (..., line) [unit^2/Hz].
    """
    segment = min(signal.shape[-1], round(rate / resolution))
    return scipy.signal.welch(signal, rate, "hann", segment)


def third_octave_bands(lowest, highest):
    """Exact mid-frequencies [Hz] of the third-octave bands whose middle lies in lowest..highest (IEC 61260-1)."""
    order = np.arange(-60, 61)
    middle = 1000 * _OCTAVE**(order / 3)
    return middle[(middle > lowest * _OCTAVE**(-1 / 6)) & (middle < highest * _OCTAVE**(1 / 6))]


def band_power(frequency, density, middle):
    """Mean square (..., band) in third-octave bands: each spectral line counts over its own width."""
    width = frequency[1] - frequency[0]
    edge = np.append(frequency - width / 2, frequency[-1] + width / 2)
    edge[0] = 0
    power = np.cumsum(density * np.diff(edge), axis=-1)
    power = np.concatenate([np.zeros((*power.shape[:-1], 1)), power], axis=-1)
    low, high = middle * _OCTAVE**(-1 / 6), middle * _OCTAVE**(1 / 6)
    rows = power.reshape(-1, power.shape[-1])
    bands = np.array([np.interp(high, edge, row) - np.interp(low, edge, row) for row in rows])
    return bands.reshape(*density.shape[:-1], len(middle))


def a_weighting(frequency):
    """Factor (...) of the A-weighting on amplitudes at ``frequency`` (...) [Hz]; 1 at 1 kHz.

    Source: IEC 61672-1, annex E, with its exact pole frequencies.
    """
    squared = np.square(np.asarray(frequency, float))

    def response(f):
        low, first, second, high = (pole**2 for pole in _A_POLES)
        return high * f**2 / ((f + low) * np.sqrt((f + first) * (f + second)) * (f + high))

    return response(squared) / response(1e6)


def level(mean_square, reference):
    """Level in dB of a mean square re ``reference`` squared; LOWEST_LEVEL stands for silence."""
    floor = reference**2 * 10**(LOWEST_LEVEL / 10)
    return 10 * np.log10(np.maximum(mean_square, floor) / reference**2)
