"""Facts planted in a file, and how what a program reads of it is judged by them."""

import re
from dataclasses import dataclass, field, replace

import numpy as np

from pipeline.contract.settings import fill
from stages import recording
from tests.fuzz.semantics.labels import ASKED_BACK, drawn
from tests.fuzz.targets import plain
from tests.fuzz.trial import Told, difference

#: what a remark says of a channel that is not there
_LEFT_OUT = re.compile(r"left out|holds no numbers|not read")
_FACTORS = (1.0, 1.0, -1.0, 2.5, -0.04, 1e3)


@dataclass(frozen=True)
class Planted:
    """What a channel truly is: ``samples`` (sample,) in ``si``, NaN where missing, at ``rate`` Hz from ``begin`` s.

    ``exact`` and ``exact_rate``: relative deviations that the numbers of the file leave open, ``instant`` the same of
    its begin in s. ``asked``: it must be asked back or left out aloud. ``assumed``: (which of samples, unit, rate and
    begin may be otherwise, pattern of the remark that tells so). ``times`` (sample,): uneven instants of samples on a
    straight line, which are right at every instant that is read.
    """

    samples: np.ndarray
    si: str
    rate: float
    begin: float = 0.0
    exact: float = 1e-6
    exact_rate: float = 1e-6
    instant: float = 2e-6
    asked: bool = False
    assumed: tuple = ()
    times: np.ndarray | None = None

    def at(self, begin, rate, count):
        """What it is at even instants."""
        if self.times is None:
            return self.samples
        slope = (self.samples[-1] - self.samples[0]) / (self.times[-1] - self.times[0])
        instants = np.minimum(begin + np.arange(count) / rate, self.times[-1])
        return self.samples[0] + slope * (instants - self.times[0])


@dataclass(frozen=True)
class Column:
    """A channel to be written: ``numbers`` (sample,) as the file has them in a ``label``, NaN where missing; ``true``
    in ``si``; ``factor`` of the case."""

    numbers: np.ndarray
    label: str
    true: np.ndarray
    si: str
    measured: str
    factor: float = 1.0
    asked: bool = False

    def planted(self, rate, begin=0.0, **more):
        """The Planted of it."""
        return Planted(self.true, self.si, rate, begin, asked=self.asked, **more)

    def stated(self, column, unit=True, measures=True):
        """What a case states of it."""
        return {"column": column, "factor": self.factor} | (
            {"unit": self.label} if unit else {}) | ({"measures": self.measured} if measures else {})


def signal(rng, count):
    """Numbers (sample,) of which none looks like another moment, of a size as files have them, of five digits."""
    turns, size = np.arange(count) / count, 10.0 ** rng.integers(-1, 3)
    wave = np.sin(2 * np.pi * (float(rng.uniform(2, 6)) * turns + rng.random())) + 0.7 * turns**2 + rng.normal(
        size=count) / 20
    return np.round(size * (wave + rng.uniform(-1, 1)), 5)


def column(rng, count, stated=True, factors=_FACTORS, bad=0.06):
    """A Column of a quantity, unit and factor drawn at random; a share ``bad`` have a label that names no unit."""
    factor = float(factors[int(rng.integers(len(factors)))])
    if rng.random() < bad:
        numbers = signal(rng, count)
        label = ASKED_BACK[int(rng.integers(len(ASKED_BACK)))]
        return Column(numbers, label, numbers, "", "acceleration", factor, True)
    label = drawn(rng, stated)
    numbers = signal(rng, count)
    if label.level:
        numbers = np.round(60 + 30 * numbers / np.abs(numbers).max(), 3)
        return Column(numbers, label.text, label.size * 10.0 ** (numbers / 20), label.si, label.measured)
    return Column(numbers, label.text, label.size * factor * numbers + label.zero, label.si, label.measured, factor)


def is_line(one):
    """Whether a Column is a straight line of its numbers, as levels are not."""
    return one.asked or np.allclose(np.polyval(np.polyfit(one.numbers, one.true, 1), one.numbers), one.true)


def gaps(rng, one):
    """A Column some of whose samples are missing, none of them the first or last."""
    lost = np.zeros(len(one.numbers), bool)
    first = int(rng.integers(1, len(lost) - 6))
    lost[first:first + int(rng.integers(1, 5))] = True
    return replace(one, numbers=np.where(lost, np.nan, one.numbers), true=np.where(lost, np.nan, one.true)), lost


