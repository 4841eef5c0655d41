"""Text tables: columns of numbers with names, units, and what their head says of the sampling."""

import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.contract.received.plain_text import cells, decoded, lines_of, number, seconds_of, stamp
from pipeline.recordings.tables.labview import BEGINS, measurement
from pipeline.recordings.tables.layout import REMEDY, Form, layout

#: rows in which the decimal mark is looked for
_LOOKED = 10_000


@dataclass(frozen=True)
class TextTable:
    """``columns`` {name: (row,)}, NaN where a number is missing; ``units`` {name: unit}; ``rate`` in Hz that the head
    states, or None; ``flaws`` {name: ConfigError} of columns with texts that are no numbers; ``remarks``; ``shown``:
    how the lines are understood; ``begin`` in s of what has no times."""

    columns: dict
    units: dict
    rate: float | None = None
    flaws: dict = field(default_factory=dict)
    remarks: list = field(default_factory=list)
    shown: str = ""
    begin: float = 0.0

    @classmethod
    def of(cls, waveforms, wanted=()):
        """The table of {name: Waveform}; their rate and begin where those ``wanted``, else all with a rate, agree."""
        axes = {(w.rate, w.begin) for name, w in waveforms.items() if (name in wanted if wanted else w.rate)}
        rate, begin = axes.pop() if len(axes) == 1 else (None, 0.0)
        return cls({name: w.values for name, w in waveforms.items()}, {}, rate, begin=begin)

    def used(self, wanted):
        """Refuse columns ``wanted`` {where: name} that the file does not hold, or that hold texts (ConfigError)."""
        for where, name in wanted.items():
            if name in self.flaws:
                raise self.flaws[name]
            if name not in self.columns:
                raise ConfigError(where, f"one of {', '.join(self.columns)}", repr(name), self._instead(name))

    def on_clock(self, wanted, time):
        """Refuse columns ``wanted`` {where: name} that stand behind another column of times than ``time``, of those of
        one name that differ (ConfigError)."""
        names = list(self.columns)
        plain = re.sub(r" \(\d+\)$", "", time or "")
        clocks = [name for name in names if re.fullmatch(re.escape(plain) + r" \(\d+\)", name)]
        if time not in clocks or clocks[0] != names[0]:
            return
        for where, name in wanted.items():
            clock = [other for other in clocks if names.index(other) < names.index(name)][-1:]
            if clock and clock[0] != time:
                raise ConfigError(where, f"a column behind {time!r}, whose times it has", f"{name!r}, which stands"
                                  f" behind {clock[0]!r}", "list the file once more, with offset: 0 s and time:"
                                  f" {clock[0]!r}")

    def _instead(self, name):
        parts = [column for column in self.columns if re.fullmatch(re.escape(name) + r"\(:?\d*,:?\d*\)", column)]
        if parts:
            return f"{name} is a matrix: name one of its {len(parts)} columns, such as {parts[-1]}"
        return f"read as {self.shown}; {REMEDY}" if self.shown else None


def read_table(path, form=None, wanted=None):
    """Column name -> (row,) of a text table, NaN where a number is missing; see ``text_table``.

    Raises ConfigError with the line of a text that is no number, in the columns ``wanted`` {where: name}, None: all.
    """
    table = text_table(path, form)
    table.used({name: name for name in table.flaws} if wanted is None else wanted)
    return table.columns


def text_table(path, form=None):
    """TextTable of a text table or a LabVIEW measurement, as a ``form`` states and its lines show.

    Time stamps become seconds from the first. Raises ConfigError with the line, what was understood and the setting
    that changes it.
    """
    path, form = Path(path), form or Form()
    text, encoding = decoded(path, form.encoding)
    lines = lines_of(text)
    if lines[0].startswith(BEGINS):
        head, rows = measurement(lines, path, encoding)
    else:
        head = layout(lines, path, form, encoding)
        rows = _rows(lines, head, path, form)
        if form.decimal is None:
            head.remarks.extend(_ambiguous(rows, head.decimal))
    table = _table(head, rows, path)
    filled = [line for line in lines if line.strip()]
    if not text.endswith(("\n", "\r")) and len(filled) > 2 and _shorter(filled, head.delimiter):
        raise ConfigError(f"{path}:{len(lines)}", "a last number as long as those above it, or a line break behind it",
                          repr(lines[-1][-20:]), "the file is cut off: copy it again")
    return table


