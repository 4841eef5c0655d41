"""Stage recording: test bench recordings, read from any supported file format into one product."""

from collections import Counter
from dataclasses import dataclass
from functools import partial
from typing import Literal

import numpy as np

from pipeline.contract import ConfigError, Context, InputFile, OneOf, Quantity, Section, option, stage
from pipeline.contract.fingerprint import digest
from pipeline.contract.units import in_si, measured_in, read_as
from pipeline.physics.signals.spectra import HEARING
from pipeline.products import Condition, Recording, Run
from pipeline.recordings.apart import runs, waveforms
from pipeline.recordings.columns import read_table, table
from pipeline.recordings.friction import measured_friction
from pipeline.recordings.lines import line_list
from pipeline.recordings.samples import channel, even_rate, interpolated, on_grid, steady_tone, stretch
from pipeline.recordings.survey.meanings import split_unit
from pipeline.recordings.waveform import SPELT, plain_name, self_told
from pipeline.validation.published_facts import load

#: kinds of a calibrator's file by its suffix; any other is sound
_KINDS = {".tdms": "tdms", ".mf4": "mdf", ".mdf": "mdf"}


class Column(Section):
    """One column of a file and its meaning."""

    column: str = option(..., "its name in the file")
    unit: str = option(..., "unit of its numbers, such as mm, kN, deg or, of an acceleration, g")
    measures: str = option(..., "displacement, velocity, acceleration, angle, force, torque, pressure, voltage, ...")
    factor: float = option(1.0, "factor on its numbers: the gain of a sensor, or -1 to turn a sign")
    role: Literal["response", "excitation"] = option("response", "what the bench imposed, or what it answered")
    place: str = option("", "named point or joint of the model")
    direction: tuple[float, ...] = option((), "direction of a vector")


class Given(Section):
    """An operating condition of a run."""

    value: float = option(..., "its value")
    unit: str = option(..., "its unit")


class Stretch(Section):
    """A run: a segment of the record."""

    begin: Quantity("s") | None = option(None, "first instant; none = that of the record")
    end: Quantity("s") | None = option(None, "instant before which it ends; none = end of the record")
    rows: tuple[int, int] | None = option(None, "first row of a file of columns, counted from 0, and the one behind its"
                                                " last, where times begin anew in one file; none = all")
    description: str = option("", "what was done")
    repeat_of: str = option("", "run that it repeats: repeats give the noise")
    conditions: dict[str, Given] = option({}, "conditions by name")


class _Columns(Section):
    file: InputFile = option(..., "the file; measured:NAME for a public one")
    columns: dict[str, Column] = option(..., "channels by name", min_length=1)
    sample_rate: Quantity("Hz", gt=0) | None = option(None, "sampling rate; none = from the column of times")
    time: str | None = option(None, "column with the times; with a sampling rate it tells lost samples")
    time_unit: str | None = option(None, "unit of the times; none = as the column or a row of units says, else s")
    resample: Quantity("Hz", gt=0) | None = option(
        None, "rate of an even grid on which samples of uneven times are interpolated; none = times are even")
    runs: dict[str, Stretch] = option(..., "runs by name: declared stretches of the record", min_length=1)


class Calibrator(Section):
    """A record of a sound calibrator by the same microphone at the same gain."""

    file: InputFile = option(..., "the file")
    column: str = option("1", "channel in it")
    level: float = option(94.0, "sound pressure level of the calibrator, dB re 20 uPa", gt=20, lt=180)


class Track(Column):
    """One channel of a file that may itself say what it holds."""

    unit: str | None = option(None, "unit of its numbers, times the factor; none = as the file says")
    measures: str | None = option(None, "what it measures: acceleration, sound_pressure, pressure, ...; none = by its"
                                  " unit")
    calibrator: Calibrator | None = option(None, "of a microphone: gives the factor, to Pa")


class Waveforms(Section):
    """A file of channels, each with its rate: sound (WAV, FLAC, ...), TDMS or MDF."""

    kind: Literal["audio", "tdms", "mdf"]
    file: InputFile = option(..., "the file; measured:NAME for a public one")
    columns: dict[str, Track] = option({}, "channels by name; none = all of the file, under their own names")
    units: dict[str, str] = option({}, "without columns: unit of a channel where the file says none, or a wrong one")
    sample_rate: Quantity("Hz", gt=0) | None = option(None, "sampling rate where the file tells none")
    runs: dict[str, Stretch] = option({}, "runs by name: stretches of the record; none = one run, named as the file")


