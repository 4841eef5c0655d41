"""Even sampling rates from instants that were rounded when they were written."""

from dataclasses import dataclass

import numpy as np
import scipy

#: decimals and significant digits of instants that are tried, and what a number may be off them, in their last place
_DECIMALS, _DIGITS, _OFF = range(10), range(4, 10), 1e-3
#: rates that agree with the instants may differ by so much of them
_WIDE = 1e-3
#: steps unlike the usual one below which samples were lost rather than instants rounded
_FEW = 5


@dataclass(frozen=True)
class Rounded:
    """``rate`` in Hz of an even grid that agrees with instants rounded to ``step`` s; ``lowest`` and ``highest`` rate
    that do."""

    rate: float
    step: float
    lowest: float
    highest: float


def rounded_rate(time, known=None):
    """Rounded of instants (sample,) in s, None where no even grid agrees with them but for their rounding.

    The rate is ``known`` where that agrees, else of all that agree the one of fewest digits, itself or its interval.
    """
    time = np.asarray(time)
    if known is not None and agrees(time, known):
        return Rounded(known, float(2.0 * np.max(roundings(time)[-1])), known, known)
    for bound in roundings(time):
        agreeing = _agreeing(time.astype(float) - float(time[0]), bound)
        if agreeing and not _lost(time, np.max(bound)):
            low, high = 1.0 / agreeing[1], 1.0 / agreeing[0]
            step = float(2.0 * np.max(bound))
            return None if high - low > _WIDE * low else Rounded(_simplest(low, high), step, low, high)
    return None


def agrees(time, rate):
    """Whether instants (sample,) in s are those of a whole even grid of ``rate`` Hz but for their rounding."""
    time = np.asarray(time)
    left = time.astype(float) - float(time[0]) - np.arange(len(time)) / rate
    return any(_spread(left, bound) <= 0.0 and not (_multiple(rate, bound) and np.ptp(left) > _OFF * np.max(bound))
               for bound in roundings(time))


def _multiple(rate, bound):
    """Whether intervals are whole multiples of what instants are rounded to: rounding leaves such ones even."""
    steps = 1.0 / (rate * 2.0 * np.max(bound))
    return steps > 0.5 and abs(steps - np.rint(steps)) < _OFF * steps


def roundings(time):
    """Largest errors in s, one or (sample,), that rounding may have made of instants, the smallest first."""
    bounds, size = [], np.abs(time.astype(float))
    single = time.astype(np.float32)
    if (single == time).all():
        bounds.append(0.5 * float(np.spacing(np.abs(single)).max()))
    exponent = np.floor(np.log10(np.where(size > 0, size, 1.0)))
    for digits in _DIGITS:
        last = 10.0 ** (exponent + 1 - digits)
        if _whole(size / last):
            bounds.append(0.5 * np.where(size > 0, last, 0.0))
            break
    decimals = next((k for k in _DECIMALS if _whole(size * 10.0 ** k)), None)
    return bounds if decimals is None else [*bounds, 0.5 * 10.0 ** -decimals]


def _whole(values):
    return bool((np.abs(values - np.rint(values)) < _OFF).all())


def _spread(left, bound):
    """How far what a grid leaves of instants goes beyond their rounding; an allowance for the numbers themselves."""
    margin = bound * (1.0 + _OFF) + 1e-12
    return float(np.max(left - margin) - np.min(left + margin))


def _agreeing(time, bound):
    """(shortest, longest) interval of even grids that agree with instants from 0 s but for ``bound``; None of none."""
    count = np.arange(len(time))
    if len(time) < 3 or not time[-1] > 0:
        return None
    usual, reach = time[-1] / count[-1], 2.0 * float(np.max(bound)) / count[-1]
    if not 0 < reach < 0.5 * usual:
        return None

    left = time - usual * count

    def beyond(more):
        return _spread(left - more * count, bound)

    best = scipy.optimize.minimize_scalar(beyond, bounds=(-1.5 * reach, 1.5 * reach), method="bounded",
                                          options={"xatol": 1e-6 * reach}).x
    if beyond(best) > 0.0:
        return None
    shortest, longest = (_end(beyond, best, best + sign * 2.5 * reach) for sign in (-1, 1))
    return usual + shortest, usual + longest


def _end(beyond, inside, outside):
    for _ in range(40):
        middle = 0.5 * (inside + outside)
        inside, outside = (middle, outside) if beyond(middle) <= 0.0 else (inside, middle)
    return inside


def _lost(time, bound):
    """Whether steps that are all multiples of the usual one say that samples were lost: rounding would look alike."""
    steps = np.rint(np.diff(time.astype(float)) / (2.0 * bound)).astype(int)
    values, counts = np.unique(steps, return_counts=True)
    usual = values[counts.argmax()]
    odd = steps != usual
    return bool(usual > 0 and odd.any() and odd.sum() < _FEW and (steps > 0).all() and (steps % usual == 0).all())


def _simplest(low, high):
    """The number of fewest digits between two, or the inverse of the one of fewer digits between their inverses."""
    rate, digits = _short(low, high)
    interval, others = _short(1.0 / high, 1.0 / low)
    return rate if digits <= others else 1.0 / interval


def _short(low, high):
    middle = 0.5 * (low + high)
    for digits in range(1, 17):
        short = float(f"{middle:.{digits - 1}e}")
        if low <= short <= high:
            return short, digits
    return middle, 17
