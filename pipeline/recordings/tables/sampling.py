"""From a column of times, a stated rate, or what a file says, to samples on an even grid."""

import re

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.contract.units import in_si
from pipeline.recordings.samples import EVEN, GAP, OFF_GRID, even_times, interpolated, on_grid
from pipeline.recordings.survey.meanings import split_unit
from pipeline.recordings.tables.layout import spelt

#: units in which times are written, and how near a stated rate must be to tell them
_UNITS, _NEAR = ("s", "ms", "us", "min"), 0.01
#: what is sampled faster than so many Hz, always
_FAST, _SLOW = frozenset({"acceleration", "sound_pressure"}), 50.0
_BRACKETS = re.compile(r".*[\[(]\s*([^\])]*[^\W\d_][^\])]*?)\s*[\])]\s*")


def sampled(values, time, file, head, where, tell, measures=()):
    """(columns on an even grid, rate in Hz, begin in s) of columns ``values`` {name: (row,)}.

    ``time`` (row,): the column of times of the case section ``file``, None of none; ``head`` (unit of the times, rate,
    begin) as the file says, '', None and 0 where it does not; ``measures``: what the columns measure. ``tell`` says
    what was assumed. Raises ConfigError at ``where`` for times and rates that do not fit.
    """
    if time is None:
        rate = file.sample_rate or head[1]
        if file.sample_rate is None and head[1] is not None:
            tell(f"{where}: a sampling rate of {head[1]:.6g} Hz, as the file says; else sample_rate: RATE")
        _contradicted(rate, head[1], "the case", where, tell)
        return values, rate, head[2] if file.sample_rate is None else 0.0
    values, time = _without_end(values, time)
    unit, assumed = time_unit(file.time, file.time_unit, (head[0], file.sample_rate or head[1]), time, f"{where}_unit")
    time = np.asarray(in_si(time, unit, f"{where}_unit")[0]) if unit != "s" else time
    if file.resample is not None or file.sample_rate is not None:
        return _on_stated(values, time, file, unit if assumed else "", where, tell)
    even = even_times(time, where, head[1])
    if assumed:
        _refuse_slow(even.rate, measures, where)
        tell(f"{where}: {file.time} states no unit: read in {unit}, which gives {even.rate:.6g} Hz; else time_unit: ms")
    if even.step:
        spread = 0.5 * (even.highest - even.lowest)
        tell(f"{where}: times are rounded to {even.step:.3g} s: read as an even grid of {even.rate:.8g} Hz, which they"
             f" tell to {spread:.1g} Hz; else sample_rate: RATE")
    _contradicted(even.rate, head[1], f"the times {file.time}", where, tell)
    return values, even.rate, even.begin


def _on_stated(values, time, file, assumed, where, tell):
    """(columns, rate, begin) on a grid of the rate that the case states; ``assumed``: unit of times that nothing
    states."""
    if assumed:
        tell(f"{where}: {file.time} states no unit: read in {assumed}; else time_unit: ms")
    rate, count = file.resample or file.sample_rate, len(time)
    _refuse_other_rate(time, file, where)
    if file.resample is not None:
        spread, _ = interpolated(values, time, rate, where)
        lost, why = max((int(np.isnan(v).sum()) for v in spread.values()), default=0), "or were missing in the file"
        if lost:
            tell(f"{where}: up to {lost} of {len(next(iter(spread.values())))} samples are missing, as times lie more"
                 f" than {GAP} intervals of {rate:.6g} Hz apart, {why}")
        return spread, rate, float(time[0])
    spread, begin = on_grid(values, time, rate, where)
    whole = len(next(iter(spread.values()), time))
    if whole > count:
        tell(f"{where}: {whole - count} of {whole} samples are missing: there are no times of them at {rate:.6g} Hz")
    return spread, rate, begin


def _refuse_other_rate(time, file, where):
    """ConfigError for times of which no two neighbours are one interval of the stated rate apart, or not half of them
    near enough to be joined."""
    rate, usual = file.resample or file.sample_rate, float(np.median(np.diff(time))) if len(time) > 1 else 0.0
    nearest = usual * rate if file.resample is not None else np.min(np.diff(time), initial=np.inf) * rate
    if usual > 0 and nearest > (GAP + EVEN if file.resample is not None else 2.0 - OFF_GRID):
        name = "sample_rate" if file.resample is None else "resample"
        raise ConfigError(f"{where[:where.rfind(': ') + 2]}{name}", f"times at {rate:.6g} Hz", f"times that are"
                          f" {nearest:.6g} intervals or more apart",
                          f"state {name}: {1.0 / usual:.6g} Hz, or the unit of the times, time_unit: ms")


def _contradicted(rate, stated, by, where, tell):
    """Tells where the head of a file states another rate than what is taken."""
    if stated is not None and abs(rate / stated - 1.0) > _NEAR:
        tell(f"{where}: the head of the file states {stated:.6g} Hz, {by} {rate:.6g} Hz, which is taken")


def time_unit(name, stated, head, time, where):
    """(unit of times, whether nothing states it) of a column ``name``: as the case states it, a row of units, the name,
    or the rate of the head tells; else s. ConfigError for a unit of the file that is none of time."""
    if stated:
        return spelt(stated), False
    written = head[0] or split_unit(name)[1]
    bracketed = _BRACKETS.fullmatch(name)
    if not written and bracketed:
        written = bracketed[1]
    if written:
        unit = spelt(written)
        try:
            if in_si(1.0, unit, where)[1] == "s":
                return unit, False
        except ConfigError:
            pass
        raise ConfigError(where, "times in a unit such as s or ms", f"{written!r} at {name}", "state it: time_unit: s")
    usual = np.median(np.diff(time)) if head[1] else 0.0
    by_rate = [unit for unit in _UNITS if usual > 0 and abs(usual * in_si(1.0, unit, where)[0] * head[1] - 1) < _NEAR]
    return (by_rate or ["s"])[0], not by_rate


def _without_end(values, time):
    """Columns and times up to the last row that has one or the other: longer columns may stand beside them."""
    if any(len(v) != len(time) for v in values.values()):
        return values, time
    rows = np.any([np.isfinite(v) for v in (time, *values.values())], axis=0)
    if not rows.any():
        return values, time
    end = int(np.flatnonzero(rows)[-1]) + 1
    return {name: v[:end] for name, v in values.items()}, time[:end]


def _refuse_slow(rate, measures, where):
    """ConfigError where times without a unit make vibrations or sound slower than anyone records them."""
    fast = next((one for one in measures if one in _FAST), None)
    if fast and rate < _SLOW:
        raise ConfigError(f"{where}_unit", "the unit of times, which the file does not state",
                          f"{rate:.6g} Hz in s, {1e3 * rate:.6g} Hz in ms, {1e6 * rate:.6g} Hz in us, for {fast}",
                          "state it: time_unit: ms, us or s")