class Matlab(_Columns):
    """A MATLAB file of vectors."""

    kind: Literal["matlab"] = "matlab"


class Table(_Columns):
    """A text table."""

    kind: Literal["table"] = "table"
    delimiter: str | None = option(None, "what separates columns; none = tab, semicolon or comma, as the head shows")
    skip: int = option(0, "lines before the head", ge=0)


class Uff(Section):
    """A universal file: one run."""

    kind: Literal["uff"] = "uff"
    file: InputFile = option(..., "the file; measured:NAME for a public one")
    run: str = option(..., "name of the run")
    units: dict[str, str] = option({}, "unit of a response where the file says none, or a wrong one")
    time_unit: str | None = option(None, "unit of the times; none = as the file says, else s")
    frequency_unit: str | None = option(None, "unit of the frequencies; none = as the file says, else Hz")
    description: str = option("", "what was done")
    repeat_of: str = option("", "run that it repeats")
    conditions: dict[str, Given] = option({}, "conditions by name")


class Neutral(Section):
    """Plain HDF5 in the form that 'brakechain data format' prints."""

    kind: Literal["hdf5"] = "hdf5"
    file: InputFile = option(..., "the file; measured:NAME for a public one")


class FrictionColumn(Section):
    """One column of a table of measured friction."""

    column: str = option(..., "its name in the file")
    unit: str = option("1", "unit of its numbers, such as %, MPa, m/s, km or degC")


class FrictionTable(Section):
    """A text table of measured coefficients of friction: one run."""

    kind: Literal["friction"] = "friction"
    file: InputFile = option(..., "the file; measured:NAME for a public one")
    delimiter: str | None = option(None, "what separates columns; none = tab, semicolon or comma, as the head shows")
    skip: int = option(0, "lines before the head", ge=0)
    run: str = option(..., "name of the run")
    description: str = option("", "what was done")
    columns: dict[str, FrictionColumn] = option(
        ..., "friction, and of friction_std, pressure, speed, distance and temperature what differs from row to row",
        min_length=1)
    values: dict[str, Given] = option({}, "the same where one value holds for all rows")


class LineList(Section):
    """Lines of one spectrum, or modes of one table."""

    facts: tuple[str, ...] = option(..., "keys of published facts, or patterns such as mode_*_test", min_length=1)
    multiples: int = option(1, "each fact is the base of so many lines: itself, twice its frequency, ...", ge=1)
    place: str = option("", "where the spectrum was taken")


class LineRun(Section):
    """A run of which only lines were published."""

    description: str = option("", "what was done")
    conditions: dict[str, Given] = option({}, "conditions by name")
    lists: dict[str, LineList] = option(..., "lists of lines by name", min_length=1)


class PublishedLines(Section):
    """Published frequencies, if no raw signal exists."""

    kind: Literal["lines"] = "lines"
    file: InputFile = option(..., "published facts, e.g. data/reference/pin_on_disc.yaml")
    runs: dict[str, LineRun] = option(..., "runs by name", min_length=1)


class Settings(Section):
    """Files of the bench, each with the meaning of its columns."""

    files: tuple[OneOf(Matlab, Table, Waveforms, Uff, Neutral, FrictionTable, PublishedLines), ...] = option(
        (), "files in any order; at least one")
    keep_going: bool = option(False, "leave out channels that cannot be used, and say so, instead of ending there")


def _check(sections):
    """Refuse a case without files."""
    if not sections["recording"].files:
        raise ConfigError("recording.files", "at least one file", "none", "see configs/emps_recording.yaml")


@stage(check=_check)
def recording(settings: Settings, context: Context) -> Recording:
    """Import recordings of a test bench.

    Method:
    Recordings were converted to SI units and cut into runs as stated in the case. Missing samples are marked; nothing
    was filtered, and only what the case says was resampled.
    """
    collected, source = {}, []
    for number, file in enumerate(settings.files):
        new_runs = READ[file.kind](file, _Refused(settings.keep_going, context.log))
        twice = set(new_runs) & set(collected)
        if twice:
            raise ConfigError(f"recording.files.{number}", "run names that are not taken", ", ".join(sorted(twice)))
        collected |= new_runs
        source.append(f"{file.file.name} {digest(file.file)}")
    _check_repeats(collected)
    context.log(f"{len(collected)} runs: {', '.join(collected)}")
    return Recording(source=source, runs=collected)


