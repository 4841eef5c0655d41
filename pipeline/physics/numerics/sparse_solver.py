"""Direct sparse solvers behind one door: PARDISO of MKL where installed, SuperLU otherwise."""

import ctypes
import os
import sys
import weakref
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.numerics.memory import refuse_beyond_memory

#: matrix types of PARDISO by (complex, symmetric)
_MATRIX_TYPE = {(False, True): -2, (False, False): 11, (True, True): 6, (True, False): 13}
_SEQUENTIAL, _CONDITIONAL_BITS_AUTO = 1, 2      # constants of mkl_service.h
_ANALYSE, _FACTORISE, _SOLVE, _RELEASE = 11, 22, 33, -1
#: kB of PARDISO by its analysis: its peak, what stays of it, the factor (indices of its parameters)
_PEAK, _PERMANENT, _FACTOR = 14, 15, 16
_ADJOINT = 11       # index of the parameter that solves with A^H
#: a factor whose solution misses a seeded right-hand side by more is that of a singular matrix
_SINGULAR = 1e-4
#: a factor without row exchanges, or with few, is kept while it is as good as this, in double or single precision
_ACCURATE, _ACCURATE_SINGLE = 1e-8, 1e-2
#: orders of columns and thresholds of row exchanges that SuperLU tries, by symmetry
_PATTERN = "MMD_AT_PLUS_A"
_ORDERS = {True: ((_PATTERN, 0.0), (_PATTERN, 1.0)), False: ((_PATTERN, 0.01), ("COLAMD", 1.0))}


@dataclass(frozen=True)
class Upper:
    """A = A^T (n, n) by its upper triangle ``part``, a sparse matrix by rows."""

    part: "scipy.sparse.csr_matrix"

    @property
    def shape(self):
        return self.part.shape

    @property
    def dtype(self):
        return self.part.dtype

    def __matmul__(self, vector):
        return self.part @ vector + self.part.T @ vector - self.part.diagonal() * vector

    def whole(self):
        """A (n, n), sparse, by rows."""
        return (self.part + self.part.T - scipy.sparse.diags(self.part.diagonal())).tocsr()


def available():
    """Names of the solvers installed here, fastest first."""
    return (*(("pypardiso",) if find_spec("pypardiso") and (_runtime() or _library()) else ()), "superlu")


def factorise(matrix, solver, symmetric=True, single=False):
    """Factorise a sparse matrix once, to solve with it often.

    Parameters
    ----------
    matrix : (n, n) sparse, real or complex, or an Upper
    solver : "pypardiso" or "superlu"
    symmetric : True for A = A^T (indefinite allowed; complex means symmetric, not Hermitian)
    single : True for a factor in single precision, of half the size, whose solutions an iteration improves: they may
        be those of a matrix that differs by rounding, which next to a singular one is far off

    Returns
    -------
    Factor with ``solve(rhs)`` for (n,) and (n, m) right-hand sides, ``solve(rhs, adjoint=True)`` for those of
    A^H x = rhs and, for real symmetric matrices in double precision, ``negative``, the number of negative eigenvalues
    (Sylvester's law of inertia).

    Raises ConvergenceError for a singular matrix, ConfigError for an unknown solver and, with PARDISO, where the factor
    would not fit into the memory that is available, before it is computed.
    """
    if solver not in _BACKENDS:
        raise ConfigError("linear solver", f"one of {', '.join(_BACKENDS)}", repr(solver))
    matrix = _by_rows(matrix)
    stored = matrix.part if isinstance(matrix, Upper) else matrix
    if not np.isfinite(stored.data).all():
        raise ConvergenceError("factorisation", "finite matrix entries", "NaN or infinity")
    if (np.diff(stored.indptr) == 0).any():
        raise _singular(matrix, "an empty row")
    factor = _BACKENDS[solver](matrix, symmetric, single)
    miss = _miss(matrix, factor)
    if not (np.isfinite(miss) if single else miss < _SINGULAR):
        raise _singular(matrix, f"a relative residual of {miss:.1e}")
    return factor


class Successive:
    """Factors in single precision, one at a time, of symmetric matrices, which are put in order once for all that have
    entries at the same places: up to half of the time of a factor."""

    def __init__(self, solver):
        self._solver, self._factor = solver, None

    def factor(self, matrix):
        """That of a ``matrix`` (n, n), sparse or Upper, in the place of the one before; errors as of ``factorise``."""
        if self._factor is None:
            self._factor = factorise(matrix, self._solver, single=True)
        else:
            self._factor = self._factor.of_another(_by_rows(matrix))
        return self._factor

    def forget(self):
        """Let go of the memory of the last one."""
        self._factor = None


def _by_rows(matrix):
    """The matrix, sparse or Upper, by rows in the order of their columns."""
    part = matrix.part if isinstance(matrix, Upper) else matrix
    part = scipy.sparse.csr_matrix(part)
    part.sort_indices()
    return Upper(part) if isinstance(matrix, Upper) else part


