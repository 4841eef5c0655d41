"""What a file of measurements holds: channels with unit, rate and length, times, and the pieces it falls into."""

import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.contract.units import in_si
from pipeline.recordings.apart import runs, waveforms
from pipeline.recordings.runs.even_times import on_even_times
from pipeline.recordings.samples import EVEN, GAP, OFF_GRID, even_times, with_gaps
from pipeline.recordings.survey.meanings import meaning, split_unit
from pipeline.recordings.tables.sampling import time_unit
from pipeline.recordings.tables.text import TextTable, text_table
from pipeline.recordings.waveform import free_name, plain_name

#: kind of a file by its suffix; any other is tried as a text table
KINDS = {".mat": "matlab", ".wav": "audio", ".flac": "audio", ".aif": "audio", ".aiff": "audio", ".tdms": "tdms",
         ".mf4": "mdf", ".mdf": "mdf", ".uff": "uff", ".unv": "uff", ".h5": "hdf5", ".hdf5": "hdf5"}
_SHEETS = (".xls", ".xlsx", ".ods")
#: fewest samples of a piece
_FEWEST = 20
#: share of all rows beyond which one piece stands for all
_MOST = 0.8
#: names of columns that have none of their own
_NO_NAME = re.compile(r"column 1|.*\(:,1\)|.*\(1,:\)")
#: piece of a column of numbers that names it: runs have so many values at most
_LABELS = 40


@dataclass(frozen=True)
class Signal:
    """A channel: its ``name`` in a case, ``column`` in the file, Meaning, ``rate`` in Hz and ``pieces`` {run: (n,)}."""

    name: str
    column: str
    meaning: object
    rate: float
    pieces: dict

    @property
    def dead(self):
        """Whether it never changes."""
        return all(not np.ptp(values[np.isfinite(values)]) if np.isfinite(values).any() else True
                   for values in self.pieces.values())


@dataclass(frozen=True)
class Contents:
    """A file of ``kind``; ``settings`` {setting: value} that read its times; ``signals`` {name: Signal}.

    ``runs`` {run: {setting: value}}: the stretches that its own times make, one where they are one; ``cut``: whether
    the case may cut it further; ``remarks``: what a user should know.
    """

    path: Path
    kind: str
    settings: dict
    signals: dict
    runs: dict
    cut: bool
    remarks: list = field(default_factory=list)


def contents(path):
    """Contents of a file. Raises ConfigError for a file that no reader reads."""
    path = Path(path)
    if not path.is_file():
        raise ConfigError(path, "a file", "none")
    suffix = path.suffix.lower()
    if suffix in _SHEETS:
        raise ConfigError(path, "a text table, MATLAB, UFF, WAV, TDMS, MDF4 or HDF5", "a workbook of sheets",
                          "save each sheet as CSV, one row of names and then numbers")
    kind = KINDS.get(suffix, "table")
    return _of_runs(path, kind) if kind in ("uff", "hdf5") else _of_columns(path, kind) if kind in (
        "table", "matlab") else _of_waveforms(path, kind)


def _of_runs(path, kind):
    remarks = []
    found = runs(kind, path, tell=remarks.append)
    names = {name: run for name, run in found.items() if run.channels}
    if not names:
        raise ConfigError(path, "channels of samples over time", "none", "for frequency responses: chain modal_test")
    first = _run_name(path) if kind == "uff" else None
    turning = any(str(c.measures) == "torque" for run in names.values() for c in run.channels.values())
    signals = {}
    for channel in dict.fromkeys(c for run in names.values() for c in run.channels):
        whole = {first or n: run.channels[channel] for n, run in names.items() if channel in run.channels}
        one = next(iter(whole.values()))
        signals[channel] = Signal(channel, channel, meaning(channel, str(one.unit), str(one.measures), turning),
                                  float(one.rate), {n: with_gaps(c) for n, c in whole.items()})
    settings = {"run": first} if kind == "uff" else {}
    return Contents(path, kind, settings, signals, dict.fromkeys([first] if first else names, {}), False,
                    remarks)


def _of_waveforms(path, kind):
    found = {name: w for name, w in waveforms(kind, path).items() if len(w.values)}
    rated = {name: on_even_times(w, None, f"{path}: {name}") for name, w in found.items()
             if w.rate or (w.times is not None and len(w.times) > 1)}
    if not rated:
        raise ConfigError(path, "channels with a sampling rate", "none that the file states")
    run, signals = _run_name(path), {}
    turning = any(meaning(n, w.unit).measures == "torque" for n, w in rated.items())
    for name, w in rated.items():
        key = free_name(plain_name(name), signals)
        signals[key] = Signal(key, name, meaning(name, w.unit, turning=turning), float(w.rate),
                              {run: np.asarray(w.values, float)})
    rates = {s.rate for s in signals.values()}
    remarks = [f"channels of several rates: {', '.join(f'{r:g} Hz' for r in sorted(rates))}"] if len(rates) > 1 else []
    remarks += [f"{name}: {w.remark}" for name, w in rated.items() if w.remark]
    return Contents(path, kind, {}, signals, {run: {}}, True, remarks)


