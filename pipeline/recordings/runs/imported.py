"""Runs that an import has made so far: several files of one stop on one clock, and what is told of them."""

from dataclasses import dataclass, field, replace

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.contract.units import read_as
from pipeline.products import FileClock, Run
from pipeline.recordings.runs.offsets import offset_between
from pipeline.recordings.waveform import free_name, plain_name

_STATE = ("state offset: SECONDS (0 s where both began at once), or common: {channel: A, other: B}, a channel of this"
          " file and one of the other that show the same")


@dataclass
class Imported:
    """What becomes of files.

    ``keep_going``: a channel that cannot be used is told and left out, else its error ends the import.
    ``hear(sentence)`` takes what is told. ``runs`` {name: Run} and ``remarks``: what there is so far.
    """

    keep_going: bool
    hear: object
    runs: dict = field(default_factory=dict)
    remarks: list = field(default_factory=list)
    _first: dict = field(default_factory=dict)      # run -> (its first file, stamp of its 0 s or None)

    def tell(self, sentence):
        """Tell and keep a sentence."""
        self.remarks.append(sentence)
        self.hear(sentence)

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

    def on_clock(self, file, names, channels, stamp=None):
        """(``channels`` {name: Channel} of a file with their times on the clock of its runs ``names``, {its name:
        FileClock} where it joins them or its case states an offset).

        ``stamp``: that of the file, see Waveform. Raises ConfigError for a file that joins a run of another one by no
        offset: neither stated, nor by common channels, nor by the time stamps of both.
        """
        joined = [name for name in names if name in self.runs and self.runs[name].channels]
        clock = self._clock(file, joined, channels, stamp)
        shift = 0.0 if clock is None else float(clock.offset)
        own = None if stamp is None else (stamp[0] - shift, stamp[1])
        for name in names:
            self._first.setdefault(name, (file.file.name, own))
        if clock is None:
            return channels, {}
        spread = f" +- {float(clock.offset_std):.2g} s" if clock.offset_std > 0 else ""
        self.tell(f"{file.file}: {shift:.9g} s{spread} are added to its times"
                  f"{' for run ' + ', '.join(joined) if joined else ''}: {clock.origin}")
        taken = {key for name in joined for key in self.runs[name].clocks}
        return later(channels, shift), {free_name(plain_name(file.file.name, "file"), taken): clock}

    def _clock(self, file, joined, channels, stamp):
        """FileClock of a file, None of one that has its own clock."""
        where = f"{file.file}"
        if file.common is not None and file.offset is not None:
            raise ConfigError(f"{where}: common", "no offset beside it, which it finds", f"{file.offset:g} s")
        if file.common is not None:
            return self._found(file.common, joined, channels, f"{where}: common")
        if file.offset is not None:
            return FileClock(offset=file.offset, offset_std=file.offset_std, origin="stated in the case")
        if not joined or not channels:
            return None
        return self._stamped(where, joined, channels, stamp)

    def _found(self, common, joined, channels, where):
        """FileClock by a channel that both files hold."""
        if not joined:
            raise ConfigError(where, "a run of a file further up in the list", "none", "list that file first")
        run = self.runs[joined[0]]
        for key, name, known in (("channel", common.channel, channels), ("other", common.other, run.channels)):
            if name not in known:
                raise ConfigError(f"{where}.{key}", f"one of {', '.join(known)}", repr(name))
        found = offset_between(run.channels[common.other], channels[common.channel], where)
        what = "envelopes of " if found.envelope else ""
        return FileClock(offset=found.offset, offset_std=found.std, origin=f"where {what}{common.channel} and"
                         f" {common.other} fit best (correlation {found.correlation:.2f})")

    def _stamped(self, where, joined, channels, stamp):
        """FileClock by the time stamps of both files."""
        first, reference = self._first[joined[0]]
        if stamp is None or reference is None:
            lacks = " nor in ".join(name for name, one in ((first, reference), (where, stamp)) if one is None)
            raise ConfigError(f"{where}: runs.{joined[0]}", f"its offset from {first}, which the run has channels of"
                              " already", f"no time stamp in {lacks}", _STATE)
        offset = stamp[0] - reference[0]
        begin, end = span(later(channels, offset))
        other_begin, other_end = span(self.runs[joined[0]].channels)
        if begin > other_end or end < other_begin:
            raise ConfigError(f"{where}: runs.{joined[0]}", f"times within those of {first}, {other_begin:.6g} s to"
                              f" {other_end:.6g} s", f"{begin:.6g} s to {end:.6g} s by the time stamps of both", _STATE)
        std = ((stamp[1] ** 2 + reference[1] ** 2) / 12.0) ** 0.5
        return FileClock(offset=offset, offset_std=std, origin=f"by its time stamp and that of {first}, in steps of"
                         f" {stamp[1]:g} s and {reference[1]:g} s, as far as both clocks agree")

    def add(self, runs, where):
        """Add runs of a file {name: Run}; a run that there is already gets what the new one holds besides.

        Raises ConfigError for what has the name of another one there.
        """
        for name, run in runs.items():
            self.runs[name] = _joined(self.runs[name], run, f"{where}: runs.{name}") if name in self.runs else run


def later(channels, shift):
    """``channels`` {name: Channel} so many seconds later."""
    return {name: replace(one, begin=float(one.begin) + shift) for name, one in channels.items()}


def span(channels):
    """(begin of the first of ``channels`` {name: Channel}, end of the last one) in s."""
    return (min(float(one.begin) for one in channels.values()),
            max(float(one.begin) + len(one.samples) / float(one.rate) for one in channels.values()))


def _same(one, other):
    """Whether two Conditions are the same."""
    return str(one.unit) == str(other.unit) and np.array_equal(one.value, other.value) and (
        np.array_equal(one.time, other.time))


def _joined(first, second, where):
    """The Run of what two files hold of it."""
    parts = {}
    for kind in ("conditions", "channels", "frf", "modes", "lines", "topography", "friction", "clocks"):
        one, other = getattr(first, kind), getattr(second, kind)
        twice = sorted(name for name in set(one) & set(other) if kind != "conditions" or not _same(*(
            part[name] for part in (one, other))))
        if twice:
            raise ConfigError(where, f"{kind} whose names the run does not have yet", ", ".join(twice),
                              "give the run or them other names")
        parts[kind] = one | other
    told = {key: str(getattr(first, key)) or str(getattr(second, key)) for key in ("description", "repeat_of")}
    return Run(**told, **parts)
