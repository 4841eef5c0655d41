"""Sparse matrices that other programs wrote: MATLAB, Matrix Market, NumPy, Abaqus, Nastran.

Programs that number degrees of freedom by node and direction (Abaqus, Nastran) give labels; the others count rows.
"""

import gzip
import io
import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.contract.received.process import answered
from pipeline.decks.entries import GENERAL, SKEW, SYMMETRIC, Entries, sound
from pipeline.decks.labelled_matrices import abaqus, nastran

_READERS = "a .mat (up to version 7), .mtx, .mtx.gz or .npz file, an .mtx of Abaqus, or a .pch with DMIG of Nastran"
_MARKET = b"%%matrixmarket"
#: head of a file of Matrix Market, in any case: format, field and form
_HEAD = re.compile(rb"%%MatrixMarket\s+matrix\s+(coordinate|array)\s+(\S+)\s+(\S+)\s*", re.IGNORECASE)
_EXPONENTS = bytes.maketrans(b"dD", b"eE")
_NAMES, _ENTRIES = "names.json", "entries.npz"


def read(path, variable=None):
    """Entries of the matrix in the file at ``path``; ``variable``: its name there, where the file holds several.

    Raises ConfigError for a file that is damaged or holds no matrix, several, or one that is not square, real, finite.
    """
    return answered("pipeline.decks.matrix_files:leave", path, _collected, variable=variable)


def leave(path, folder, variable=None):
    """In the child process: read the file and leave its entries in ``folder``."""
    found = _opened(Path(path), variable)
    extra = {} if found.label is None else {"label": found.label}
    np.savez(Path(folder) / _ENTRIES, row=found.row, column=found.column, value=found.value, **extra)
    (Path(folder) / _NAMES).write_text(json.dumps({"size": found.size, "form": found.form, "halves": found.halves}))


def _collected(folder):
    about = json.loads((folder / _NAMES).read_text())
    with np.load(folder / _ENTRIES) as held:
        return Entries(held["row"], held["column"], held["value"], label=held.get("label"), **about)


def _opened(path, variable):
    suffix = "".join(path.suffixes[-2:]) if path.suffix == ".gz" else path.suffix
    if suffix == ".mat":
        return _of_matrix(path, _chosen(path, scipy.io.loadmat(path), variable))
    if suffix == ".npz":
        return _of_matrix(path, _npz(path, variable))
    if suffix in (".mtx", ".mtx.gz"):
        with path.open("rb") as file:
            plain = suffix == ".mtx" and file.read(len(_MARKET)).lower() != _MARKET
        return abaqus(path) if plain else _market(path)
    if suffix == ".pch":
        return nastran(path, variable)
    raise ConfigError(path, _READERS, repr(suffix))


def _market(path):
    """Entries of a file of Matrix Market, of which one triangle is there if its head says that it is symmetric.

    Its exponents may be those of Fortran, which SciPy would pass over.
    """
    with (gzip.open if path.suffix == ".gz" else open)(path, "rb") as file:
        head, content = file.readline(), file.read()
    said = _HEAD.match(head)
    if not said:
        raise ConfigError(path, "a head '%%MatrixMarket matrix' with coordinate or array, field and form",
                          repr(head[:60].decode(errors="replace")))
    layout, field, form = (each.decode().lower() for each in said.groups())
    if field == "pattern":
        raise ConfigError(path, "entries with values", "a head that says 'pattern'")
    form = SYMMETRIC if form == "hermitian" and field != "complex" else form
    given = form if layout == "array" or form not in (SYMMETRIC, SKEW) else GENERAL
    head = f"%%MatrixMarket matrix {layout} {field} {given}\n".encode()
    found = _of_matrix(path, scipy.io.mmread(io.BytesIO(head + content.translate(_EXPONENTS))))
    if form in (SYMMETRIC, SKEW):
        return found.whole(path, form)
    return replace(found, form=GENERAL if form == GENERAL else SYMMETRIC)


def _npz(path, variable):
    with np.load(path, allow_pickle=False) as held:
        if "format" in held and "shape" in held:
            return scipy.sparse.load_npz(path)
        return _chosen(path, dict(held), variable)


def _chosen(path, held, variable):
    """The one matrix among the variables ``held`` {name: array}, or the one that is named."""
    names = [name for name, value in held.items() if not name.startswith("__") and getattr(value, "ndim", 0) == 2
             and min(value.shape) > 1]
    if variable is None and len(names) == 1:
        return held[names[0]]
    if variable not in names:
        raise ConfigError(path, f"the matrix {variable!r}" if variable else "one matrix, or its name as 'variable'",
                          ", ".join(names) or "none")
    return held[variable]


def _of_matrix(path, matrix):
    """Entries of a dense or sparse matrix."""
    entries = scipy.sparse.coo_matrix(matrix)
    if entries.shape[0] != entries.shape[1]:
        raise ConfigError(path, "a square matrix", f"{entries.shape[0]} x {entries.shape[1]}")
    return sound(path, Entries(entries.row, entries.col, entries.data, entries.shape[0]))