@dataclass(frozen=True)
class _Refused:
    """What becomes of a channel that cannot be used: the error ends the import, or is told and the channel left out."""

    keep_going: bool
    tell: object

    def guessed(self, unit, measures, where):
        """Tells what a unit is taken for where that is a guess."""
        guess = read_as(unit, measures)
        if guess:
            self.tell(f"{where}: unit {unit!r} is read as {guess}")

    def channels(self, makers):
        """{name: Channel} of ``makers`` {name: () -> Channel}."""
        made = {}
        for name, make in makers.items():
            try:
                made[name] = make()
            except ConfigError as error:
                if not self.keep_going:
                    raise
                self.tell(f"left out: {error}")
        return made


def _from_columns(file, columns, units, refused):
    """Runs of a file of columns, {name: values} and what it says of their {name: unit}."""
    where, found = f"{file.file}", {}
    _refuse_unknown(file, columns, f"{where}: ")
    for name, w in file.columns.items():
        refused.guessed(w.unit, w.measures, f"{where}: {name}")
    for rows in dict.fromkeys(run.rows for run in file.runs.values()):
        part = {name: values[slice(*(rows or (None,)))] for name, values in columns.items()}
        values = {name: w.factor * part[w.column] for name, w in file.columns.items()}
        values, rate, begin = _sampled(file, values, part, units, f"{where}: time")
        whole = refused.channels({
            name: partial(channel, values[name], w.unit, w.measures, rate, begin, f"{where}: {name}", role=w.role,
                          place=w.place, direction=w.direction) for name, w in file.columns.items()})
        found |= _cut({name: run for name, run in file.runs.items() if run.rows == rows}, whole, where, refused)
    return {name: found[name] for name in file.runs}


def _cut(runs, whole, where, refused):
    """The ``runs`` of a case, stretches of the channels ``whole``."""
    return {name: _run(refused.channels({k: partial(stretch, c, run.begin, run.end, f"{where}: runs.{name}")
                                         for k, c in whole.items()}), run, f"{where}: runs.{name}")
            for name, run in runs.items()}


def _from_waveforms(file, refused):
    """Runs of a file whose channels have their own rates, and maybe units."""
    where, found = f"{file.file}", waveforms(file.kind, file.file)
    _refuse_unknown(file, found, f"{where}: ")
    tracks, names = file.columns or {name: Track(column=column, unit=unit) for name, (column, unit) in self_told(
        found, file.units, file.sample_rate, where, refused.tell).items()}, list(found)
    uses = Counter(track.column for track in tracks.values())

    def made(name, track):
        uses[track.column] -= 1     # long records: a column is let go once all channels of it are made
        waveform = found[track.column] if uses[track.column] else found.pop(track.column)
        line = f"add columns: {{{name}: {{unit: ...}}}}" if file.columns else f"add units: {{{name}: ...}}"
        return _track(track, waveform, file.sample_rate, f"{where}: {name}", line, refused)

    whole = refused.channels({name: partial(made, name, track) for name, track in tracks.items()})
    if not whole:
        raise ConfigError(where, "a channel that can be used", f"none of {', '.join(names)}",
                          "name channels under 'columns', with unit and what they measure")
    rows = next((name for name, run in file.runs.items() if run.rows is not None), None)
    if rows is not None:
        raise ConfigError(f"{where}: runs.{rows}.rows", "begin and end, in s: the file has no rows", "rows")
    return _cut(file.runs or {plain_name(file.file.stem, "run"): Stretch()}, whole, where, refused)


def _track(track, waveform, rate, where, line, refused):
    """The Channel of a Track of a file; ``line``: what to write in the case of its unit."""
    unit, factor = SPELT.get(waveform.unit, waveform.unit) or None if track.unit is None else track.unit, track.factor
    if track.calibrator is not None:
        if track.unit is not None or factor != 1.0:
            raise ConfigError(f"{where}: calibrator", "no unit and no factor beside it, which it gives", "one of them")
        unit, factor = "Pa", _pascal(track.calibrator, where)
    if unit is None:
        raise ConfigError(f"{where}: unit", "a unit in the file or in the case", "none", "add unit and measures, of a"
                          " sound file also factor (value of full scale) or calibrator")
    measures = track.measures or ("sound_pressure" if track.calibrator else measured_in(unit, f"{where}: unit", line))
    refused.guessed(unit, measures, where)
    return channel(waveform.values, unit, measures, waveform.rate or rate or np.nan, waveform.begin, where,
                   factor=factor, narrow=True, role=track.role, place=track.place, direction=track.direction, line=line)


