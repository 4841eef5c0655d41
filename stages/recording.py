"""Stage recording: test bench recordings, read from any supported file format into one product."""

from dataclasses import replace
from functools import partial
from typing import Literal

import numpy as np

from pipeline.contract import ConfigError, Context, InputFile, OneOf, Quantity, Section, option, stage
from pipeline.contract.fingerprint import digest
from pipeline.contract.units import in_si, makes_other_numbers
from pipeline.diagnosis.experiment_design.overloaded_channels import overload_told
from pipeline.products import Condition, Recording, Run
from pipeline.recordings.apart import runs, waveforms
from pipeline.recordings.friction import measured_friction
from pipeline.recordings.lines import line_list
from pipeline.recordings.runs.imported import Imported
from pipeline.recordings.runs.tracks import channels_of
from pipeline.recordings.samples import channel, stretch
from pipeline.recordings.survey.meanings import split_unit
from pipeline.recordings.tables.layout import Form
from pipeline.recordings.tables.matrices import stated_rates
from pipeline.recordings.tables.sampling import sampled
from pipeline.recordings.tables.text import TextTable, read_table, text_table
from pipeline.recordings.waveform import plain_name
from pipeline.validation.published_facts import load


class Column(Section):
    """One column of a file and its meaning."""

    column: str = option(..., "its name in the file; of a matrix in MATLAB one of its columns: data(:,2)")
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

    begin: Quantity("s") | None = option(None, "first instant, on the clock of the run; none = that of the record")
    end: Quantity("s") | None = option(None, "instant before which it ends; none = end of the record")
    rows: tuple[int, int] | None = option(None, "first row of a file of columns, counted from 0, and the one behind its"
                                                " last, where times begin anew in one file; none = all")
    description: str = option("", "what was done")
    repeat_of: str = option("", "run that it repeats: repeats give the noise")
    conditions: dict[str, Given] = option({}, "conditions by name")


class Common(Section):
    """Two channels that show the same once, such as a knock or a pulse."""

    channel: str = option(..., "one of this file")
    other: str = option(..., "one that the run has by a file further up in the list")


class _Clocked(Section):
    file: InputFile = option(..., "the file; measured:NAME for a public one")
    offset: Quantity("s") | None = option(None, "what is added to its times, so that they are those of a run that files"
                                          " further up have begun; none = by 'common', else by the time stamps of both")
    offset_std: Quantity("s", ge=0) = option("0 s", "standard deviation of the offset")
    common: Common | None = option(None, "channels by which the offset is found; none = it is not")


class _Columns(_Clocked):
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


class Waveforms(_Clocked):
    """A file of channels, each with its rate: sound (WAV, FLAC, ...), TDMS or MDF."""

    kind: Literal["audio", "tdms", "mdf"]
    columns: dict[str, Track] = option({}, "channels by name; none = all of the file, under their own names")
    units: dict[str, str] = option({}, "without columns: unit of a channel where the file says none, or a wrong one")
    sample_rate: Quantity("Hz", gt=0) | None = option(None, "sampling rate where the file tells none; of uneven time"
                                                     " stamps that of the grid that they are put on")
    time: str | None = option(None, "channel with the times, 'GROUP/CHANNEL' of a TDMS file; none = by its name")
    time_unit: str | None = option(None, "unit of such channels; none = as they say, else s")
    runs: dict[str, Stretch] = option({}, "runs by name: stretches of the record; none = one run, named as the file")


class Matlab(_Columns):
    """A MATLAB file of vectors and matrices."""

    kind: Literal["matlab"] = "matlab"


class Table(Form, _Columns):
    """A text table."""

    kind: Literal["table"] = "table"


class Uff(_Clocked):
    """A universal file: one run."""

    kind: Literal["uff"] = "uff"
    run: str = option(..., "name of the run")
    units: dict[str, str] = option({}, "unit of a response where the file says none, or a wrong one")
    time_unit: str | None = option(None, "unit of the times; none = as the file says, else s")
    frequency_unit: str | None = option(None, "unit of the frequencies; none = as the file says, else Hz")
    description: str = option("", "what was done")
    repeat_of: str = option("", "run that it repeats")
    conditions: dict[str, Given] = option({}, "conditions by name")


class Neutral(_Clocked):
    """Plain HDF5 in the form that 'brakechain data format' prints."""

    kind: Literal["hdf5"] = "hdf5"


class FrictionColumn(Section):
    """One column of a table of measured friction."""

    column: str = option(..., "its name in the file")
    unit: str = option("1", "unit of its numbers, such as %, MPa, m/s, km or degC")