def _rows(lines, head, path, form):
    """[(number of the line, texts of its columns)] of the rows of a layout."""
    rows, width = [], max(head.positions) + 1
    for k in range(head.first, head.last):
        if not lines[k].strip():
            continue
        texts = cells(lines[k], head.delimiter)
        if len(texts) < width or any(texts[width:]):
            raise ConfigError(f"{path}:{k + 1}", f"{width} values", f"{len(texts)}", f"read as {head.shown}; {REMEDY}")
        rows.append((k + 1, ["" if texts[j] in form.missing else texts[j] for j in head.positions]))
    return rows


def _ambiguous(rows, decimal):
    """[What to say] of rows whose numbers show nowhere whether ``decimal`` is one, or sets thousands apart."""
    group = re.compile(rf"[-+]?[1-9]\d{{0,2}}{re.escape(decimal)}\d{{3}}")
    marked = [text for _, texts in rows[:_LOOKED] for text in texts if decimal in text]
    if not marked or not all(map(group.fullmatch, marked)):
        return []
    return [f"numbers such as {marked[0]} are read with the decimal mark {decimal!r}, which nothing else shows: state"
            f" decimal: {decimal!r}; where it sets thousands apart, save them without"]


def _table(head, rows, path):
    """TextTable of rows of texts."""
    columns, units, flaws, remarks = {}, dict(head.units), {}, list(head.remarks)
    for k, name in enumerate(head.names):
        texts = [(line, row[k]) for line, row in rows]
        values = [number(text, head.decimal) for _, text in texts]
        if None in values:
            seconds = _stamped([text for _, text in texts])
            if seconds is None:
                line, text = next(t for t, value in zip(texts, values, strict=True) if value is None)
                flaws[name] = ConfigError(f"{path}:{line}", "a number", f"{text!r} in {name}", f"read as {head.shown};"
                                          f" {REMEDY}; of a missing number, missing: [TEXT]")
                continue
            remarks.append(f"{name} holds time stamps: seconds from {texts[0][1]} on")
            values, units[name] = seconds, "s"
        columns[name] = np.array(values, float)
    return TextTable(*_merged(columns, units, head.repeated), head.rate, flaws, remarks, head.shown,
                     head.begin)


def _merged(columns, units, repeated):
    """Columns, of those of one name that hold the same the first alone, under its plain name; and their units."""
    merged, kept = {}, {}
    for name, values in columns.items():
        plain = repeated.get(name)
        alike = [columns[other] for other in columns if plain is not None and repeated.get(other) == plain]
        new = plain if alike and all(np.array_equal(values, other, equal_nan=True) for other in alike) else name
        merged.setdefault(new, values)
        if name in units:
            kept.setdefault(new, units[name])
    return merged, kept


def _stamped(texts):
    """Seconds (row,) from the first of time stamps; None where a text is none."""
    stamps = [stamp(text) for text in texts]
    if any(s is None and number(text) is None for s, text in zip(stamps, texts, strict=True)) or not any(stamps):
        return None
    return seconds_of(stamps)


def _shorter(lines, delimiter):
    """Whether a file that ends within a line ends with a number of fewer digits in all, or fewer decimals, than all
    others of its column."""
    ends = [cells(line, delimiter)[-1].lstrip("+-") for line in lines[1:]]
    return any(size(ends[-1]) < min(map(size, ends[:-1])) for size in (len, lambda end: len(end.partition(".")[2])))