def _pascal(calibrator, where):
    """Pa per unit of a channel by a record of its calibrator: the tone of a calibrator rules its level."""
    found = waveforms(_KINDS.get(calibrator.file.suffix.lower(), "audio"), calibrator.file)
    if calibrator.column not in found:
        raise ConfigError(f"{where}: calibrator.column", f"one of {', '.join(found)}", repr(calibrator.column))
    effective = steady_tone(np.asarray(found[calibrator.column].values, float))
    if effective is None:
        raise ConfigError(f"{where}: calibrator", "the steady tone of a calibrator", "none")
    return HEARING * 10.0 ** (calibrator.level / 20.0) / effective


def _refuse_unknown(file, columns, where):
    """Refuse columns of the case that a file of these ``columns`` does not hold."""
    for name, wanted in file.columns.items():
        if wanted.column not in columns:
            raise ConfigError(f"{where}{name}.column", f"one of {', '.join(columns)}", repr(wanted.column))


def _sampled(file, values, columns, units, where):
    """(columns on an even grid, rate, begin) from the sampling rate, the column of times, or both."""
    if file.time is not None and file.time not in columns:
        raise ConfigError(where, f"one of {', '.join(columns)}", repr(file.time))
    if file.time is None and file.sample_rate is None:
        raise ConfigError(where, "a sampling rate or a column of times", "neither", "add sample_rate or time")
    if file.time is None:
        return values, file.sample_rate, 0.0
    unit = file.time_unit or units.get(file.time) or split_unit(file.time)[1] or "s"
    time = np.asarray(in_si(columns[file.time], unit, f"{where}_unit")[0])
    if file.resample is not None:
        return *interpolated(values, time, file.resample, where), float(time[0])
    if file.sample_rate is None:
        return values, *even_rate(time, where)
    spread, begin = on_grid(values, time, file.sample_rate, where)
    return spread, file.sample_rate, begin


def _from_uff(file, refused):
    found = runs("uff", file.file, refused.tell, units=file.units, time_unit=file.time_unit,
                 frequency_unit=file.frequency_unit, keep_going=refused.keep_going)["file"]
    return {file.run: _run(found.channels, file, f"{file.file}", frf=found.frf, modes=found.modes)}


def _from_friction(file):
    """The run of a table of measured friction."""
    where, columns = f"{file.file}", read_table(file.file, file.delimiter, file.skip)
    given = {name: (np.full(len(next(iter(columns.values()))), stated.value), stated.unit, f"{where}: values.{name}")
             for name, stated in file.values.items()}
    _refuse_unknown(file, columns, f"{where}: columns.")
    given |= {name: (columns[wanted.column], wanted.unit, f"{where}: columns.{name}")
              for name, wanted in file.columns.items()}
    return {file.run: Run(description=file.description, repeat_of="",
                          friction={"table": measured_friction(given, where)})}


def _from_facts(file):
    facts = load(file.file)
    return {name: _run({}, run, f"{file.file}: runs.{name}", lines={
        key: line_list(facts, values.facts, values.multiples, values.place, f"{file.file}: runs.{name}.lists.{key}")
        for key, values in run.lists.items()}) for name, run in file.runs.items()}


#: kind of file -> its runs by name
READ = {"matlab": lambda file, refused: _from_columns(file, {
            name: waveform.values for name, waveform in waveforms("matlab", file.file).items()}, {}, refused),
        "table": lambda file, refused: _from_columns(file, *table(file.file, file.delimiter, file.skip), refused),
        "audio": _from_waveforms, "tdms": _from_waveforms, "mdf": _from_waveforms,
        "uff": _from_uff, "friction": lambda file, _: _from_friction(file),
        "lines": lambda file, _: _from_facts(file), "hdf5": lambda file, _: runs("hdf5", file.file)}


def _run(channels, stated, where, **more):
    conditions = {}
    for name, given in stated.conditions.items():
        value, unit = in_si(given.value, given.unit, f"{where}: conditions.{name}.unit")
        conditions[name] = Condition(value=[value], time=[0.0], unit=unit)
    return Run(description=stated.description, repeat_of=getattr(stated, "repeat_of", ""), conditions=conditions,
               channels=channels, **more)


def _check_repeats(runs):
    for name, run in runs.items():
        first = str(run.repeat_of)
        if first and (first == name or first not in runs):
            raise ConfigError(f"recording: {name}.repeat_of", f"another of {', '.join(runs)}", repr(first))
