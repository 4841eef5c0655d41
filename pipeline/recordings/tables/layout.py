"""Where a text table has its names, units and numbers, and what its head says of the sampling."""

import re
from collections import Counter
from dataclasses import dataclass, field
from typing import Literal

from pipeline.contract import Section, option
from pipeline.contract.errors import ConfigError
from pipeline.contract.received.plain_text import cells, delimiter_of, is_datum, marks, number, stamp
from pipeline.contract.units import in_si
from pipeline.recordings.survey.meanings import split_unit

#: lines that show what separates the columns; most rows between names and numbers; lines of a footer at most
_SHOWN, _ROWS, _FOOTER = 60, 4, 5
#: what stands before names in lines of comments, and the line with which Excel states the delimiter
_COMMENT, _EXCEL = re.compile(r"\s*(#+|%+|//|!)\s*"), re.compile(r'"?sep=(.)"?')
_BRACKETED = re.compile(r"\[([^\]]*)\]|\(((?:[^()]|\([^()]*\))*)\)")
_NAME = re.compile(r"[^\s\[(]+(?:\s*[\[(][^\])]*[\])])?")
#: words for units of which the symbols are read
_SPELT = {"second": "s", "seconds": "s", "sec": "s", "sekunde": "s", "sekunden": "s", "millisecond": "ms",
          "milliseconds": "ms", "millisekunden": "ms", "microsecond": "us", "microseconds": "us", "minute": "min",
          "minutes": "min", "minuten": "min", "stunden": "h", "hour": "h", "hours": "h", "volt": "V", "volts": "V",
          "ampere": "A", "amperes": "A", "amp": "A", "amps": "A", "newton": "N", "hertz": "Hz", "pascal": "Pa"}
_NO_UNIT = frozenset({"", "-", "[-]", "[]", "()", "1"})
_LABELS = frozenset({"unit", "units", "einheit", "einheiten", "sequence"})
_PAIR = re.compile(r"[#%!/\s]*([^:=]+?)\s*[:=]\s*(.+)")
_RATE = re.compile(r"fs|(sampl\w*|abtast\w*|mess|measur\w*|scan)[\s_]*(rate|freq\w*|frequenz)", re.IGNORECASE)
_INTERVAL = re.compile(r"delta[\s_]?x|tinterval|hresolution|((sampl\w*|abtast\w*|scan|x|time|h)[\s_]*)"
                       r"(interval\w*|period|increment|resolution)", re.IGNORECASE)
#: the settings that change how a text table is read
REMEDY = "else state delimiter, decimal, encoding, units_row or skip, the lines before the names"
_VALUE = re.compile(r"([-+]?[\d.,]+(?:[eE][-+]?\d+)?)\s*(\S*)")


class Form(Section):
    """How the lines of a text table are read; what is left out is as they show."""

    delimiter: str | None = option(None, "what separates columns, blank for any white space; none = tab, semicolon,"
                                         " comma or blanks, as the lines show")
    decimal: Literal[".", ","] | None = option(None, "decimal mark; none = as the numbers show")
    encoding: str | None = option(None, "encoding, such as cp1252 or shift_jis; none = by its mark, UTF-8 or cp1252")
    skip: int = option(0, "lines before the row of names; 0 = found above the numbers", ge=0)
    units_row: bool | None = option(None, "whether a row of units follows the names; none = as it shows")
    missing: tuple[str, ...] = option((), "texts that stand for missing numbers, besides nan, n/a and the like")


@dataclass(frozen=True)
class Layout:
    """``names`` and ``units`` {name: unit} of the columns, their ``positions``; ``first`` and ``last``: numbers of the
    lines, counted from 0, with the first numbers and behind the last ones; ``rate`` in Hz as the head states it, or
    None; ``remarks``; ``shown``: how the lines are understood; ``repeated`` {name: as written} of those numbered;
    ``begin`` in s of what has no times."""

    delimiter: str
    decimal: str
    names: list
    units: dict
    positions: list
    first: int
    last: int
    rate: float | None
    remarks: list
    shown: str
    repeated: dict = field(default_factory=dict)
    begin: float = 0.0


