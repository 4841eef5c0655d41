"""TDMS files of LabVIEW and its relatives. The door of npTDMS."""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from pipeline.contract.errors import BrakechainError, ConfigError
from pipeline.contract.mapped import Growing
from pipeline.contract.units import in_si
from pipeline.recordings.samples import EVEN, even_rate
from pipeline.recordings.survey.meanings import meaning, split_unit
from pipeline.recordings.tables.layout import spelt
from pipeline.recordings.waveform import Waveform, held_as, library, stamped, unit_of

_EPOCH = np.datetime64(0, "us")
#: seconds from 1904, where LabVIEW begins to count, to 1970; a time of so many seconds is counted from one of them
_LABVIEW, _ABSOLUTE = 2_082_844_800, 5e8


def read_tdms(path, folder=None, time=None, time_unit=None):
    """{'group/channel': Waveform} of the channels of a TDMS file, scaled as it says.

    A channel begins at its wf_start_offset, so many seconds later as its wf_start_time lies behind the earliest one of
    the file. Times are those of its waveform properties, else of the channel of times beside it: the one called
    ``time``, or one that is called so and rises; ``time_unit``: unit of such channels, None: as they say, else s.
    ``folder``: for long channels, see ``Growing``. Raises ConfigError for a file that is none, is cut off or damaged,
    or holds no numbers, and for a ``time`` that is no channel of it.
    """
    tdms = library("nptdms", "npTDMS", path)
    try:
        with tdms.TdmsFile.open(str(path)) as file:
            if file.file_status.incomplete_final_segment:
                raise ConfigError(path, "a whole TDMS file", "one whose last segment is cut off", "copy it again")
            names = [_name(channel) for group in file.groups() for channel in group.channels()]
            found = {name: one for group in file.groups()
                     for name, one in _group(group, folder, time, time_unit).items()}
    except BrakechainError:
        raise
    except Exception as error:  # npTDMS passes on whatever its parser stumbles over
        raise ConfigError(path, "an undamaged TDMS file", str(error) or type(error).__name__) from None
    if time is not None and time not in names:
        raise ConfigError(f"{path}: time", f"one of {', '.join(names)}", repr(time))
    if not any(len(one.waveform.values) for one in found.values()):
        raise ConfigError(path, "a channel of numbers", "none")
    return _together(found)


@dataclass(frozen=True)
class _Found:
    """A channel, and the instant (microseconds since 1970) from which its begin and times count; None: not told."""

    waveform: Waveform
    start: int | None = None


def _name(channel):
    return f"{channel.group_name}/{channel.name}"


def _group(group, folder, time, time_unit):
    """{name: _Found} of the channels of a group, without channels of times that others are read by."""
    channels = [channel for channel in group.channels() if len(channel)]
    clocks = {_name(channel): clock for channel in channels
              if (clock := _clock(channel, time, time_unit)) is not None}
    found, used = {}, set()
    for k, channel in enumerate(channels):
        name = _name(channel)
        if channel.dtype.kind not in "fiu":
            found[name] = _Found(Waveform(np.empty(0), remark="it holds no numbers"))
            continue
        beside = [other for other in (*map(_name, reversed(channels[:k])), *map(_name, channels[k:]))
                  if other in clocks and name not in clocks and len(clocks[other][1]) == len(channel)]
        near = time if time in beside else beside[0] if beside else ""
        found[name], by = _read(channel, near, clocks, folder)
        told = _doubt(near, beside, clocks, list(map(_name, channels))) if by and by != time else ""
        if told:
            whole = found[name].waveform
            found[name] = replace(found[name], waveform=replace(whole, remark="; ".join(filter(None, [
                whole.remark, told]))))
        used.add(by)
    return {name: one for name, one in found.items() if name not in used}


def _doubt(near, beside, clocks, order):
    """What to say of times ``near`` a channel where others are ``beside`` it and the ``order`` of the group does not
    tell: times stand before the channels that have them."""
    clear = order[0] in clocks and order[-1] not in clocks and not any(
        one in clocks and other in clocks for one, other in pairwise(order))
    others = [] if clear else [other for other in beside if clocks[other][0] != clocks[near][0]
                               or not np.array_equal(clocks[other][1], clocks[near][1])]
    return f"its times are those of {near}, not of {others[0]}: time: {others[0]} takes these" if others else ""


