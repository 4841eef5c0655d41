"""LabVIEW measurements (.lvm): segments of a head, a row of names and rows of numbers.

NI, Specification for the LabVIEW Measurement File (.lvm).
"""

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.contract.received.plain_text import cells, number
from pipeline.recordings.tables.layout import Layout, rate_of, repeated, unlike

#: first words of such a file, and the line that ends a head
BEGINS, _END = "LabVIEW Measurement", "***End_of_Header***"


def measurement(lines, path, encoding):
    """(Layout, [(number of the line, texts)]) of the lines of a LabVIEW measurement; its segments follow one another.

    Where the file holds no times, X_Value is made of X0 and Delta_X of each segment. Raises ConfigError for a file
    without channels and for segments of other channels.
    """
    ends = [k for k, line in enumerate(lines) if line.startswith(_END)]
    mark = {"Comma": ",", "Tab": "\t"}.get(_value(lines[:ends[0]] if ends else lines, "Separator"), "\t")
    head = {texts[0]: texts[1:] for line in lines[:ends[0] if ends else 0] if len(texts := cells(line, mark)) > 1}
    decimal = (head.get("Decimal_Separator") or ["."])[0] or "."
    if mark == ",":
        decimal = "."
    names, rows, heads, last = None, [], [], ends[0] if ends else 0
    for end in ends[1:]:
        stated = {texts[0]: texts[1:] for line in lines[last + 1:end] if len(texts := cells(line, mark)) > 1}
        here = cells(lines[end + 1], mark) if end + 1 < len(lines) else []
        if names is not None and here != names:
            raise ConfigError(f"{path}:{end + 2}", f"the channels of the first segment, {', '.join(names)}",
                              ", ".join(here), "save each segment as a file of its own")
        names, last = here, next((k for k in range(end + 2, len(lines)) if not lines[k].strip()), len(lines))
        _refuse_apart(stated, head, decimal, f"{path}:{end + 1}")
        found = _segment(lines, end + 2, last, mark, decimal, here, stated, head)
        rows, heads = rows + found, [*heads, (stated, len(found))]
    if names is None or not rows:
        raise ConfigError(path, "a LabVIEW measurement with channels", f"{len(ends)} heads, {len(rows)} rows",
                          "save it with its segment headers")
    return _layout(names, rows, heads, mark, decimal, encoding), rows


def _refuse_apart(stated, head, decimal, where):
    """ConfigError for channels that begin apart, or have unlike intervals, beside one column of times or none."""
    apart = [key for key in ("X0", "Delta_X") if len({number(t, decimal) for t in stated.get(key, ()) if t}) > 1]
    if apart and (head.get("X_Columns") or ["One"])[0] != "Multi":
        raise ConfigError(where, f"one {apart[0]} of all channels, as their times stand in one column or none",
                          ", ".join(filter(None, stated[apart[0]])), "save it with a column of times for each channel")


def _value(lines, key):
    """The value of a key in a head whose separator is not yet known."""
    line = next((line for line in lines if line.startswith(key)), "")
    return line[len(key):].strip(", \t").split(",")[0].strip()


def _count(names):
    """Columns of numbers: all but that of comments."""
    return len(names) - (names[-1:] == ["Comment"])


def _segment(lines, first, last, mark, decimal, names, stated, head):
    """Rows of a segment, times filled in where it holds none; missing ends of rows stay empty."""
    count, rows = _count(names), []
    start, step = (next((number(t, decimal) for t in stated.get(key, ()) if t), None) for key in ("X0", "Delta_X"))
    made = (head.get("X_Columns") or ["One"])[0] == "No" and step is not None
    for k in range(first, last):
        texts = cells(lines[k], mark)
        texts = (texts + [""] * count)[:count]
        if made and not texts[0]:
            texts[0] = repr((start or 0.0) + (k - first) * step).replace(".", decimal)
        rows.append((k + 1, texts))
    return rows


def _clock(heads, decimal):
    """(rate in Hz, begin in s) of segments [(head, rows)] whose channels begin together, each where the one before it
    ends; (None, 0) of others: their times tell."""
    rates = {rate_of([("delta_x", stated.get("Delta_X", []))], decimal) for stated, _ in heads}
    begins = [{number(text, decimal) for text in stated.get("X0", ()) if text} or {0.0} for stated, _ in heads]
    rate = rates.pop() if len(rates) == 1 else None
    if rate is None or any(len(each) > 1 or None in each for each in begins):
        return None, 0.0
    begins, ends = [min(each) for each in begins], np.cumsum([0, *(rows for _, rows in heads)])
    if any(abs(begin - begins[0] - end / rate) > 0.5 / rate for begin, end in zip(begins, ends, strict=False)):
        return None, 0.0
    return rate, begins[0]


def _layout(names, rows, heads, mark, decimal, encoding):
    count, (stated, _) = _count(names), heads[-1]
    texts = stated.get("Y_Unit_Label", [])
    channels = [k for k in range(count) if names[k] != "X_Value"]
    numbered = unlike(names[:count])
    units = {numbered[k]: text for k, text in zip(channels, texts, strict=False) if text}
    if set(filter(None, stated.get("X_Dimension", []))) <= {"Time"}:
        units |= {numbered[k]: "s" for k in range(count) if k not in channels}
    shown = (f"LabVIEW measurement, {encoding}, columns by {'tabs' if mark == chr(9) else mark!r}, decimal {decimal!r},"
             f" names {', '.join(numbered)[:150]}, numbers from line {rows[0][0]}")
    rate, begin = _clock(heads, decimal)
    return Layout(mark, decimal, numbered, units, list(range(count)), rows[0][0] - 1, rows[-1][0], rate, [], shown,
                  repeated(numbered, names[:count]), begin)
