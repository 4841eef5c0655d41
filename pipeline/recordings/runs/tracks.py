"""Channels of files that themselves say what they hold: sound, TDMS and MDF."""

from collections import Counter, defaultdict
from functools import partial

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.contract.units import in_si, measured_in
from pipeline.recordings.apart import waveforms
from pipeline.recordings.runs.even_times import on_even_times
from pipeline.recordings.samples import channel, steady_tone
from pipeline.recordings.waveform import self_told, unit_of

#: kinds of a calibrator's file by its suffix; any other is sound
_KINDS = {".tdms": "tdms", ".mf4": "mdf", ".mdf": "mdf"}
#: how far a stated rate may be from that of the file
_ALIKE = 1e-6


def channels_of(file, imported, track):
    """({name: Channel}, stamp of a Waveform) of the settings ``file`` of a file of channels with their own rates.

    ``imported``: Imported, which hears what is left out and taken for granted; ``track``: class of the settings of a
    channel. Raises ConfigError for columns that the file does not hold, and where no channel can be used.
    """
    where = f"{file.file}"
    clock = {name: value for name in ("time", "time_unit") if (value := getattr(file, name))}
    if clock and file.kind != "tdms":
        raise ConfigError(f"{where}: {next(iter(clock))}", "no channel of times: files of this kind have their own",
                          repr(next(iter(clock.values()))))
    found = waveforms(file.kind, file.file, **clock)
    for name, wanted in file.columns.items():
        if wanted.column not in found:
            raise ConfigError(f"{where}: {name}.column", f"one of {', '.join(found)}", repr(wanted.column))
    tracks, names = file.columns or _tracks(found, file, where, imported.tell, track), list(found)
    stamp = next((one.stamp for one in found.values() if one.stamp), None)
    uses, told = Counter(one.column for one in tracks.values()), defaultdict(list)

    def made(name, one):
        uses[one.column] -= 1     # long records: a column is let go once all channels of it are made
        waveform = found[one.column] if uses[one.column] else found.pop(one.column)
        even = on_even_times(waveform, file.sample_rate, f"{where}: {name}")
        if not len(even.values):
            raise ConfigError(f"{where}: {name}", "samples", f"none: {even.remark}")
        if even.remark:
            told[even.remark].append(name)
        if file.sample_rate and waveform.rate and abs(waveform.rate / file.sample_rate - 1.0) > _ALIKE:
            told[f"the file states {waveform.rate:.6g} Hz, which is taken: sample_rate is that of channels without a"
                 " rate"].append(name)
        line = f"add columns: {{{name}: {{unit: ...}}}}" if file.columns else f"add units: {{{name}: ...}}"
        return _channel(one, even, f"{where}: {name}", line, imported)

    whole = imported.channels({name: partial(made, name, one) for name, one in tracks.items()})
    for remark, channels in told.items():
        imported.tell(f"{where}: {', '.join(channels)}: {remark}")
    if not whole:
        raise ConfigError(where, "a channel that can be used", f"none of {', '.join(names)}",
                          "name channels under 'columns', with unit and what they measure")
    return whole, stamp


def _tracks(found, file, where, tell, track):
    """{name: settings} of the channels that the file itself says enough of; tells which are left out, and why."""
    for name, one in found.items():
        if not len(one.values):
            tell(f"{where}: {name} left out: {one.remark}")
    usable = {name: one for name, one in found.items() if len(one.values)}
    return {name: track(column=column, unit=unit) for name, (column, unit) in self_told(
        usable, file.units, file.sample_rate, where, tell).items()}


def _channel(track, waveform, where, line, imported):
    """The Channel of a track of a file; ``line``: what to write in the case of its unit."""
    written = waveform.unit if track.unit is None else track.unit
    unit, factor = unit_of(written) or None, track.factor
    if track.calibrator is not None:
        if track.unit is not None or factor != 1.0:
            raise ConfigError(f"{where}: calibrator", "no unit and no factor beside it, which it gives", "one of them")
        unit, factor = "Pa", _pascal(track.calibrator, where)
    if unit is None:
        raise ConfigError(f"{where}: unit", "a unit in the file or in the case", "none", "add unit and measures, of a"
                          " sound file also factor (value of full scale) or calibrator")
    measures = track.measures or ("sound_pressure" if track.calibrator else measured_in(unit, f"{where}: unit", line))
    imported.guessed(unit, measures, where)
    return channel(waveform.values, unit, measures, waveform.rate or np.nan, waveform.begin, where, factor=factor,
                   narrow=True, role=track.role, place=track.place, direction=track.direction, line=line)


def _pascal(calibrator, where):
    """Pa per unit of a channel by a record of its calibrator: the tone of a calibrator rules its level."""
    found = waveforms(_KINDS.get(calibrator.file.suffix.lower(), "audio"), calibrator.file)
    if calibrator.column not in found:
        raise ConfigError(f"{where}: calibrator.column", f"one of {', '.join(found)}", repr(calibrator.column))
    effective = steady_tone(np.asarray(found[calibrator.column].values, float))
    if effective is None:
        raise ConfigError(f"{where}: calibrator", "the steady tone of a calibrator", "none")
    return float(in_si(calibrator.level, "dB re 20 uPa", where)[0]) / effective
