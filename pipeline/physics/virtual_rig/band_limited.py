"""Inputs that hold nothing above half their sample rate: their course between samples, as steps see it.

Source: Oppenheim and Schafer, Discrete-Time Signal Processing, sections 4.6 (interpolation) and 7.5 (Kaiser window).
"""

from functools import lru_cache

import numpy as np
import scipy

#: samples to either side that take part in what lies between two, and the shape of the window over them: 1e-5 up to
#: .45 of the sample rate
_REACH, _SHAPE = 32, 9.0


def refined(samples, parts):
    """Samples (parts (n - 1) + 1,) at ``parts`` times the rate of ``samples`` (n,), which straight lines between them
    turn into what lies between those given.

    Up to .45 of the rate given. Beyond both ends the samples are turned over, so that they go on as they end.
    """
    samples = np.array(samples, float)
    return samples if not samples.ndim or len(samples) < 2 else _refined(samples.tobytes(), parts)


@lru_cache(maxsize=16)      # a fit runs the same inputs again and again
def _refined(content, parts):
    samples = np.frombuffer(content)
    added = min(2 * _REACH, len(samples) - 1)
    extended = np.concatenate((2 * samples[0] - samples[added:0:-1], samples,
                               2 * samples[-1] - samples[-2:-added - 2:-1]))
    if parts > 1:
        window = scipy.signal.firwin(2 * _REACH * parts + 1, 1 / parts, window=("kaiser", _SHAPE))
        extended = scipy.signal.resample_poly(extended, parts, 1, window=window)
    finer = _compensated(extended)[added * parts:(added + len(samples) - 1) * parts + 1].copy()
    finer.flags.writeable = False
    return finer


def _compensated(samples):
    """Samples (n,) that straight lines between them, whose spectrum is that of samples times sinc^2 (f / rate), turn
    into what was applied."""
    longer = scipy.fft.next_fast_len(len(samples), real=True)
    spectrum = np.fft.rfft(samples, longer) / np.sinc(np.fft.rfftfreq(longer)) ** 2
    return np.fft.irfft(spectrum, longer)[:len(samples)]
