"""Cards of Nastran bulk data: fixed fields of 8 or 16 columns, free fields between commas, continuations, includes."""

import re
from dataclasses import dataclass, field
from math import isfinite
from pathlib import Path

from pipeline.contract.errors import ConfigError
from pipeline.contract.received.includes import joined_name, opened_in, read_lines

_BEGIN = re.compile(r"\s*BEGIN\b", re.IGNORECASE)
_INCLUDE = re.compile(r"\s*INCLUDE\s+(.*)", re.IGNORECASE | re.DOTALL)
#: data fields of a line of fields 8 or 16 columns wide
_DATA = {8: 8, 16: 4}


@dataclass
class Card:
    """``name`` in capitals, ``fields`` behind it as texts, those of continuations as well; ``where``: 'file:line'."""

    name: str
    where: str
    fields: list = field(default_factory=list)

    def get(self, number):
        """Field ``number``, that of the name being 1 as in the manuals; '' where there is none."""
        return self.fields[number - 2] if number - 2 < len(self.fields) else ""


def cards(path):
    """(head lines before BEGIN BULK, generator of the Cards of the bulk data) of the deck at ``path``.

    Raises ConfigError for a continuation of nothing or of another card, fields beyond a line, replications, and
    includes as ``received.includes`` refuses them.
    """
    path = Path(path)
    lines = read_lines(path)
    begins = [k for k, line in enumerate(lines) if _BEGIN.match(line)]
    if len(begins) > 1:
        raise ConfigError(f"mesh file {path}:{begins[1] + 1}", "one section of bulk data", lines[begins[1]].strip(),
                          "write the body without superelements and modules")
    first = begins[0] + 1 if begins else 0
    head = [line.strip() for line in lines[:max(first - 1, 0)] if line.strip() and not line.lstrip().startswith("$")]
    return head, _cards(_lines(path, path, (), first))


def _cards(lines):
    current, mark = None, ""
    for where, line in lines:
        name, data, following = _fields(line, where)
        if name[:1] in ("", "+", "*"):
            if current is None:
                raise ConfigError(where, "a card before its continuation", repr(line[:40]))
            own = name.lstrip("+*").strip()
            if own and mark and own != mark:
                raise ConfigError(where, f"the continuation {mark!r} of the line before", repr(own),
                                  "sort the deck: continuations directly after their lines")
            current.fields += data
        else:
            if current is not None:
                yield current
            current = Card(name.rstrip("*_").upper(), where, data)      # meshio writes CHEXA_
        mark = following.lstrip("+*").strip()
    if current is not None:
        yield current


def _fields(line, where):
    """(name or mark of a continuation, data fields, mark of the next line) of a line."""
    head = (line.partition(",")[0] if "," in line else line[:8]).strip()
    width = 16 if "*" in head else 8
    count = _DATA[width]
    if "," in line:
        data = [part.strip() for part in line.split(",")[1:]]
        if len(data) > count + 1 and any(data[count + 1:]):
            raise ConfigError(where, f"at most {count} fields in a line", f"{len(data)}", "write them in several lines")
    else:
        data = [line[k:k + width].strip() for k in range(8, 72, width)] + [line[72:80].strip()]
    data += [""] * (count + 1 - len(data))
    if "=" in head or any(part.startswith(("=", "*(")) for part in data[:count]):
        raise ConfigError(where, "cards that are written out", f"a replication: {line[:40]!r}",
                          "have the preprocessor write all cards")
    return head, data[:count], data[count]


def _lines(path, deck, parents, first=0):
    """Yield (where, line) of the bulk data of a file and of what it includes, without comments, up to ENDDATA."""
    parents, lines = (*parents, path.resolve()), enumerate(read_lines(path)[first:], first + 1)
    for number, line in lines:
        where, text = f"mesh file {path}:{number}", line.partition("$")[0].rstrip().expandtabs(8)
        include = _INCLUDE.match(text)
        if include:
            name = include[1]
            while name[:1] in ("'", '"') and name.count(name[0]) < 2:
                name += "\n" + next(lines, (0, name[0]))[1]
            yield from _lines(opened_in(deck, joined_name(name).strip("'\" "), parents, where), deck, parents)
        elif text.strip().upper() == "ENDDATA":
            return
        elif text.strip():
            yield where, text


def number(text, where):
    """A number of Nastran, whose exponent may stand without its letter: 1.5-3, 2.D+4; ConfigError for others."""
    spelt = re.sub(r"(?<=[\d.])([+-]\d+)$", r"e\1", re.sub("[dD]", "e", text))
    try:
        value = float(spelt)
    except ValueError:
        value = None
    if value is None or not isfinite(value):
        raise ConfigError(where, "a number", repr(text)[:60])
    return value
