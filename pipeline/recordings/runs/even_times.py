"""Channels of uneven time stamps, such as those of a bus, on an even grid; what was done is told."""

from dataclasses import replace

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.recordings.samples import EVEN, GAP, OFF_GRID, interpolated

#: rate in Hz from which on samples stay as they are where their stamps allow it: straight lines would weaken sound
_FAST = 1000.0


def on_even_times(waveform, rate, where):
    """The Waveform with a rate; its time stamps, where they are uneven, become those of an even grid.

    ``rate`` Hz: of samples without a rate, or of the grid; None: that of the usual interval of the stamps. Samples stay
    as they are where their stamps lie on the grid, of fast ones also near it, and between them samples are missing
    (NaN); others are joined by straight lines. Raises ConfigError for stamps that do not rise, and fewer than two.
    """
    if waveform.times is None:
        return waveform if waveform.rate else replace(waveform, rate=rate)
    times, values, remark = _rising(waveform, where)
    step = np.diff(times)
    usual = float(np.median(step))
    wanted = rate or 1.0 / usual
    count = np.rint(step * wanted)
    if (count >= 1).all() and np.abs(step * wanted - count).max() <= OFF_GRID:
        index = np.concatenate([[0], np.cumsum(count)]).astype(int)
        even = rate or index[-1] / (times[-1] - times[0])
        off = float(np.abs(times - times[0] - index / even).max())
        if wanted >= _FAST or off * even <= EVEN:
            spread = np.full(index[-1] + 1, np.nan, values.dtype)
            spread[index] = values
            lost = len(spread) - len(values)
            told = [remark, f"time stamps lie up to {off:.2g} s beside even ones at {even:.6g} Hz, which are taken",
                    f"{lost} of {len(spread)} samples are missing: there are no stamps of them" if lost else ""]
            return replace(waveform, values=spread, rate=float(even), begin=float(times[0]), times=None,
                           remark="; ".join(filter(None, told)))
    return _joined(waveform, times, values, rate or float(f"{1.0 / usual:.2g}"), usual, remark, where)


def _rising(waveform, where):
    """(times, values) (sample,) of a Waveform, the last of those with one stamp, and a remark on what was left out."""
    times, values = np.asarray(waveform.times, float), np.asarray(waveform.values)
    known = np.isfinite(times)
    times, values = times[known], values[known]
    last = np.diff(times, append=np.inf) > 0
    back = int((np.diff(times) < 0).sum())
    if last.sum() < 2 or back:
        raise ConfigError(where, "two time stamps or more, each behind the one before",
                          f"{back} that lie before the one before" if back else f"{int(last.sum())}",
                          "leave the channel out: name the others under 'columns', or state keep_going: true")
    left = len(known) - int(last.sum())
    told = f"{left} of {len(known)} samples are left out: they have no time stamp, or that of the next sample"
    return times[last], values[last], "; ".join(filter(None, [waveform.remark, told if left else ""]))


def _joined(waveform, times, values, rate, usual, remark, where):
    columns, rate = interpolated({"": values}, times, rate, where)
    grid = columns[""].astype(values.dtype)
    lost, uneven = int(np.isnan(grid).sum()), float(np.abs(np.diff(times) - usual).max())
    told = [remark, f"time stamps are {usual:.3g} s apart, some {uneven:.2g} s more or less: straight lines between"
            f" them are read at {rate:g} Hz from {times[0]:.6g} s on"]
    if rate >= _FAST:
        told.append(f"what lies above {rate / 10:.3g} Hz is weaker there")
    if lost:
        told.append(f"{lost} of {len(grid)} samples are missing, where stamps lie more than {GAP} intervals apart (a"
                    " lower sample_rate joins them) or samples were missing")
    return replace(waveform, values=grid, rate=rate, begin=float(times[0]), times=None,
                   remark="; ".join(filter(None, told)))
