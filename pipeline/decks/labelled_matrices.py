"""Matrices of Abaqus and Nastran, whose rows are labelled by node and direction."""

import re

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.decks.entries import Entries, sound
from pipeline.decks.meshes.nastran_cards import number

#: form of a symmetric matrix in the head of a DMIG
_SYMMETRIC = "6"


def abaqus(path):
    """Entries of lines 'node, direction, node, direction, value' (MATRIX INPUT) or 'row column value' (COORDINATE).

    Of a matrix of which one triangle alone is there, the other is added. Raises ConfigError for other lines.
    """
    lines = [re.split(r"[,\s]+", line.strip().rstrip(",")) for line in path.read_text().splitlines()
             if line.strip() and not line.lstrip().startswith("*")]
    width = len(lines[0]) if lines else 0
    ragged = next((k for k, line in enumerate(lines) if len(line) != width), None)
    if width not in (3, 5) or ragged is not None:
        raise ConfigError(path, "lines of 3 numbers (row, column, value) or 5 (node, direction, twice, and value)",
                          f"{width or 'no'}" if ragged is None else f"{len(lines[ragged])} in entry {ragged + 1}",
                          "write it with FORMAT=MATRIX INPUT or FORMAT=COORDINATE")
    try:
        table = np.array(lines, float)
    except ValueError as error:
        raise ConfigError(path, "numbers", str(error)) from None
    if width == 5:
        return _labelled(path, table[:, :2].astype(int), table[:, 2:4].astype(int), table[:, 4])
    row, column = (table[:, k].astype(int) - 1 for k in (0, 1))
    if min(row.min(), column.min()) < 0:
        raise ConfigError(path, "rows and columns from 1 on", "others")
    return _whole(path, row, column, table[:, 2], None)


def nastran(path, name=None):
    """Entries of the matrix ``name`` among the DMIG of a punch file; None: the only one.

    Raises ConfigError where there is none or several, and for an entry that is no number.
    """
    forms, columns, here = {}, {}, None
    for count, line in enumerate(path.read_text().splitlines(), 1):
        fields = _fields(line)
        if fields[0] == "DMIG" and len(fields) > 3 and fields[2] == "0":
            forms[fields[1]], here = fields[3], None
        elif fields[0] == "DMIG" and len(fields) > 3:
            here = columns.setdefault(fields[1], []), _label(fields[2:4], path, count)
            _entries(fields[5:], *here, path, count)
        elif here and fields[0] in ("*", "+", ""):
            _entries(fields[1:], *here, path, count)
    wanted = name or (next(iter(forms)) if len(forms) == 1 else None)
    if wanted not in forms or wanted not in columns:
        raise ConfigError(path, "the name of a matrix with entries as 'variable'", ", ".join(forms) or "no DMIG")
    row, column, value = (np.array(part) for part in zip(*columns[wanted], strict=True))
    return _labelled(path, row, column, value, forms[wanted] == _SYMMETRIC)


def _entries(fields, kept, column, path, line):
    """Append (row, column, value) of each group 'node, direction, real, imaginary' of ``fields``."""
    for k in range(0, len(fields) - 2, 4):
        if fields[k]:
            kept.append((_label(fields[k:k + 2], path, line), column, number(fields[k + 2], f"{path}:{line}")))


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


def _labelled(path, row, column, value, halved=None):
    """Entries by labels (e, 2), in the order of nodes and directions."""
    label, index = np.unique(np.concatenate((row, column)), axis=0, return_inverse=True)
    index = index.reshape(-1)
    return _whole(path, index[:len(row)], index[len(row):], value, label, halved)


def _whole(path, row, column, value, label, halved=None):
    """Entries; where one triangle alone is given, of a symmetric matrix, the other is added."""
    if halved is None:
        halved = bool((row != column).any() and ((row >= column).all() or (row <= column).all()))
    if halved:
        off = row != column
        row, column, value = (np.concatenate((a, b[off])) for a, b in ((row, column), (column, row), (value, value)))
    size = len(label) if label is not None else int(max(row.max(initial=-1), column.max(initial=-1))) + 1
    return sound(path, Entries(row, column, value, size, label, bool(halved)))
