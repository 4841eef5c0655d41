"""Which matrices of a file are one triangle of a symmetric matrix, and which are meant as they stand.

A matrix is symmetric where its file says so, or the case does. Programs that write symmetric matrices without saying so
(MATRIX OUTPUT of Abaqus) write their lower triangle; a term of friction has entries on one side by nature, since normal
motion makes forces along the surface and not the other way round.
"""

import numpy as np
import scipy

from pipeline.contract import ConfigError

SYMMETRIC, GENERAL = "symmetric", "general"
#: rounding in a_ij^2 <= a_ii a_jj of a symmetric matrix without negative eigenvalues
_ROUNDING = 1e-6


def one_sided(matrix):
    """Whether a sparse ``matrix`` (n, n) has entries beside its diagonal, and none that stands opposite another."""
    beside = _beside(matrix)
    return bool(beside.nnz) and not beside.multiply(beside.T).nnz


def as_meant(entries, kind, term, friction, size, where):
    """(Entries as the file or the case means them, remark on what was guessed or "").

    ``entries``: of a Term of a ``kind`` whose ``friction`` says that it changes with the coefficient of friction, in a
    system of ``size`` degrees of freedom; ``where``: its place in the case. Raises ConfigError where file and case
    contradict each other, and for entries on one side of the diagonal that may mean either.
    """
    stated, place = term.symmetry, f"{where}.symmetry"
    said = entries.form if entries.form != GENERAL else ""
    if stated and said and stated != said:
        raise ConfigError(place, f"{said}, as {term.file.name} says", stated)
    if stated and stated != GENERAL:
        return entries.whole(f"{where}: {term.file.name}", stated), ""
    matrix = entries.matrix()
    if stated or said or not one_sided(matrix):
        return entries, ""
    likely = _may_be_half(matrix, entries.label)
    if friction and kind != "mass" and not likely:
        return entries, (f"{where}: {term.file.name} has entries on one side of its diagonal and is taken as it stands;"
                         " 'symmetry: symmetric' adds the other side")
    if entries.halves and likely and not friction and _lower(matrix, entries.label) and (
            kind == "mass" or _covers(matrix, entries.label, size)):
        return entries.whole(where, SYMMETRIC), (
            f"{where}: {term.file.name} holds the lower triangle of a matrix and was read as half of a symmetric one,"
            " as Abaqus writes it; 'symmetry: general' takes it as it stands")
    raise ConfigError(place, "symmetric, skew-symmetric or general where a file has entries on one side of the"
                      f" diagonal alone, as {term.file.name} has", "none",
                      "write 'symmetry: symmetric' if it is one triangle of a symmetric matrix" + (
                          "" if kind == "mass" else ", 'skew-symmetric' for one of a gyroscopic matrix, 'general' if it"
                          " is meant as it stands"))


def _beside(matrix):
    """What stands beside the diagonal, without zeros."""
    beside = scipy.sparse.csr_matrix(matrix - scipy.sparse.diags(matrix.diagonal(), format="csr"))
    beside.eliminate_zeros()
    return beside


def _internal(label, size):
    """(n,) whether each row is one that the program added, a node below 0."""
    return np.zeros(size, bool) if label is None else label[:, 0] < 0


def _outer(matrix, label):
    """(row, column, value) of what stands beside the diagonal, without the rows and columns that a program added."""
    held, internal = _beside(matrix).tocoo(), _internal(label, matrix.shape[0])
    kept = ~(internal[held.row] | internal[held.col])
    return held.row[kept], held.col[kept], held.data[kept]


def _may_be_half(matrix, label):
    """Whether it can be one triangle of a symmetric matrix without negative eigenvalues: a_ij^2 <= a_ii a_jj."""
    row, column, value = _outer(matrix, label)
    diagonal = matrix.diagonal()
    fits = (diagonal[row] > 0) & (diagonal[column] > 0) & (
        abs(value) <= (1 + _ROUNDING) * np.sqrt(abs(diagonal[row])) * np.sqrt(abs(diagonal[column])))
    return bool(fits.all())


def _lower(matrix, label):
    row, column, _ = _outer(matrix, label)
    return bool((row > column).all())


def _covers(matrix, label, size):
    """Whether every degree of freedom of the system, of ``size``, has an entry above 0 on its diagonal."""
    return bool((matrix.diagonal() > 0)[~_internal(label, matrix.shape[0])].all()) and matrix.shape[0] == size
