"""Matrices of Abaqus and Nastran, whose rows are labelled by node and direction."""

import re
from dataclasses import replace

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.decks.entries import GENERAL, SYMMETRIC, Entries, sound
from pipeline.decks.meshes.nastran_cards import number

#: forms of a matrix in the head of a DMIG, and its types of complex numbers
_SQUARE, _SYMMETRIC, _COMPLEX = "1", "6", ("3", "4")
_TYPE = re.compile(r"\*\s*MATRIX\s+INPUT\b.*\bTYPE\s*=\s*(\w+)", re.IGNORECASE)


def abaqus(path):
    """Entries of lines 'node, direction, node, direction, value' (MATRIX INPUT) or 'row column value' (COORDINATE).

    Nodes below 0 are those that Abaqus adds, such as Lagrange multipliers. A keyword line MATRIX INPUT with its TYPE
    says whether a matrix is symmetric. Raises ConfigError for other lines.
    """
    numbered = [(count, line.strip()) for count, line in enumerate(path.read_text().splitlines(), 1) if line.strip()]
    lines = [(count, re.split(r"[,\s]+", line.rstrip(", "))) for count, line in numbered if not line.startswith("*")]
    width = len(lines[0][1]) if lines else 0
    ragged = next((count for count, line in lines if len(line) != width), None)
    if width not in (3, 5) or ragged is not None:
        raise ConfigError(path if ragged is None else f"{path}:{ragged}", "lines of 3 numbers (row, column, value) or 5"
                          " (node, direction, twice, and value)",
                          f"{width or 'none'}" if ragged is None else "another number of them, or both kinds",
                          "write it with FORMAT=MATRIX INPUT or FORMAT=COORDINATE")
    table = _numbers(path, lines)
    labels = table[:, :-1].astype(np.int64)
    strange = (labels != table[:, :-1]).any(axis=1) | (width == 3) * (labels < 1).any(axis=1)
    if strange.any():
        raise ConfigError(f"{path}:{lines[strange.argmax()][0]}", "whole numbers of nodes and directions" if width == 5
                          else "rows and columns from 1 on", " ".join(lines[strange.argmax()][1][:-1]))
    if width == 5:
        found = _labelled(path, labels[:, :2], labels[:, 2:], table[:, 4])
    else:
        found = sound(path, Entries(labels[:, 0] - 1, labels[:, 1] - 1, table[:, 2], int(labels.max())))
    stated = {match[1].upper() for _, line in numbered if (match := _TYPE.match(line))}
    if stated == {"SYMMETRIC"}:
        return found.whole(path, SYMMETRIC)
    return replace(found, form=GENERAL if stated else "", halves=not stated)


def _numbers(path, lines):
    """Table of ``lines`` (number, fields), whose exponents may be those of Fortran."""
    try:
        return np.array([line for _, line in lines], float)
    except ValueError:
        spelt = ((f"{path}:{count}", [re.sub("[dD]", "e", field) for field in line]) for count, line in lines)
        return np.array([[_number(field, where) for field in line] for where, line in spelt])


def _number(field, where):
    try:
        return float(field)
    except ValueError:
        raise ConfigError(where, "a number", repr(field)) from None


def nastran(path, name=None):
    """Entries of the matrix ``name`` among the DMIG of a punch file; None: the only one.

    Raises ConfigError where there is none or several, for one that is not square, and for an entry that is no real
    number.
    """
    forms, columns, here = {}, {}, None
    for count, line in enumerate(path.read_text().splitlines(), 1):
        fields = _fields(line)
        if fields[0] == "DMIG" and len(fields) > 3 and fields[2] == "0":
            forms[fields[1]], here = (fields[3], "".join(fields[4:5]) in _COMPLEX), None
        elif fields[0] == "DMIG" and len(fields) > 3:
            here = (columns.setdefault(fields[1], []), _label(fields[2:4], path, count),
                    forms.get(fields[1], ("", False))[1])
            _entries(fields[5:], *here, path, count)
        elif here and fields[0] in ("*", "+", ""):
            _entries(fields[1:], *here, path, count)
    wanted = name or (next(iter(forms)) if len(forms) == 1 else None)
    if wanted not in forms or wanted not in columns:
        raise ConfigError(path, "the name of a matrix with entries as 'variable'", ", ".join(forms) or "no DMIG")
    form = forms[wanted][0]
    if form not in (_SYMMETRIC, _SQUARE):
        raise ConfigError(path, f"{wanted} of the form {_SQUARE} (square) or {_SYMMETRIC} (symmetric)", repr(form))
    found = _labelled(path, *(np.array(part) for part in zip(*columns[wanted], strict=True)))
    return found.whole(path, SYMMETRIC) if form == _SYMMETRIC else replace(found, form=GENERAL)


def _entries(fields, kept, column, is_complex, path, line):
    """Append (row, column, value) of each group 'node, direction, real, imaginary' of ``fields``."""
    where = f"{path}:{line}"
    for k in range(0, len(fields) - 2, 4):
        if fields[k]:
            kept.append((_label(fields[k:k + 2], path, line), column, number(fields[k + 2], where)))
            if is_complex and "".join(fields[k + 3:k + 4]) and number(fields[k + 3], where):
                raise ConfigError(where, "real entries", f"an imaginary part, {fields[k + 3]}",
                                  "write it as a matrix of its own, and name it under 'loss'")


def _label(fields, path, line):
    if not all(field.isdigit() for field in fields if field):
        raise ConfigError(f"{path}:{line}", "a node and a direction", repr(" ".join(fields)))
    return int(fields[0] or 0), int(fields[1] or 0)


def _fields(line):
    """Fields of one line of bulk data, between commas or 8 or 16 wide; '*' in the first one marks wide ones."""
    if "," in line:
        parts = [part.strip() for part in line.split(",")]
        return [parts[0].rstrip("*") or parts[0], *parts[1:]]
    head = line[:8].strip()
    width = 16 if "*" in head else 8
    return [head.rstrip("*") or head, *(line[k:k + width].strip() for k in range(8, max(len(line), 9), width))]


def _labelled(path, row, column, value):
    """Entries by labels (e, 2), in the order of nodes and directions."""
    label, index = np.unique(np.concatenate((row, column)), axis=0, return_inverse=True)
    index = index.reshape(-1)
    return sound(path, Entries(index[:len(row)], index[len(row):], value, len(label), label))
