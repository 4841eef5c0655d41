"""Blocks of an Abaqus or CalculiX deck: a keyword with its parameters, and the lines of data below it."""

import re
from dataclasses import dataclass, field
from math import isfinite
from pathlib import Path

from pipeline.contract.errors import ConfigError
from pipeline.contract.received.includes import opened_in, read_lines

#: a part of a keyword line: to the next comma that no quotation marks enclose
_PART = re.compile(r'(?:[^,"]|"[^"]*"?)+')
#: keywords whose data may come from the file that their INPUT names
_WITH_INPUT = ("INCLUDE", "NODE", "ELEMENT", "NSET", "ELSET", "SURFACE")


@dataclass
class Block:
    """``name`` in capitals, ``given`` {PARAMETER: value}, ``rows`` [(where, fields)]; ``where``: 'file:line'."""

    name: str
    given: dict
    where: str
    rows: list = field(default_factory=list)

    def need(self, parameter):
        """The value of a parameter; ConfigError where it is missing."""
        if not self.given.get(parameter):
            raise ConfigError(self.where, f"*{self.name} with {parameter}=", "none")
        return self.given[parameter]


def blocks(path):
    """Yield the Blocks of the deck at ``path``, what it includes laid in.

    Raises ConfigError for data before the first keyword, and includes as ``received.includes`` refuses them.
    """
    path, current = Path(path), None
    lines = _lines(path, path, ())
    for where, line in lines:
        if not line.startswith("*"):
            if current is None:
                raise ConfigError(where, "a keyword such as *NODE", repr(line[:60]),
                                  "check that this is a deck of Abaqus or CalculiX")
            current.rows.append((where, [part.strip() for part in line.split(",")]))
            continue
        while line.endswith(","):
            line += next(lines, (where, "*"))[1]
        if current is not None:
            yield current
        current = _keyword(line, where)
    if current is not None:
        yield current


def _lines(path, deck, parents):
    """Yield (where, line) of a file and of those that it includes, without comments and empty lines."""
    parents = (*parents, path.resolve())
    for number, line in enumerate(read_lines(path), 1):
        line, where = line.strip(), f"mesh file {path}:{number}"
        if not line or line.startswith("**"):
            continue
        block = _keyword(line, where) if line.startswith("*") else None
        if block is None or block.name != "INCLUDE":
            yield where, line
        if block and block.name in _WITH_INPUT and (block.name == "INCLUDE" or "INPUT" in block.given):
            yield from _lines(opened_in(deck, block.need("INPUT"), parents, where), deck, parents)


def _keyword(line, where):
    name, *parts = (part.strip() for part in _PART.findall(line[1:]) or [""])
    pairs = (part.partition("=") for part in parts if part)
    return Block(" ".join(name.upper().split()), {" ".join(key.upper().split()): value.strip().strip('"')
                                                  for key, _, value in pairs}, where)


def number(text, where, default=None):
    """A number of a field, 1.5D+3 as well; ``default`` for an empty one. Raises ConfigError for others."""
    if not text and default is not None:
        return default
    try:
        value = float(text.upper().replace("D", "E"))
    except ValueError:
        value = None
    if value is None or not isfinite(value):
        raise ConfigError(where, "a number", repr(text)[:60])
    return value


def numbers(rows, least, name):
    """Numbers of ``rows`` of a Block in one list, empty fields left out; ConfigError for fewer than ``least``."""
    values = [number(text, where) for where, fields in rows for text in fields if text]
    if len(values) < least:
        raise ConfigError(rows[0][0] if rows else name, f"{least} numbers of *{name}", f"{len(values)}")
    return values
