"""A first case of recorded files: what they hold, which runs, which model, with typical values to be replaced."""

from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.contract.units import in_si
from pipeline.recordings.survey.contents import contents
from pipeline.recordings.survey.first_values import channel_noise, first_values
from pipeline.recordings.survey.pieces import pieces
from pipeline.recordings.survey.roles import roles

#: runs below which records are cut; samples of a piece that a first case takes; share of the motion up to which a run
#: begins at rest
_RUNS, _FEWEST, _AT_REST = 3, 20, 0.02
#: mean of a position over its largest excursion beyond which its zero is another one than that of a model
_AWAY = 10.0


@dataclass(frozen=True)
class Rig:
    """What a case is written from: ``files`` [Contents], ``runs`` [{run: {setting: value}}] of each, ``roles``,
    ``values`` (FirstValues), ``held_out`` run or None, ``noise`` {channel: SI value}, ``zeros`` {channel: SI value of a
    position far from 0}, ``start`` and ``remarks``."""

    files: list
    runs: list
    how: list
    roles: object
    values: object
    held_out: str | None
    noise: dict
    zeros: dict
    start: str | None
    remarks: list

    @property
    def balance(self):
        """Whether its form is a balance of forces: of what is sampled finely enough."""
        return self.roles.balance and not self.values.coarse


def rig(paths):
    """Rig of files. Raises ConfigError where no reader reads one, or no channel of the first is in another."""
    files = [contents(path) for path in paths]
    chosen = roles(list(files[0].signals.values()))
    used = [*chosen.responses, *(s for s, _ in chosen.drives), *([chosen.base] if chosen.base else [])]
    for file in files:
        lacking = [s.name for s in used if s.name not in file.signals]
        if lacking:
            raise ConfigError(file.path, f"the channels of {files[0].path.name}", f"none called {', '.join(lacking)}",
                              "one case has runs of the same channels: make another case of this file")
    rates = {round(file.signals[s.name].rate, 6) for file in files for s in used if file.kind != "table"}
    if len(rates) > 1:
        raise ConfigError(files[0].path, "channels of one rate", f"{', '.join(f'{r:g} Hz' for r in sorted(rates))}",
                          "resample them to one rate first")
    runs, how, data = [], [], {}
    few = len(files) < _RUNS and all(len(file.runs) == 1 for file in files)
    for k, file in enumerate(files):
        cut, told = _runs(file, chosen, few and k < max(len(files) - 1, 1), len(files) > 1)
        runs.append({name: setting for name, (setting, _, _) in cut.items()})
        how.append(told)
        for name, (_, run, span) in cut.items():
            if name in data:
                raise ConfigError(file.path, "files of different names", f"run {name} twice")
            data[name] = ({s.name: file.signals[s.name].pieces[run][slice(*span)] for s in used}, used[0].rate)
    data = {name: each for name, each in data.items() if len(each[0][used[0].name]) >= _FEWEST}
    runs = [{name: setting for name, setting in each.items() if name in data} for each in runs]
    if not data:
        raise ConfigError(files[0].path, f"a run of {_FEWEST} samples or more", "none")
    remarks = [f"{file.path.name}: {remark}" for file in files for remark in file.remarks]
    held_out = _held_out(files, chosen, data)
    fitted = {name: each for name, each in data.items() if name != held_out}
    return Rig(files, runs, how, chosen, _values(files, chosen, fitted, used), held_out, _noise(chosen, fitted),
               _zeros(chosen, fitted), _start(chosen, data), remarks)


def si(signal, values):
    """Values in SI of a Signal; those of counts as they are."""
    return np.asarray(in_si(np.nan_to_num(values), signal.meaning.unit, signal.column)[0], float)


def quasi_static(rig_of):
    """Whether the records have no time: loops of stress and strain."""
    return _timeless(rig_of.files, rig_of.roles)


def _timeless(files, chosen):
    return chosen.balance and all("time" not in f.settings and f.kind == "table" for f in files)


def _runs(file, chosen, few, named):
    """({run: (settings, run of the file, (first, after last))}, how) of one file; ``few``: runs are, so it is cut."""
    if not (file.cut and few):
        return {name: (setting, name, (None,)) for name, setting in file.runs.items()}, "one of each file or piece"
    (run, setting), = file.runs.items()
    signal = file.signals[chosen.responses[0].name]
    lead = chosen.drives[0][0].name if chosen.drives else signal.name
    spans, how = pieces(file.signals[lead].pieces[run], not chosen.drives and chosen.base is None)
    if sum(b - a >= _FEWEST for a, b in spans) < 2:
        return {run: (setting, run, (None,))}, "one: the record was not cut"
    first, rows = setting.get("rows", [0])[0], file.kind in ("table", "matlab")
    at = [{"rows": [first + a, first + b]} if rows else
          {key: f"{k / signal.rate:.9g} s" for key, k in (("begin", a), ("end", b))} for a, b in spans]
    return {f"{run if named else 'part'}_{k + 1}": (at[k], run, span) for k, span in enumerate(spans)}, how


def _values(files, chosen, data, used):
    motions = [np.array([si(s, values[s.name]) for s in chosen.responses]) for values, _ in data.values()]
    rate, forces = used[0].rate, None
    if chosen.base is not None:
        motions = [m - si(chosen.base, values[chosen.base.name]) for m, (values, _) in zip(motions, data.values(),
                                                                                         strict=True)]
    elif chosen.drives:
        forces = [np.zeros_like(m) for m in motions]
        for force, (values, _) in zip(forces, data.values(), strict=True):
            for signal, k in chosen.drives:
                force[k] += si(signal, values[signal.name])
    return first_values(motions, forces, rate, chosen.order, _timeless(files, chosen))


def _held_out(files, chosen, data):
    """The run whose motion has the least usual size; None of fewer than two runs."""
    if len(data) < 2:
        return None
    size = {name: float(np.nanstd(values[chosen.responses[0].name])) for name, (values, _) in data.items()}
    middle = np.median(list(size.values()))
    off = {name: abs(np.log(max(s, 1e-300) / max(middle, 1e-300))) for name, s in size.items()}
    last = list(off)[-1]
    if len(files) == 2 and sum(len(f.runs) for f in files) == 2:
        return last
    return max(off, key=off.get) if max(off.values()) > 0.2 else last


def _noise(chosen, data):
    """{channel: SI} the median over the runs."""
    return {s.name: float(np.median([channel_noise(si(s, values[s.name])) for values, _ in data.values()]))
            for s in chosen.responses}


def _zeros(chosen, data):
    """{channel: SI} means of positions that lie far off 0 for what they move by."""
    zeros = {}
    for s in chosen.responses if chosen.order == 0 else ():
        runs = [si(s, values[s.name]) for values, _ in data.values()]
        mean = float(np.median([run.mean() for run in runs]))
        if abs(mean) > _AWAY * max(map(np.ptp, runs)):
            zeros[s.name] = mean
    return zeros


def _start(chosen, data):
    """'fitted' unless every run begins at rest."""
    for values, _ in data.values():
        for s in chosen.responses:
            samples = values[s.name][np.isfinite(values[s.name])]
            head = samples[:max(5, len(samples) // 50)]
            if np.abs(head).max() > _AT_REST * np.abs(samples).max():
                return "fitted"
    return None