class _Factor:
    """Shared handling of right-hand sides; a subclass solves (n, m) arrays of the factor's type."""

    negative = None

    def solve(self, rhs, adjoint=False):
        """x of A x = rhs, or A^H x = rhs, same shape as ``rhs``; complex right-hand sides are welcome."""
        rhs = np.asarray(rhs)
        if np.iscomplexobj(rhs) and self.dtype.kind == "f":
            both = self.solve(np.stack((rhs.real, rhs.imag), axis=-1).reshape(len(rhs), -1), adjoint)
            return (both[:, ::2] + 1j * both[:, 1::2]).reshape(rhs.shape)
        columns = np.asfortranarray(rhs.reshape(len(rhs), -1), dtype=self.dtype)
        return self._solve(columns, adjoint).reshape(rhs.shape)


def _kind(matrix, single):
    """Type of the numbers of a factor."""
    double, half = (complex, np.complex64) if matrix.dtype.kind == "c" else (float, np.float32)
    return np.dtype(half if single else double)


class _SuperLU(_Factor):
    """Symmetric matrices are first tried without row exchanges, which keeps the inertia readable; others with few of
    them in the order of a symmetric pattern, which those of bodies in contact nearly have."""

    def __init__(self, matrix, symmetric, single):
        self.dtype, self._symmetric, self._single = _kind(matrix, single), symmetric, single
        columns = (matrix.whole() if isinstance(matrix, Upper) else matrix).astype(self.dtype).tocsc()
        for order, threshold in _ORDERS[symmetric]:
            self._factor = _lu(columns, order, threshold)
            if _miss(matrix, self) < (_ACCURATE_SINGLE if single else _ACCURATE):
                break
        if symmetric and self.dtype == np.float64:
            self.negative = self._inertia()

    def of_another(self, matrix):
        return _SuperLU(matrix, self._symmetric, self._single)

    def _inertia(self):
        """Negative pivots; they are those of an L D L^T only while no row was exchanged."""
        if not np.array_equal(self._factor.perm_r, self._factor.perm_c):
            return None
        return int((self._factor.U.diagonal() < 0).sum())

    def _solve(self, columns, adjoint):
        return self._factor.solve(columns, "H" if adjoint else "N")


def _lu(columns, order, threshold):
    try:
        return scipy.sparse.linalg.splu(columns, permc_spec=order, diag_pivot_thresh=threshold,
                                        options={"SymmetricMode": order == _PATTERN})
    except RuntimeError as error:
        raise _singular(columns, str(error)) from None
    except MemoryError:
        raise ConfigError("memory", f"room for a factor of {columns.shape[0]} degrees of freedom", "less",
                          "use fewer workers, a coarser mesh or the solver pypardiso") from None


class _Pardiso(_Factor):
    """Rows of unsymmetric matrices are matched with columns of large entries first, which takes three times as long as
    the order of columns; a factor in single precision, whose solutions an iteration improves, does without if it can.
    """

    def __init__(self, matrix, symmetric, single):
        self.dtype, self._symmetric = _kind(matrix, single), symmetric
        stored = (_upper_triangle(matrix) if symmetric else matrix).astype(self.dtype, copy=False)
        if symmetric or not single or not self._does_unmatched(matrix, stored):
            self._make(stored, matching=not symmetric)

    def _does_unmatched(self, matrix, stored):
        try:
            self._make(stored, matching=False)
        except ConvergenceError:
            return False
        done = _miss(matrix, self) < 1
        if not done:
            self._release()
        return done

    def _make(self, stored, matching):
        self._call = _PardisoCall(stored, _MATRIX_TYPE[self.dtype.kind == "c", self._symmetric], matching)
        self._release = weakref.finalize(self, self._call, _RELEASE)
        self._call(_ANALYSE)
        peak, permanent, factor = (1024 * int(self._call.parameter[k]) for k in (_PEAK, _PERMANENT, _FACTOR))
        refuse_beyond_memory(max(peak, permanent + factor), f"a factor of {stored.shape[0]} degrees of freedom")
        self._call(_FACTORISE)
        if self._symmetric and self.dtype == np.float64:
            self.negative = int(self._call.parameter[22])

    def of_another(self, matrix):
        stored, before = _upper_triangle(matrix) if self._symmetric else matrix, self._call.matrix
        if not all(np.array_equal(getattr(stored, name), getattr(before, name)) for name in ("indptr", "indices")):
            self._release()         # its memory goes before that of the next
            return _Pardiso(matrix, self._symmetric, self.dtype in (np.float32, np.complex64))
        self._call.matrix = stored.astype(self.dtype, copy=False)
        self._call(_FACTORISE)
        return self

    def _solve(self, columns, adjoint):
        self._call.parameter[_ADJOINT] = int(adjoint)
        return self._call(_SOLVE, columns)