@dataclass(frozen=True)
class Meant:
    """Channels {run: {name: Planted}}: judges the value of ``read``."""

    runs: dict
    others: tuple = field(default=())

    def __call__(self, value):
        told = []
        if set(value["runs"]) != set(self.runs):
            return f"runs {sorted(value['runs'])} for {sorted(self.runs)}"
        for run, channels in self.runs.items():
            found = value["runs"][run]["channels"]
            strange = sorted(set(found) - set(channels) - set(self.others))
            if strange:
                return f"{run}: channels {strange} that are none"
            for name, planted in channels.items():
                said = _judged(planted, name, found.get(name), value["remarks"])
                if said and not isinstance(said, Told):
                    return f"{run}: {said}"
                told += [said] * bool(said)
        return Told("; ".join(told)) if told else ""


def cut(rng, stated, meant, share=0.2):
    """(section of a case, {name: Planted}) of a file, maybe with a run that is a part of the record: its begin and end
    are instants between samples of every channel."""
    if rng.random() > share or any(one.assumed or one.times is not None or one.asked for one in meant.values()):
        return stated, meant
    low = max(one.begin for one in meant.values())
    high = min(one.begin + (len(one.samples) - 1) / one.rate for one in meant.values())
    if high <= low:
        return stated, meant
    begin, end = np.round(sorted(rng.uniform(low, high, 2)), 7)
    parts = {}
    for name, one in meant.items():
        first, last = (float((t - one.begin) * one.rate) for t in (begin, end))
        if min(abs(t - round(t)) for t in (first, last)) < 0.05 or int(np.ceil(last)) - int(
                np.ceil(first)) < 3 or np.isnan(one.samples[int(np.ceil(first)):int(np.ceil(last))]).all():
            return stated, meant
        part = slice(int(np.ceil(first)), int(np.ceil(last)))
        parts[name] = replace(one, samples=one.samples[part], begin=one.begin + part.start / one.rate)
    return stated | {"runs": {"a": {"begin": f"{float(begin)!r} s", "end": f"{float(end)!r} s"}}}, parts


def _judged(planted, name, found, remarks):
    """'' of a channel as planted, Told of one of which a remark tells what is otherwise, else what is wrong."""
    if found is None:
        why = [one for one in remarks if _LEFT_OUT.search(one) and name in one.replace("/", "_")]
        return Told(f"left out: {name}") if why else f"no {name}, and no word of it"
    if planted.asked:
        return f"{name}: read as {found['unit']}, although its unit is none"
    off = _off(planted, found)
    if not off:
        return ""
    assumed = dict(planted.assumed)
    if set(off) <= set(assumed) and all(any(re.search(assumed[key], one) for one in remarks) for key in off):
        return Told(f"{name}: {'; '.join(off.values())}")
    return f"{name}: {'; '.join(off.values())}"


def _off(planted, found):
    """{what: in words} that is not as planted."""
    off = {}
    if found["unit"] != planted.si:
        off["unit"] = f"in {found['unit']} for {planted.si}"
    said = difference(found["samples"], planted.at(found["begin"], found["rate"], len(found["samples"])), planted.exact)
    if said:
        off["samples"] = f"samples{said}"
    if planted.times is None and not abs(found["rate"] / planted.rate - 1) <= planted.exact_rate:
        off["rate"] = f"{found['rate']:.9g} Hz for {planted.rate:.9g}"
    if not abs(found["begin"] - planted.begin) <= planted.instant:
        off["begin"] = f"from {found['begin']:.9g} s for {planted.begin:.9g}"
    return off


def read(path, files=(), others=()):
    """Plain values {runs, remarks} of what the stage makes of ``files``, sections of a case whose file names are in the
    folder of ``path``; ``others`` ((name, bytes), ...) lie beside it."""
    written = [path.with_name(name) for name, _ in others]
    try:
        for beside, (_, content) in zip(written, others, strict=True):
            beside.write_bytes(content)
        stated = [_placed({"file": path.name} | file, path) for file in files]
        made = recording.recording(settings=fill(recording.Settings, {"files": stated}, "case.yaml: recording"))
    finally:
        for beside in written:
            beside.unlink(missing_ok=True)
    return {"runs": plain.of_runs(made.runs), "remarks": [str(one) for one in made.remarks]}


def _placed(stated, path):
    """A section of a case with its files in the folder of ``path``."""
    if not isinstance(stated, dict):
        return stated
    return {key: str(path.with_name(value)) if key == "file" else _placed(value, path) for key, value in stated.items()}