class FrictionTable(Form):
    """A text table of measured coefficients of friction: one run."""

    kind: Literal["friction"] = "friction"
    file: InputFile = option(..., "the file; measured:NAME for a public one")
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
    was filtered. Samples at uneven instants lie on even grids, and files of one run on one clock, as the remarks tell.
    """
    imported, source = Imported(settings.keep_going, context.remark), []
    for file in settings.files:
        imported.add(READ[file.kind](file, imported), f"{file.file}")
        source.append(f"{file.file.name} {digest(file.file)}")
    _check_repeats(imported.runs)
    for name, run in imported.runs.items():
        for key, one in run.channels.items():
            if told := overload_told(one):
                imported.tell(f"{name}, {key}: {told}")
    context.log(f"{len(imported.runs)} runs: {', '.join(imported.runs)}")
    return Recording(source=source, remarks=imported.remarks, runs=imported.runs)


def _from_columns(file, table, imported):
    """Runs of a file of columns, a TextTable."""
    where, found, columns = f"{file.file}", {}, table.columns
    table.used({f"{where}: {name}.column": w.column for name, w in file.columns.items()}
               | ({} if file.time is None else {f"{where}: time": file.time}))
    table.on_clock({f"{where}: {name}.column": w.column for name, w in file.columns.items()}, file.time)
    if file.time is None and file.sample_rate is None and table.rate is None:
        raise ConfigError(f"{where}: time", "a sampling rate or a column of times", "neither", "add sample_rate or time"
                          + stated_rates(columns))
    for remark in table.remarks:
        imported.tell(f"{where}: {remark}")
    for name, w in file.columns.items():
        imported.guessed(w.unit, w.measures, f"{where}: {name}")
        written = table.units.get(w.column) or split_unit(w.column)[1]
        if w.factor == 1.0 and written and makes_other_numbers(written, w.unit, w.measures):
            imported.tell(f"{where}: {name}: the file says {written!r}, the case {w.unit!r}, which is taken")
    for rows in dict.fromkeys(run.rows for run in file.runs.values()):
        part = {name: values[slice(*(rows or (None,)))] for name, values in columns.items()}
        values = {name: w.factor * part[w.column] for name, w in file.columns.items()}
        values, rate, begin = sampled(values, part.get(file.time), file,
                                      (table.units.get(file.time, ""), table.rate, table.begin), f"{where}: time",
                                      imported.tell, [w.measures for w in file.columns.values()])
        whole = imported.channels({
            name: partial(channel, values[name], w.unit, w.measures, rate, begin, f"{where}: {name}", role=w.role,
                          place=w.place, direction=w.direction) for name, w in file.columns.items()})
        found |= _cut(file, {name: run for name, run in file.runs.items() if run.rows == rows}, whole, imported)
    return {name: found[name] for name in file.runs}


def _cut(file, runs, whole, imported, stamp=None):
    """The ``runs`` of a case, stretches of the channels ``whole`` of a file on their clock."""
    whole, clocks = imported.on_clock(file, list(runs), whole, stamp)
    return {name: _run(imported.channels({k: partial(stretch, c, run.begin, run.end, f"{file.file}: runs.{name}")
                                          for k, c in whole.items()}), run, f"{file.file}: runs.{name}", clocks=clocks)
            for name, run in runs.items()}


def _from_waveforms(file, imported):
    """Runs of a file whose channels have their own rates, and maybe units."""
    whole, stamp = channels_of(file, imported, Track)
    rows = next((name for name, run in file.runs.items() if run.rows is not None), None)
    if rows is not None:
        raise ConfigError(f"{file.file}: runs.{rows}.rows", "begin and end, in s: the file has no rows", "rows")
    return _cut(file, file.runs or {plain_name(file.file.stem, "run"): Stretch()}, whole, imported, stamp)


def _from_uff(file, imported):
    found = runs("uff", file.file, imported.tell, units=file.units, time_unit=file.time_unit,
                 frequency_unit=file.frequency_unit, keep_going=imported.keep_going)["file"]
    return {file.run: _run(found.channels, file, f"{file.file}", frf=found.frf, modes=found.modes)}


def _on_clock(file, found, imported):
    """Runs {name: Run} of a file that holds whole runs, on the clock of those of the same name."""
    made = {}
    for name, run in found.items():
        channels, clocks = imported.on_clock(file, [name], run.channels)
        shift = sum(float(clock.offset) for clock in clocks.values())
        made[name] = replace(run, channels=channels, clocks=clocks, conditions={
            key: replace(one, time=one.time + shift) if len(one.time) > 1 else one
            for key, one in run.conditions.items()})
    return made


def _from_friction(file):
    """The run of a table of measured friction."""
    where = f"{file.file}"
    columns = read_table(file.file, file, {f"{where}: columns.{name}.column": wanted.column
                                           for name, wanted in file.columns.items()})
    given = {name: (np.full(len(next(iter(columns.values()))), stated.value), stated.unit, f"{where}: values.{name}")
             for name, stated in file.values.items()}
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
READ = {"matlab": lambda file, imported: _from_columns(file, TextTable.of(
            waveforms("matlab", file.file), [w.column for w in file.columns.values()]), imported),
        "table": lambda file, imported: _from_columns(file, text_table(file.file, file), imported),
        "audio": _from_waveforms, "tdms": _from_waveforms, "mdf": _from_waveforms,
        "uff": lambda file, imported: _on_clock(file, _from_uff(file, imported), imported),
        "friction": lambda file, _: _from_friction(file), "lines": lambda file, _: _from_facts(file),
        "hdf5": lambda file, imported: _on_clock(file, runs("hdf5", file.file, imported.tell), imported)}


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
