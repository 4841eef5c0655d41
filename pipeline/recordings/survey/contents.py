"""What a file of measurements holds: channels with unit, rate and length, times, and the pieces it falls into."""

import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.contract.units import in_si
from pipeline.recordings.apart import runs, waveforms
from pipeline.recordings.columns import table
from pipeline.recordings.samples import EVEN, GAP, OFF_GRID, with_gaps
from pipeline.recordings.survey.meanings import meaning, split_unit
from pipeline.recordings.waveform import free_name, plain_name

#: kind of a file by its suffix; any other is tried as a text table
KINDS = {".mat": "matlab", ".wav": "audio", ".flac": "audio", ".aif": "audio", ".aiff": "audio", ".tdms": "tdms",
         ".mf4": "mdf", ".mdf": "mdf", ".uff": "uff", ".unv": "uff", ".h5": "hdf5", ".hdf5": "hdf5"}
_SHEETS = (".xls", ".xlsx", ".ods")
#: fewest samples of a piece
_FEWEST = 20
#: share of all rows beyond which one piece stands for all
_MOST = 0.8
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
    found = waveforms(kind, path)
    rated = {name: w for name, w in found.items() if w.rate}
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
    return Contents(path, kind, {}, signals, {run: {}}, True, remarks)


def _of_columns(path, kind):
    columns, units = table(path) if kind == "table" else ({n: w.values for n, w in waveforms("matlab", path).items()},
                                                          {})
    longest = max(map(len, columns.values()))
    columns = {name: np.asarray(values, float) for name, values in columns.items() if len(values) == longest}
    time = next((name for name, values in columns.items() if _is_time(name, values)), None)
    label = next((name for name, values in columns.items() if name != time and _is_label(name, values)), None)
    settings, spans, rate, remarks = _timing(time, columns.get(time), longest, units.get(time))
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


def _timing(name, time, count, unit):
    """(settings, [(first, after last)] of the pieces, rate in Hz, remarks) of a column of times, or of none."""
    if name is None:
        return ({"sample_rate": "1 Hz"}, [(0, count)], 1.0,
                ["no column of times: one sample a second is assumed; state the sampling rate of the record"])
    unit = unit or split_unit(name)[1] or "s"
    time = np.asarray(in_si(time, unit, "unit")[0], float)
    step = np.diff(time)
    usual, settings = float(np.median(step[step > 0])), {"time": name} | ({"time_unit": unit} if unit != "s" else {})
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
        return settings, spans, mean, []
    lost = all(_on_grid(time[a:b], usual) for a, b in spans)
    rate = float(f"{1 / usual:.6g}") if lost else float(f"{mean:.2g}")
    off = max(_off(time[a:b]) for a, b in spans)
    what = "samples are missing" if lost else f"times are uneven, by {off:.2g} intervals"
    return settings | {"resample": f"{rate:g} Hz"}, spans, rate, [f"{what}: interpolated on {rate:g} Hz"]


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