def _read(channel, near, clocks, folder):
    """(_Found of a channel of numbers, ``near`` where it is read by these times among the ``clocks``, else '')."""
    values = Growing(held_as(channel.dtype), folder)
    for chunk in channel.data_chunks():
        values.append(chunk[:])
    whole = Waveform(values.array(), str(channel.properties.get("unit_string", "")).strip())
    step, offset, remark = _axis(channel.properties)
    start = _microseconds(channel.properties.get("wf_start_time"))
    if near and not _agree(clocks[near][1], step):
        first, times, assumed = clocks[near]
        told = [f"its times are those of {near}, not of its wf_increment, {step:g} s"] if step > 0.0 else []
        told += [f"{near} states no unit: its times are read in s; else time_unit: ms"] if assumed else []
        return _Found(replace(whole, times=times, remark="; ".join(told)), start if first is None else first), near
    return _Found(replace(whole, rate=1.0 / step if step > 0.0 else None, begin=offset, remark=remark), start), ""


def _axis(properties):
    """(interval, time of the first sample, both in s, remark) of waveform properties; 0 s of a channel without them."""
    step, offset = (float(properties.get(name, 0.0)) for name in ("wf_increment", "wf_start_offset"))
    unit = str(properties.get("wf_xunit_string", "")).strip() or "s"
    try:
        factor, found = in_si(1.0, unit, "wf_xunit_string")
    except ConfigError:
        return step, offset, f"its axis x is in {unit!r}, which is taken for s"
    if found != "s":
        return 0.0, 0.0, f"its axis x is in {unit}: it is no signal over time"
    return factor * step, factor * offset, ""


def _clock(channel, time, time_unit):
    """(instant or None, times (sample,) in s from there, whether nothing states their unit) of a channel of times; None
    of any other."""
    named = _name(channel) == time
    if channel.dtype.kind == "M":
        instants = np.asarray(channel[:], "datetime64[us]").astype(np.int64)
        return (int(instants[0]), (instants - instants[0]) / 1e6, False) if (np.diff(instants) >= 0).all() else None
    if channel.dtype.kind not in "fiu" or not (named or (meaning(channel.name).measures == "time"
                                                         and channel.name.strip() != "T")):
        return None
    stated = unit_of(str(channel.properties.get("unit_string", "")).strip()) or split_unit(channel.name)[1]
    unit = time_unit or stated or "s"
    try:
        times, found = in_si(np.asarray(channel[:], float), spelt(unit), _name(channel))
    except ConfigError:
        found = ""
    if found != "s" or not np.isfinite(times).all() or (np.diff(times) < 0).any() or not np.ptp(times):
        if named:
            raise ConfigError(_name(channel), "times that rise, in a unit of time", f"others, in {unit}")
        return None
    if times[0] < _ABSOLUTE:
        return _microseconds(channel.properties.get("wf_start_time")), times, not (time_unit or stated)
    since_1970 = times[0] - (_LABVIEW if times[0] > _LABVIEW else 0)
    return round(1e6 * since_1970), times - times[0], not (time_unit or stated)


def _agree(times, step):
    """Whether times (sample,) are those of a waveform of this interval."""
    return abs((times[-1] - times[0]) / (len(times) - 1) - step) <= EVEN * step


def _microseconds(stated):
    """Whole microseconds since 1970 of a wf_start_time, None of none and of one that was never set."""
    try:
        instant = int((np.datetime64(stated, "us") - _EPOCH) / np.timedelta64(1, "us"))
    except (TypeError, ValueError, OverflowError):
        return None
    return instant if stamped(instant) else None


def _together(found):
    """{name: Waveform} on one clock, whose 0 s is the earliest start of the file."""
    first = min((one.start for one in found.values() if one.start is not None), default=None)
    return {name: _on_clock(one, first) for name, one in found.items()}


def _on_clock(one, first):
    whole, later, told = one.waveform, 0.0, one.waveform.remark
    if first is not None and len(whole.values):
        later = 0.0 if one.start is None else (one.start - first) / 1e6
        start = f"it starts {later:.9g} s after the first channel of the file" if later else ""
        if one.start is None:
            start = "the file states no start time of it: it is taken for that of the first channel"
        told = "; ".join(filter(None, [told, start]))
    whole = replace(whole, begin=whole.begin + later, stamp=None if first is None else stamped(first), remark=told)
    if whole.times is None:
        return whole
    times = whole.times + later
    try:
        rate, begin = even_rate(times, "times")
    except ConfigError:
        return replace(whole, times=times)
    return replace(whole, times=None, rate=rate, begin=begin)