def _of_columns(path, kind):
    table = text_table(path) if kind == "table" else TextTable.of(waveforms("matlab", path))
    units, longest = table.units, max(map(len, table.columns.values()))
    columns = {name: np.asarray(values, float) for name, values in table.columns.items() if len(values) == longest}
    time = next((name for name, values in columns.items() if _is_time(name, values)), None) or _unnamed_time(columns)
    label = next((name for name, values in columns.items() if name != time and _is_label(name, values)), None)
    settings, spans, rate, remarks = _timing(time, columns.get(time), longest, (units.get(time, ""), table.rate))
    remarks = [*table.remarks, *(f"{name} is left out: it holds texts" for name in table.flaws), *remarks]
    main = max(spans, key=lambda span: span[1] - span[0])
    spans = [main] if main[1] - main[0] > _MOST * longest else spans
    stem, signals = _run_name(path), {}
    names = [stem] if len(spans) == 1 else [f"{stem}_{k + 1}" for k in range(len(spans))]
    turning = any(meaning(n).measures == "torque" for n in columns)
    for name, values in columns.items():
        if name in (time, label):
            continue
        key = free_name(plain_name(split_unit(name)[0]), signals)
        signals[key] = Signal(key, name, meaning(name, units.get(name, ""), turning=turning),
                              rate, {run: values[a:b] for run, (a, b) in zip(names, spans, strict=True)})
    stated = {run: {} if (a, b) == (0, longest) else {"rows": [a, b]} for run, (a, b) in zip(names, spans, strict=True)}
    return Contents(path, kind, settings, signals, stated, len(spans) == 1, remarks)


def _unnamed_time(columns):
    """The first column where its name tells nothing and it rises evenly, as times do; None of any other."""
    name, values = next(iter(columns.items()))
    if len(columns) < 2 or not _NO_NAME.fullmatch(name) or not np.isfinite(values).all() or len(values) < _FEWEST:
        return None
    step = np.diff(values)
    return name if (step >= 0).all() and step.max() > 0 and _off(values) <= 1.0 else None


def _is_time(name, values):
    """Whether a column is one of times: called so, and rising but for where it begins anew."""
    rising = np.isfinite(values).all() and np.ptp(values) > 0 and np.mean(np.diff(values) >= 0) > 0.9
    return rising and meaning(name).measures == "time"


def _is_label(name, values):
    """Whether a column numbers the runs: few whole numbers that hold over long stretches and only rise."""
    whole = np.isfinite(values).all() and (values == np.rint(values)).all()
    steps = np.diff(values)
    return bool(whole and (steps >= 0).all() and 0 < np.sum(steps > 0) < min(_LABELS, len(values) / _FEWEST)
                and re.search(r"#|drop|run|test|trial|segment|no\b|number|id\b", name, re.IGNORECASE))


def _timing(name, time, count, head):
    """(settings, [(first, after last)] of the pieces, rate in Hz, remarks) of a column of times, or of none; ``head``
    (unit, rate) as the file says."""
    if name is None:
        if head[1]:
            return {"sample_rate": f"{head[1]:.8g} Hz"}, [(0, count)], head[1], ["sampling rate as the file says"]
        return ({"sample_rate": "1 Hz"}, [(0, count)], 1.0,
                ["no column of times: one sample a second is assumed; state the sampling rate of the record"])
    unit, assumed = time_unit(name, None, head, time, "time_unit")
    time = np.asarray(in_si(time, unit, "unit")[0], float)
    step = np.diff(time)
    usual = float(np.median(step[step > 0]))
    settings = {"time": name} | ({"time_unit": unit} if unit != "s" else {})
    remarks = [f"{name} states no unit: read in s; else time_unit: ms"] if assumed else []
    if (step >= 0).all():
        try:
            even = even_times(time, name, head[1])
        except ConfigError:
            even = None
        if even and even.step:
            return (settings | {"sample_rate": f"{even.rate:.8g} Hz"}, [(0, count)], even.rate,
                    [f"times are rounded to {even.step:.3g} s: an even grid of {even.rate:.8g} Hz is read", *remarks])
    if (step >= 0).all() and (step == 0).any() and _off(time) * np.mean(step) <= step[step > 0].min():
        rate = float(f"{1 / np.mean(step):.4g}")
        return ({"sample_rate": f"{rate:g} Hz"}, [(0, count)], rate,
                [f"times are rounded: an even grid of {rate:g} Hz is read; state the sampling rate that was set"])
    edges = [0, *(np.flatnonzero((step <= 0) | (step > GAP * usual)) + 1), count]
    spans = [(int(a), int(b)) for a, b in zip(edges[:-1], edges[1:], strict=True) if b - a >= _FEWEST]
    if not spans:
        raise ConfigError(name, f"times of {_FEWEST} samples that rise evenly", f"{count} rows in pieces")
    mean = sum(b - a - 1 for a, b in spans) / sum(time[b - 1] - time[a] for a, b in spans)
    if all(_off(time[a:b]) <= EVEN for a, b in spans):
        return settings, spans, mean, remarks
    lost = all(_on_grid(time[a:b], usual) for a, b in spans)
    rate = float(f"{1 / usual:.6g}") if lost else float(f"{mean:.2g}")
    off = max(_off(time[a:b]) for a, b in spans)
    what = "samples are missing" if lost else f"times are uneven, by {off:.2g} intervals"
    return settings | {"resample": f"{rate:g} Hz"}, spans, rate, [f"{what}: interpolated on {rate:g} Hz", *remarks]


def _on_grid(time, interval):
    """Whether instants lie on an even grid, of which some may be missing."""
    position = (time - time[0]) / interval
    steps = np.diff(np.rint(position))
    return bool((steps >= 1).all() and abs(position - np.rint(position)).max() < OFF_GRID)


def _off(time):
    """Largest distance of instants from an even grid, in intervals."""
    interval = (time[-1] - time[0]) / (len(time) - 1)
    return float(np.abs(time - time[0] - interval * np.arange(len(time))).max() / interval)


def _run_name(path):
    """A run called as its file; no number, which YAML would read as one."""
    name = plain_name(path.stem, "run")
    return f"run_{name}" if name[0].isdigit() else name
