"""Entries of a sparse matrix as a file gives them."""

from dataclasses import dataclass, replace

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError

#: forms of a matrix, in the words of Matrix Market
SYMMETRIC, SKEW, GENERAL = "symmetric", "skew-symmetric", "general"
#: rows at most: what has more is damaged, or no matrix of a model
_MOST_ROWS = 50_000_000
#: what stands on both sides of the diagonal is the same to this share of the largest entry beside it
_SAME = 1e-8


@dataclass(frozen=True)
class Entries:
    """Entries (e,) of an (n, n) matrix, summed where one place stands twice; ``label`` (n, 2) node and direction of
    each row, or None where rows are merely counted.

    ``form``: symmetric, skew-symmetric (then all entries are here) or general where the file says so, else "".
    ``halves``: programs write symmetric matrices to such files as one triangle without saying so.
    """

    row: np.ndarray
    column: np.ndarray
    value: np.ndarray
    size: int
    label: np.ndarray | None = None
    form: str = ""
    halves: bool = False

    def matrix(self):
        """The (n, n) sparse matrix."""
        return scipy.sparse.coo_matrix((self.value, (self.row, self.column)), (self.size, self.size)).tocsr()

    def whole(self, where, form):
        """The Entries of a symmetric or skew-symmetric matrix (``form``), of which one side of the diagonal will do.

        Raises ConfigError, at ``where``, if entries on both sides, or on the diagonal, are not those of this form.
        """
        sign = -1 if form == SKEW else 1
        matrix = self.matrix()
        if form == SKEW and matrix.diagonal().any():
            at = int(abs(matrix.diagonal()).argmax())
            raise ConfigError(where, "a skew-symmetric matrix, whose diagonal is 0",
                              f"{matrix.diagonal()[at]:g} on the diagonal, {self.place(at)}")
        held = matrix.tocoo()
        beside = (held.row != held.col) & (held.data != 0)
        row, column, value = (each[beside].astype(kind) for each, kind in
                              ((held.row, np.int64), (held.col, np.int64), (held.data, float)))
        if not np.isin(column * self.size + row, row * self.size + column).any():
            added = ((self.row, column), (self.column, row), (self.value, sign * value))
            row, column, value = (np.concatenate(each) for each in added)
            return replace(self, row=row, column=column, value=value, form=form)
        partner = np.asarray(matrix[column, row]).ravel()
        apart, least = abs(value - sign * partner), _SAME * abs(value).max()
        if apart.max() > least:
            opposed = apart * (partner != 0)
            k = int((opposed if opposed.max() > least else apart).argmax())
            i, j = int(row[k]), int(column[k])
            raise ConfigError(where, f"a {form} matrix: one side of its diagonal, or both with the same entries",
                              f"{matrix[i, j]:g} and {matrix[j, i]:g} at {self.place(i)} and {self.place(j)}",
                              f"say that it is {GENERAL} if it is")
        return replace(self, form=form)

    def place(self, index):
        """Which degree of freedom a row is, in words."""
        return named(self.label, index)


def named(label, index):
    """Node and direction of the row ``index`` by ``label`` (n, 2), or its number, from 1, without labels."""
    if label is None or not len(label):
        return f"row {index + 1}"
    return "node {} direction {}".format(*label[index])


def sound(path, entries):
    """The Entries, checked: real and finite, at least one, of a size that a model can have; ConfigError for others."""
    value = np.asarray(entries.value)
    if np.iscomplexobj(value) and not np.any(value.imag):
        value = value.real
    if value.dtype.kind not in "fiu" or not np.isfinite(value).all():
        raise ConfigError(path, "finite real entries", "complex ones" if np.iscomplexobj(value) else "others")
    if not 0 < entries.size <= _MOST_ROWS or not len(value):
        raise ConfigError(path, f"1 to {_MOST_ROWS} rows with an entry", f"{entries.size} rows, {len(value)} entries")
    return replace(entries, row=np.asarray(entries.row, np.int64), column=np.asarray(entries.column, np.int64),
                   value=value.astype(float), size=int(entries.size))
