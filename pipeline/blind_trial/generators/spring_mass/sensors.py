"""Sensor chain of a trial: delay, gain, clipping, zero, coloured noise and the steps of a converter of 16 bit."""

from dataclasses import dataclass

import numpy as np
from scipy.signal import lfilter

BITS = 16


@dataclass(frozen=True)
class Chain:
    """``delay`` s; ``gain`` and ``offset`` + ``drift`` t of what is shown; ``limit`` at which it clips."""

    delay: float = 0.0
    gain: float = 1.0
    offset: float = 0.0
    drift: float = 0.0
    limit: float = np.inf

    def shown(self, time, fine, values):
        """Samples (n,) at ``time`` of ``values`` on the ``fine`` grid, without noise."""
        seen = self.gain * np.interp(time - self.delay, fine, values) + self.offset + self.drift * time
        return np.clip(seen, -self.limit, self.limit)


def noise(random, samples, colour):
    """First-order autoregressive noise (samples,) of standard deviation 1; ``colour`` its correlation over a sample."""
    start = random.standard_normal(1)
    driven = np.sqrt(1 - colour**2) * random.standard_normal(samples)
    return lfilter([1.0], [1.0, -colour], driven, zi=colour * start)[0]


def converted(values, span):
    """Values in the steps of a converter that spans -``span`` to ``span``."""
    step = 2 * span / 2**BITS
    return step * np.round(np.clip(values, -span, span) / step)
