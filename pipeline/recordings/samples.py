"""From a column of numbers to a channel: SI units, gaps in the data, a constant sampling rate."""

from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.contract.mapped import Growing, Slices, blocks
from pipeline.contract.units import in_si
from pipeline.products import Channel
from pipeline.recordings.tables.rounded import agrees, rounded_rate, roundings

#: roles of a channel: measured response, or imposed excitation
ROLES = ("response", "excitation")
#: largest deviation of a sampling instant from an even grid, as a fraction of the interval
EVEN = 0.01
#: the same of instants that were not rounded, but for their numbers
_EXACT = 1e-6
#: parts of a record of a calibrator, each loud or not
_BLOCKS = 40
#: largest distance of an instant from a declared grid, in intervals
OFF_GRID = 0.25
#: distance in intervals within which an instant is one of the grid
_AT = 1e-6
#: intervals of a grid without a sample beyond which nothing is interpolated
GAP = 3


def channel(values, unit, measures, rate, begin, where, *, factor=1.0, narrow=False, role="response", place="",
            position=(), direction=(), line=""):
    """Channel of ``factor`` times ``values`` (sample,) in ``unit``; samples that are not finite are missing.

    ``rate`` Hz and ``begin`` s: sampling rate and time of the first sample. ``narrow``: float32 stays float32.
    ``line``: what to write in the case of its unit. Raises ConfigError, with ``where``, for a unit that no channel or
    not this quantity can have, a rate that is not positive and a channel without any valid sample.
    """
    if not (np.isfinite(rate) and rate > 0):
        raise ConfigError(f"{where}: sample_rate", "a rate above 0 Hz", f"{rate:g}")
    if np.iscomplexobj(values):
        raise ConfigError(where, "real samples", "complex ones", "complex spectra go into frf")
    if role not in ROLES:
        raise ConfigError(f"{where}: role", f"one of {', '.join(ROLES)}", repr(role))
    samples, missing, name = _converted(np.asarray(values, None if narrow else float), factor, unit, measures, where,
                                        line)
    if not len(samples) or missing.tolist() == [[0, len(samples)]]:
        raise ConfigError(where, "samples", "none that are finite")
    return Channel(samples=samples, missing=missing, unit=name, measures=measures, rate=rate, begin=begin, place=place,
                   position=position, direction=_unit_vector(direction, where), role=role)


def _converted(values, factor, unit, measures, where, line):
    """(samples (sample,), 0 where missing, gaps (gap, 2), SI unit) of values in ``unit``, block by block."""
    samples, gaps, count, name = Growing(np.float32 if values.dtype == np.float32 else float), [], 0, ""
    for block in blocks(values):
        converted, name = in_si(factor * np.asarray(block, float), unit, f"{where}: unit", measures, line)
        good = np.isfinite(converted)
        gaps += (count + stretches(~good)).tolist() if not good.all() else []
        samples.append(np.where(good, converted, 0.0))
        count += len(block)
    return samples.array(), _joined(gaps), name


def _joined(gaps):
    """(n, 2) of the gaps [first, after its last], one where a gap goes on in the next block."""
    joined = []
    for first, last in gaps:
        if joined and joined[-1][1] == first:
            joined[-1][1] = last
        else:
            joined.append([first, last])
    return np.array(joined, int).reshape(-1, 2)


def with_gaps(one, part=slice(None)):
    """Samples (n,) of a Channel, NaN where they are missing; ``part``: of these alone."""
    first, last, _ = part.indices(len(one.samples))
    samples = np.array(Slices(one.samples)[first:last], float)
    for low, high in one.missing:
        samples[max(low - first, 0):max(high - first, 0)] = np.nan
    return samples


