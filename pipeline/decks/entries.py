"""Entries of a sparse matrix as a file gives them."""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError

#: rows at most: what has more is damaged, or no matrix of a model
_MOST_ROWS = 50_000_000


@dataclass(frozen=True)
class Entries:
    """Entries (e,) of an (n, n) matrix, summed where one place stands twice; ``label`` (n, 2) node and direction of
    each row, or None where rows are merely counted; ``halved``: of a symmetric matrix one triangle was given."""

    row: np.ndarray
    column: np.ndarray
    value: np.ndarray
    size: int
    label: np.ndarray | None = None
    halved: bool = False

    def matrix(self):
        """The (n, n) sparse matrix."""
        return scipy.sparse.coo_matrix((self.value, (self.row, self.column)), (self.size, self.size)).tocsr()


def sound(path, entries):
    """The Entries, checked: real and finite, at least one, of a size that a model can have; ConfigError for others."""
    value = np.asarray(entries.value)
    if np.iscomplexobj(value) and not np.any(value.imag):
        value = value.real
    if value.dtype.kind not in "fiu" or not np.isfinite(value).all():
        raise ConfigError(path, "finite real entries", "complex ones" if np.iscomplexobj(value) else "others")
    if not 0 < entries.size <= _MOST_ROWS or not len(value):
        raise ConfigError(path, f"1 to {_MOST_ROWS} rows with an entry", f"{entries.size} rows, {len(value)} entries")
    return Entries(np.asarray(entries.row, np.int64), np.asarray(entries.column, np.int64), value.astype(float),
                   int(entries.size), entries.label, entries.halved)
