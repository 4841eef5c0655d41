"""Sensors with filters of their own, converters and coarse, uneven samples, in the units that a bench would write.

Filter: second-order Bessel of delay tau, H = 3 / (3 + 3 s tau + (s tau)^2). To the third order in s tau it is a
first-order low pass of time constant tau / sqrt(3) behind a delay of (1 - 1 / sqrt(3)) tau, which is how the workshop
states it.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy

#: instants of a motion per sample
PARTS = 8
#: quantity: (field of a Motion, its unit, units that channels are written in with their size in SI)
QUANTITIES = {"displacement": ("m", {"mm": 1e-3, "um": 1e-6, "m": 1.0}),
              "velocity": ("m/s", {"mm/s": 1e-3, "m/s": 1.0}),
              "acceleration": ("m/s^2", {"g": 9.80665, "m/s^2": 1.0})}
_BITS = 16


@dataclass(frozen=True)
class Sensor:
    """A channel ``name`` of the ``quantity`` of a ``body``, written in ``unit``; ``tau`` s of its filter.

    ``gain``, further ``delay`` s, ``limit`` beyond which it clips, ``offset`` and ``drift`` per s, all in SI.
    """

    name: str
    body: int
    quantity: str
    unit: str
    tau: float
    gain: float = 1.0
    delay: float = 0.0
    limit: float = np.inf
    offset: float = 0.0
    drift: float = 0.0

    @property
    def per_unit(self):
        """SI value of its unit."""
        return QUANTITIES[self.quantity][1][self.unit]

    @property
    def si(self):
        return QUANTITIES[self.quantity][0]

    @property
    def stated_corner(self):
        """Hz of the equivalent first-order filter."""
        return np.sqrt(3) / (2 * np.pi * self.tau)

    @property
    def stated_delay(self):
        """s of delay beside that filter."""
        return (1 - 1 / np.sqrt(3)) * self.tau

    def shown(self, motion, fine, time):
        """Samples (n,) in SI at ``time`` of a Motion at the even instants ``fine``, at rest or settled before them."""
        course = getattr(motion, self.quantity)[self.body]
        held = filtered(course, fine[1] - fine[0], self.tau)
        seen = np.interp(time - self.delay, fine, held)
        seen = self.gain * seen + self.offset + self.drift * (time - time[0])
        return np.clip(seen, -self.limit, self.limit)


def filtered(course, step, tau):
    """A course (n,) through the Bessel filter of delay ``tau``: exact between straight lines."""
    taps, denominator, settled = _discrete(float(step), float(tau))
    return scipy.signal.lfilter(taps, denominator, course, zi=settled * course[0])[0]


@lru_cache(maxsize=256)
def _discrete(step, tau):
    """(numerator, denominator, state of a constant 1) of the filter at instants ``step`` s apart; a case asks for a few
    of them thousands of times."""
    numerator, denominator, _ = scipy.signal.cont2discrete(([3.0], [tau**2, 3 * tau, 3.0]), step, "foh")
    taps = numerator.ravel()
    return taps, denominator, scipy.signal.lfilter_zi(taps, denominator)


def noise(random, count, colour):
    """Noise (n,) of standard deviation 1 whose neighbours have the correlation ``colour``."""
    white = random.standard_normal(count)
    white[1:] *= np.sqrt(1 - colour**2)
    return scipy.signal.lfilter([1.0], [1.0, -colour], white)


def written(samples, unit_size, missing):
    """Samples in the unit of a channel, as a converter rounds them, NaN where they are ``missing``."""
    reach = 1.3 * np.abs(samples).max()
    step = 2 * reach / 2**_BITS
    return np.where(missing, np.nan, np.round(samples / step) * step / unit_size)


def gaps(random, count, kind):
    """(n,) True where a sample is missing: '' none, ``bursts`` of lost ones, ``uneven``: about half at random."""
    missing = np.zeros(count, bool)
    if kind == "uneven":
        missing = random.uniform(size=count) > random.uniform(0.45, 0.7)
    if kind == "bursts":
        for start in random.integers(count // 10, count, 6):
            missing[start:start + random.integers(3, 20)] = True
    return missing