def steady_tone(samples):
    """Effective value of the steady tone that samples (n,) hold, silence before and after it left out; None of none."""
    blocks = samples[:len(samples) // _BLOCKS * _BLOCKS].reshape(_BLOCKS, -1) if len(samples) >= 64 * _BLOCKS else None
    if blocks is None or not np.any(samples):
        return None
    levels = blocks.std(axis=1)
    loud = blocks[levels > 0.7 * levels.max()][1:-1]
    if len(loud) < 5:
        return None
    shares = []
    for block in loud:
        power = abs(np.fft.rfft(block * np.hanning(len(block)))) ** 2
        peak = int(power[1:].argmax()) + 1
        shares.append(power[max(peak - 3, 1):peak + 4].sum() / power[1:].sum())
    return float(np.sqrt(np.mean(loud.std(axis=1) ** 2))) if np.median(shares) > 0.8 else None


def stretches(flag):
    """(n, 2) first index of each run of True in ``flag`` (sample,), and the index after its last."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], flag, [False])).astype(int)))
    return edges.reshape(-1, 2)


@dataclass(frozen=True)
class Even:
    """Even sampling: ``rate`` in Hz, ``begin`` in s; ``step`` in s to which instants were rounded, 0 of none that show
    it, and the ``lowest`` and ``highest`` rate that agree with them."""

    rate: float
    begin: float
    step: float = 0.0
    lowest: float = 0.0
    highest: float = 0.0


def even_rate(time, where):
    """(rate in Hz, begin in s) of sampling instants (sample,) in s, see ``even_times``."""
    even = even_times(time, where)
    return even.rate, even.begin


def even_times(time, where, known=None):
    """Even of sampling instants (sample,) in s, which may be rounded; ``known``: a rate in Hz that they may have.

    Raises ConfigError if they are not evenly spaced, or rounded so that they leave their rate open.
    """
    if len(time) < 2 or not all(np.isfinite(block).all() for block in blocks(time)):
        raise ConfigError(where, "at least two finite times", f"{len(time)}")
    interval, first, off = float(time[-1] - time[0]) / (len(time) - 1), 0, 0.0
    for block in blocks(time):
        off = max(off, np.abs(block - (time[0] + interval * np.arange(first, first + len(block)))).max())
        first += len(block)
    rounded = rounded_rate(time, known) if interval > 0 and off > _EXACT * interval else None
    if rounded:
        return Even(rounded.rate, float(time[0]), rounded.step, rounded.lowest, rounded.highest)
    if interval <= 0 or off > EVEN * interval:
        raise ConfigError(where, "times at one even interval", f"a deviation of {off:.3g} s from {interval:.6g} s",
                          "state resample: RATE, the rate of an even grid to interpolate on; where samples were lost or"
                          " times are rounded, sample_rate: RATE")
    return Even(1 / interval, float(time[0]))


def on_grid(columns, time, rate, where):
    """(columns, begin in s) on the full even grid, NaN where a sample is missing; ``columns`` name -> (sample,).

    ``time`` (sample,) s: instants on a grid at ``rate`` Hz, of which some may be missing. Raises ConfigError for an
    instant off the grid by more than OFF_GRID intervals, one that occurs twice, and a sample without a time. Instants
    that were rounded may be off by their rounding.
    """
    if not len(time) or not np.isfinite(time).all() or {len(values) for values in columns.values()} - {len(time)}:
        raise ConfigError(where, "a finite time of every sample", f"{np.isfinite(time).sum()} of"
                          f" {max(map(len, columns.values()), default=0)}", "correct the file, or leave the times out")
    if agrees(time, rate):
        return dict(columns), float(time[0])
    position = (time - time[0]) * rate
    index = np.rint(position).astype(int)
    off = np.abs(position - index).max()
    if off > OFF_GRID:
        index, off = _between_roundings(position, time, rate)
    if off > OFF_GRID or np.any(np.diff(index) < 1):
        raise ConfigError(where, f"rising times on a grid of {rate:g} Hz", f"one that is {off:.2g} intervals off it",
                          "give the sampling rate of the record, or resample it; times that are rounded to more than an"
                          " interval do not show lost samples: where none was lost, leave time out")
    spread = {name: np.full(index[-1] + 1, np.nan) for name in columns}
    for name, values in columns.items():
        spread[name][index] = values
    return spread, float(time[0])


def _between_roundings(position, time, rate):
    """(places on a grid, largest distance from them beyond rounding) of ``position`` (sample,), instants in intervals
    of which the first one too is rounded by less than an interval."""
    bound = next((np.max(b) for b in reversed(roundings(time))), 0.0) * rate
    turned = np.angle(np.mean(np.exp(2j * np.pi * position))) / (2.0 * np.pi)
    index = np.rint(position - turned).astype(int)
    off = 0.5 * np.ptp(position - turned - index)
    return index - index[0], 0.0 if off <= bound * (1 + 1e-6) < 0.5 * (1 - _AT) else max(off, 2.0 * OFF_GRID)


def interpolated(columns, time, rate, where):
    """(columns on an even grid of ``rate`` Hz from the first instant, rate) of samples at uneven, rising ``time`` s.

    Straight lines join samples that lie at most GAP intervals apart; between others samples are missing (NaN). Raises
    ConfigError for times that do not rise.
    """
    if len(time) < 2 or not np.isfinite(time).all() or (np.diff(time) <= 0).any():
        raise ConfigError(where, "finite times that rise from row to row", "others",
                          "where times begin anew in one file, state the rows of each run: rows: [0, 100]")
    grid = time[0] + np.arange(int(np.floor((time[-1] - time[0]) * rate + OFF_GRID)) + 1) / rate
    after = np.clip(np.searchsorted(time, grid), 1, len(time) - 1)
    lost = (time[after] - time[after - 1] > (GAP + EVEN) / rate) & (
        np.minimum(time[after] - grid, grid - time[after - 1]) > EVEN / rate)
    return {name: np.where(lost, np.nan, np.interp(grid, time, values)) for name, values in columns.items()}, rate


def stretch(whole, begin, end, where):
    """The Channel from ``begin`` to ``end`` (exclusive) in s; None: from its start, to its end.

    Raises ConfigError if it has no sample there.
    """
    rate, start, count = float(whole.rate), float(whole.begin), len(whole.samples)
    first = 0 if begin is None else max(0, int(np.ceil((begin - start) * rate - 1e-6)))
    last = count if end is None else min(count, int(np.ceil((end - start) * rate - 1e-6)))
    if first >= last:
        raise ConfigError(where, f"a stretch within {start:g} s to {start + (count - 1) / rate:g} s",
                          f"{_instant(begin)} to {_instant(end)}")
    missing = np.clip(whole.missing, first, last) - first
    return Channel(samples=whole.samples[first:last], missing=missing[missing[:, 0] < missing[:, 1]], rate=rate,
                   begin=start + first / rate,
                   **{name: getattr(whole, name) for name in ("unit", "measures", "place", "position", "direction",
                                                              "role")})


def place_of(name, one):
    """The place of a Channel called ``name``, and its direction along an axis, as universal files have it."""
    direction = np.asarray(one.direction, float)
    axis = int(np.argmax(abs(direction))) if direction.size else -1
    along = f" direction {'-' * bool(direction[axis] < 0)}{axis + 1}" if direction.size and np.isclose(
        abs(direction[axis]), 1.0) else ""
    return (str(one.place) or name) + along


def _instant(instant):
    return "its end" if instant is None else f"{instant:g} s"


def _unit_vector(direction, where):
    vector = np.asarray(direction, float)
    if not vector.size:
        return vector
    length = np.linalg.norm(vector)
    if vector.shape != (3,) or not length > 0:
        raise ConfigError(f"{where}: direction", "three numbers that are not all 0", f"{direction}")
    return vector / length