def _upper_triangle(matrix):
    """Upper triangle in CSR of a matrix, sparse or Upper, of rows none of which is empty, with every diagonal entry
    stored, zero or not, as PARDISO wants it."""
    upper = matrix.part if isinstance(matrix, Upper) else _upper_part(matrix)
    rows = _rows(upper)
    lacking = np.setdiff1d(np.arange(upper.shape[0]), rows[upper.indices == rows], assume_unique=True)
    if not len(lacking):
        return upper
    upper = upper.tocoo()
    rows, columns = np.r_[upper.row, lacking], np.r_[upper.col, lacking]
    return scipy.sparse.csr_matrix((np.r_[upper.data, 0 * lacking], (rows, columns)), matrix.shape)


def _upper_part(matrix):
    kept = matrix.indices >= _rows(matrix)
    counts = np.add.reduceat(kept, matrix.indptr[:-1], dtype=matrix.indptr.dtype)
    return scipy.sparse.csr_matrix((matrix.data[kept], matrix.indices[kept], np.concatenate(([0], np.cumsum(counts)))),
                                   matrix.shape)


def _rows(matrix):
    """Row (nnz,) of each entry of a matrix by rows."""
    return np.repeat(np.arange(matrix.shape[0], dtype=matrix.indices.dtype), np.diff(matrix.indptr))


class _PardisoCall:
    """One handle of PARDISO with the matrix it needs at every call."""

    def __init__(self, matrix, kind, matching):
        self.matrix, self.kind = matrix, ctypes.c_int32(kind)
        self.handle = np.zeros(64, np.int64)
        self.rows = matrix.indptr.astype(np.int32) + 1
        self.columns = matrix.indices.astype(np.int32) + 1
        self.parameter = np.zeros(64, np.int32)
        self.parameter[[0, 1, 9, 20]] = 1, 2, 8, 1     # own values, nested dissection, pivot 1e-8, 2 x 2 pivots
        self.parameter[27] = matrix.dtype in (np.float32, np.complex64)
        if kind in (11, 13):
            self.parameter[[9, 10, 12]] = 13, matching, matching      # pivot 1e-13, scaling
        # parameter[7] = 0: no iterative refinement unless pivots had to be perturbed

    def __call__(self, phase, rhs=None):
        rhs = np.zeros((len(self.rows) - 1, 1), self.matrix.dtype, order="F") if rhs is None else rhs
        result, error = np.zeros_like(rhs, order="F"), ctypes.c_int32(0)
        arrays = (self.matrix.data, self.rows, self.columns, np.zeros(1, np.int32))
        integer = [ctypes.byref(ctypes.c_int32(i)) for i in (1, 1, phase, len(rhs), rhs.shape[1], 0)]
        maxfct, mnum, phase_, size, width, quiet = integer
        data, rows, columns, permutation = (_pointer(a) for a in arrays)
        _library().pardiso(_pointer(self.handle), maxfct, mnum, ctypes.byref(self.kind), phase_, size, data, rows,
                           columns, permutation, width, _pointer(self.parameter), quiet, _pointer(rhs),
                           _pointer(result), ctypes.byref(error))
        if error.value:
            raise ConvergenceError("factorisation by PARDISO", "a regular matrix that fits into memory",
                                   f"error {error.value}",
                                   "support the body or shift the matrix" if error.value in (-4, -7) else None)
        return result


def _pointer(array):
    return array.ctypes.data_as(ctypes.c_void_p)


@cache
def _runtime():
    """The file of MKL where its wheel puts it, or None: a look at start, without loading it."""
    return max((Path(sys.prefix) / "lib").glob("libmkl_rt.*"), default=None)


@cache
def _library():
    """MKL, told to run one thread and the same instructions at every call; None where it cannot load."""
    if _runtime():      # pypardiso would look through the whole environment for it
        os.environ.setdefault("PYPARDISO_MKL_RT", str(_runtime()))
    try:
        from pypardiso.scipy_aliases import pypardiso_solver
    except (ImportError, OSError):
        return None
    library = pypardiso_solver.libmkl
    library.MKL_Set_Threading_Layer(_SEQUENTIAL)
    library.MKL_CBWR_Set(_CONDITIONAL_BITS_AUTO)
    library.pardiso.argtypes, library.pardiso.restype = [ctypes.c_void_p] * 16, None
    return library


def _miss(matrix, factor):
    """Relative residual of one seeded right-hand side."""
    probe = np.random.default_rng(1).standard_normal(matrix.shape[0])
    return np.linalg.norm(matrix @ factor.solve(probe) - probe) / np.linalg.norm(probe)


def _singular(matrix, actual):
    return ConvergenceError(f"factorisation of a {matrix.shape[0]} x {matrix.shape[1]} matrix", "a regular matrix",
                            actual, "support the body, or shift the matrix")


_BACKENDS = {"pypardiso": _Pardiso, "superlu": _SuperLU}