def layout(lines, path, form, encoding):
    """Layout of ``lines``; ConfigError with the line, and what was understood, where they are none of a table."""
    form, skip = _of_excel(lines, form)
    filled = [k for k in range(skip, len(lines)) if lines[k].strip()]
    if len(filled) < 2:
        raise ConfigError(path, "a header and at least one line of numbers", f"{len(filled)} lines",
                          "" if len(filled) == len([line for line in lines if line.strip()]) else "lower skip")
    later = filled[len(filled) // 2:]
    sample = later[::max(1, len(later) // _SHOWN)][:_SHOWN]
    delimiter, decimal = marks([_bare(lines[k]) for k in filled[:_SHOWN] if k < sample[0]], [lines[k] for k in sample],
                               delimiter_of(form.delimiter), form.decimal)
    if form.delimiter and not any(delimiter_of(form.delimiter) in lines[k] for k in filled):
        raise ConfigError(path, f"a text table whose columns {form.delimiter!r} separates", f"{lines[filled[-1]]!r}")
    split = {k: _missing(cells(lines[k], delimiter), form.missing) for k in filled}
    numeric = _numeric([split[k] for k in sample], decimal)
    if not any(numeric):
        raise ConfigError(path, "a header and at least one line of numbers", _first_lines(lines, filled),
                          "state delimiter, decimal, encoding, or skip, the lines before the names")
    first = _first_row(split, filled, sample, numeric, decimal)
    remarks = []
    last = _behind_last(split, filled, decimal, remarks)
    return _Head(lines, path, form, delimiter, decimal, encoding, skip).named(first, last, split, remarks)


def _of_excel(lines, form):
    """(form, lines to leave out) where Excel states its delimiter in the first line."""
    stated = _EXCEL.fullmatch(lines[0].strip()) if lines else None
    if not stated or form.skip:
        return form, form.skip
    return form.model_copy(update={"delimiter": form.delimiter or stated[1]}), 1


def _missing(texts, missing):
    return ["" if text in missing else text for text in texts] if missing else texts


def _bare(line):
    """A line without the mark of a comment."""
    return _COMMENT.sub("", line, count=1) if _COMMENT.match(line) else line


def _numeric(rows, decimal):
    """[whether column k is one of numbers] by most of the rows, None of an empty one."""
    width = max(map(len, rows))
    counts = [[0, 0] for _ in range(width)]
    for row in rows:
        for k, text in enumerate(row):
            counts[k][0] += bool(text) and is_datum(text, decimal)
            counts[k][1] += bool(text)
    return [(numbers > 0 and 2 * numbers >= texts) if texts else None for numbers, texts in counts]


def _first_row(split, filled, sample, numeric, decimal):
    """Number of the first line of numbers, upwards from one of the ``sample``; rows with a text among their numbers
    stand between others."""
    first = next((k for k in sample if _is_row(split[k], numeric, decimal)), sample[-1])
    for k in reversed(filled[:filled.index(first)]):
        if _is_row(split[k], numeric, decimal):
            first = k
        elif not _is_row(split[k], numeric, decimal, any):
            break
    return first


def _is_row(row, numeric, decimal, most=all):
    """Whether all, or any, of the texts in columns of numbers are such, and none in empty columns is another text."""
    values = [text for text, wanted in zip(row, numeric, strict=False) if wanted]
    others = [text for text, wanted in zip(row, numeric, strict=False) if wanted is None]
    if not any(values) or not all(is_datum(text, decimal) for text in others):
        return False
    return most(is_datum(text, decimal) for text in values if text or most is all)


def _behind_last(split, filled, decimal, remarks):
    """Number of the line behind the last one of numbers: few lines without any number may follow."""
    last = len(filled)
    while last > max(len(filled) - _FOOTER, 1) and not any(
            text and is_datum(text, decimal) for text in split[filled[last - 1]]) and not re.match(
            r"\s*[-+.\d]", " ".join(split[filled[last - 1]])):
        last -= 1
    if last < len(filled):
        remarks.append(f"lines from {filled[last] + 1} on are left out, as they hold no numbers:"
                       f" {split[filled[last]][0][:40]!r}")
    return filled[last - 1] + 1


def _first_lines(lines, filled):
    return "; ".join(f"line {k + 1}: {lines[k].strip()[:60]!r}" for k in filled[:4])


@dataclass(frozen=True)
class _Head:
    """The lines above the numbers."""

    lines: list
    path: object
    form: Form
    delimiter: str
    decimal: str
    encoding: str
    skip: int

    def named(self, first, last, split, remarks):
        """The Layout of a table whose numbers begin in line ``first``."""
        body = [split[k] for k in split if first <= k < last]
        width = max(map(len, body))
        while width > 1 and not any(row[width - 1:] and row[width - 1] for row in body):
            width -= 1
        above = [k for k in split if k < first]
        rows = {k: self._row(k, width) for k in above[-_ROWS - 1:]}
        stated = self._stated(above)
        names_line, names, units_line, units = self._names_and_units(rows, width, stated, body)
        if names_line is None and above and self._looks_like_names(above[-1], width):
            count = max(len(cells(_bare(self.lines[above[-1]]), d)) for d in (self.delimiter, ",", ";", "\t"))
            raise ConfigError(f"{self.path}:{first + 1}", f"{count} values, as many as names in line {above[-1] + 1}",
                              f"{width}", REMEDY)
        if names_line is None and not names:
            names = [f"column {k + 1}" for k in range(width)]
            remarks.append(f"no row of names: the columns are called {names[0]} to {names[-1]}")
        positions = [k for k in range(width) if names[k] or any(row[k:k + 1] and row[k] for row in body)]
        names = [names[k] or f"column {k + 1}" for k in range(width)]
        written = [names[k] for k in positions]
        names = unlike(written)
        units = {name: units[k] for name, k in zip(names, positions, strict=True) if units and units[k]}
        shown = self._shown(names_line, units_line, first, names)
        return Layout(self.delimiter, self.decimal, names, units, positions, first, last, rate_of(stated, self.decimal),
                      remarks, shown, repeated(names, written))

    def _row(self, k, width):
        """Texts of a line of the head in ``width`` columns, however it separates them; None where it has others."""
        line = _bare(self.lines[k])
        ways = [cells(line, d) for d in dict.fromkeys((self.delimiter, "\t", ";", ","))]
        if self.delimiter in "\t ":
            ways += [re.split(r"\s{2,}|\t", line.strip()), _NAME.findall(line), line.split()]
        if width == 1:
            single = all(len(texts) == 1 for texts in ways[:4])
            return ways[0] if single else [line.strip()] if "[" in line else None
        for texts in ways:
            while len(texts) > width and not texts[-1]:
                texts = texts[:-1]
            if len(texts) > width >= 1 and all(text in ("Comment", "Start", "Increment") for text in texts[width:]):
                texts = texts[:width]
            if len(texts) == width:
                return texts
        return None

    def _names_and_units(self, rows, width, stated, body):
        """(line of the names or None, names, line of the units or None, units or None)."""
        for label, texts in stated:
            if label in ("tracename", "channelname", "channel name", "kanalname") and len(texts) in (width, width - 1):
                names = [""] * (width - len(texts)) + texts
                return None, names, None, next(([""] * (width - len(u)) + u for key, u in stated if key in (
                    "vunit", "unit", "units", "einheit") and len(u) == len(texts)), None)
        full = [k for k in rows if rows[k] is not None and any(rows[k])]
        full = [k for k in full if not (rows[k][0] and self._is_number(rows[k][0]))
                and not all(self._is_number(text) for text in rows[k] if text)]
        under = [k for k in full if _are_units(rows[k])]
        full = [k for k in full if k + 1 in under or not any(self._is_number(text) for text in rows[k] if text)]
        if not full:
            return self._of_index(rows, width, body)
        wanted = self.form.units_row
        units = under if wanted is None else full[-1:] if wanted else []
        for k in reversed(units):
            over = [j for j in full if j < k]
            if over and not _are_units(rows[over[-1]]):
                return over[-1], rows[over[-1]], k, [_unit(text) for text in rows[k]]
        if wanted:
            raise ConfigError(f"{self.path}:{full[-1] + 1}", "a row of names above the row of units",
                              f"{self.lines[full[-1]]!r}", "state units_row: false")
        return full[-1], rows[full[-1]], None, None

    def _of_index(self, rows, width, body):
        """Names of a table whose first column, numbers of rows, has none."""
        last = max(rows, default=None)
        counted = [number(row[0], self.decimal) for row in body]
        if last is None or width < 3 or counted != [k + (counted[0] or 0) for k in range(len(body))]:
            return None, [], None, None
        shorter = self._row(last, width - 1)
        return (last, ["", *shorter], None, None) if shorter and not any(map(self._is_number, shorter)) else (
            None, [], None, None)

    def _is_number(self, text):
        return number(text, self.decimal) is not None and text.lower() not in ("-", "--", "---", "na", "none", "null") \
            or stamp(text) is not None

    def _looks_like_names(self, k, width):
        """Whether the line above the numbers is a row of several names, but not of as many."""
        texts = max((cells(_bare(self.lines[k]), d) for d in (self.delimiter, *",;\t"[:3 * (width == 1)])), key=len)
        return len(texts) > 1 and len(texts) != width and all(texts) and not re.search("[:=]", self.lines[k])

    def _stated(self, above):
        """[(key in lower case, [values])] of the lines of the head."""
        stated = []
        for k in above:
            texts = cells(_bare(self.lines[k]), self.delimiter)
            pair = _PAIR.fullmatch(self.lines[k].strip()) if len([t for t in texts if t]) < 2 else None
            key, values = (pair[1], [pair[2]]) if pair else (texts[0].rstrip(": ="), texts[1:])
            if values:
                stated.append((key.strip().lower(), values))
        return stated

    def _shown(self, names_line, units_line, first, names):
        mark = {"\t": "tabs", " ": "blanks"}.get(self.delimiter, repr(self.delimiter))
        where = "no row of names" if names_line is None else f"names in line {names_line + 1}"
        units = "" if units_line is None else f", units in line {units_line + 1}"
        return (f"{self.encoding}, columns by {mark}, decimal {self.decimal!r}, {where} ({', '.join(names)[:150]})"
                f"{units}, numbers from line {first + 1}: {self.lines[first].strip()[:60]!r}")


def _unit(text):
    """The unit in a text of a row of units, as it is read."""
    inside = _BRACKETED.fullmatch(text)
    text = (inside[1] or inside[2] or "" if inside else text).strip()
    return "" if text in _NO_UNIT or text.lower().rstrip(":") in _LABELS else spelt(text)


def spelt(unit):
    """The symbol of a unit that is written out; any other as it is."""
    return _SPELT.get(unit.strip().lower(), unit.strip())


def _are_units(texts):
    """Whether the texts of a row are units: in brackets, or known ones."""
    filled = [text for text in texts if text not in _NO_UNIT and text.lower().rstrip(":") not in _LABELS]
    if not filled or all(_BRACKETED.fullmatch(text) for text in filled):
        return bool(filled)
    labelled = any(text.lower().rstrip(":") in _LABELS for text in texts)
    letters = not labelled and all(len(text) == 1 and text.isalpha() for text in filled)    # as likely names: t, U
    return all(map(_si_unit, filled)) and (not letters or _si_unit(filled[0]) == "s")


def _si_unit(text):
    """The SI unit of a text that is a unit; '' of any other."""
    try:
        return in_si(1.0, _unit(text), "unit")[1]
    except ConfigError:
        return ""


def unlike(names):
    """Names of which those that occur several times are numbered."""
    total, count, numbered = Counter(names), Counter(), []
    for name in names:
        count[name] += 1
        numbered.append(f"{name} ({count[name]})" if total[name] > 1 else name)
    return numbered


def repeated(names, written):
    """{name: as written} of the names that were numbered."""
    return {name: plain for name, plain in zip(names, written, strict=True) if name != plain}


def rate_of(stated, decimal):
    """Sampling rate in Hz that the head states, the same for all channels; None of none."""
    rates = set()
    for key, values in stated:
        name, unit = split_unit(key)
        for pattern, default, inverse in ((_RATE, "Hz", False), (_INTERVAL, "s", True)):
            if pattern.fullmatch(name):
                found = {_quantity(value, unit or default, decimal) for value in values if value}
                rates |= {value and (1.0 / value if inverse else value) for value in found}
    rates -= {None, 0.0}
    return rates.pop() if len(rates) == 1 else None


def _quantity(text, unit, decimal):
    """A value in SI of a text such as '51.2 kHz' or '1e-4'; None of any other."""
    match = _VALUE.fullmatch(text.strip())
    value = match and number(match[1], decimal if "," in match[1] else ".")
    if not match or value is None:
        return None
    named = re.sub(r"(?i)(sa|s)/s(ec)?$|sps$|1/s$", "Hz", match[2]) if match[2] else unit
    try:
        converted, si = in_si(value, spelt(named), "unit")
    except ConfigError:
        return None
    return float(f"{converted:.12g}") if si in ("Hz", "s") else None
