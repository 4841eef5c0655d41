"""Lowest natural modes of large undamped structures: shift-invert Lanczos with a completeness check."""

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.numerics.sparse_solver import factorise

#: largest accepted error of an eigenvalue of the shifted problem, relative
_TOLERANCE = 1e-7
#: automatic shift: share of the frequency limit, or of the largest ratio of stiffness and mass diagonals
_LIMIT_SHARE, _DIAGONAL_SHARE = 0.1, 1e-6
#: modes sought beyond those counted
_SPARE = 2
#: below this size, dense
_DENSE = 400
_BLOCK = 8
#: most Lanczos vectors per mode
_LONGEST = 8
_CHECK_EVERY = 4
_LANCZOS_TOLERANCE = 1e-10


def lowest_modes(stiffness, mass, solver, count=None, below=None, shift=None):
    """Modes of K x = (2 pi f)^2 M x, lowest first; a free body keeps its six rigid modes at 0 Hz.

    Parameters
    ----------
    stiffness, mass : (n, n) sparse symmetric [N/m, kg]; ``mass`` positive definite
    solver : "pypardiso" or "superlu"
    count : number of modes, or
    below : frequency [Hz] below which all modes are wanted
    shift : the factorised matrix is K + (2 pi shift)^2 M [Hz]; chosen by itself by default

    Returns
    -------
    frequency : (m,) array [Hz], ascending
    shape : (n, m) array [1/kg^0.5], mass-normalised, largest component positive

    Start vectors are seeded: the same matrices give the same bits. With ``below``, the number of
    modes is checked by the inertia of K - (2 pi below)^2 M (Sylvester). Raises ConvergenceError
    for modes that miss their equation or their number.
    """
    if (count is None) == (below is None):
        raise ConfigError("lowest_modes", "either count or below", f"count = {count}, below = {below}")
    wanted = count if below is None else _modes_below(stiffness, mass, solver, below)
    if wanted is not None and wanted > stiffness.shape[0]:
        raise ConfigError("lowest_modes", f"at most {stiffness.shape[0]} modes", str(wanted))
    offset = _offset(stiffness, mass, below) if shift is None else (2 * np.pi * shift)**2
    square, shape = _solve(stiffness, mass, solver, wanted + _SPARE * (below is not None), offset)
    frequency = np.sqrt(np.maximum(square, 0)) / (2 * np.pi)
    if below is not None:
        kept = frequency < below
        if kept.sum() != wanted:
            raise ConvergenceError("lowest_modes", f"{wanted} modes below {below:g} Hz (inertia)", str(kept.sum()),
                                   "change the frequency limit a little")
        frequency, shape = frequency[kept], shape[:, kept]
    largest = shape[np.argmax(np.abs(shape), axis=0), np.arange(shape.shape[1])]
    return frequency, shape * np.sign(largest)


def slopes(frequency, shape, before, after):
    """(m,) change of ln f from matrices (K, M) ``before`` to those ``after``, first order: x.(dK - w^2 dM) x / (2 w^2).

    ``frequency`` (m,) Hz above 0 and mass-normalised ``shape`` (n, m) are those before, or between both. Shapes that
    stay while nodes move strain thin walls by the square of the change, which their bending frequencies would show:
    changes to either side of the modes cancel it. Of modes of one frequency single changes depend on the mixture that
    stands for them, their mean does not.
    """
    square = (2 * np.pi * frequency)**2
    pulled, carried = (np.einsum("nm,nm->m", shape, (new - old) @ shape)
                       for old, new in zip(before, after, strict=True))
    return (pulled - square * carried) / (2 * square)


def _modes_below(stiffness, mass, solver, below):
    negative = factorise(stiffness - (2 * np.pi * below)**2 * mass, solver).negative
    if negative is None:
        raise ConvergenceError("lowest_modes", "a factor without row exchanges to count modes", "exchanges",
                               "change the frequency limit a little, or use the solver pypardiso")
    return negative


def _offset(stiffness, mass, below):
    if below is not None:
        return (2 * np.pi * _LIMIT_SHARE * below)**2
    return _DIAGONAL_SHARE * (stiffness.diagonal() / mass.diagonal()).max()


def _solve(stiffness, mass, solver, count, offset):
    """(m,) squared angular frequencies, ascending, and (n, m) shapes."""
    size = stiffness.shape[0]
    if count == 0:
        return np.zeros(0), np.zeros((size, 0))
    if size < _DENSE or count > size // 8:
        square, shape = scipy.linalg.eigh(stiffness.toarray(), mass.toarray())
        return square[:count], shape[:, :count]
    factor = factorise(stiffness + offset * mass, solver)
    shifted, shape = _lanczos(factor, mass, count)
    _refuse_inaccurate(factor, mass, shifted, shape)
    return shifted - offset, shape


def _lanczos(factor, mass, count):
    """Smallest ``count`` eigenvalues of (A, M) and their vectors; ``factor`` solves with A.

    Block Lanczos on A^-1 M with full reorthogonalisation in the mass norm (Grimes, Lewis and
    Simon 1994, without restart): whole blocks keep double modes together and solve several
    right-hand sides at once.
    """
    size, most = mass.shape[0], min(_LONGEST * count + 20 * _BLOCK, mass.shape[0] // 2)
    basis, inertia = (np.empty((size, most + _BLOCK), order="F") for _ in range(2))
    inverse = np.zeros((most + _BLOCK, most + _BLOCK))
    start = factor.solve(mass @ np.random.default_rng(0).standard_normal((size, _BLOCK)))
    basis[:, :_BLOCK], inertia[:, :_BLOCK], _ = _orthonormal(start, mass)
    for done in range(_BLOCK, most + 1, _BLOCK):
        now, after = slice(done - _BLOCK, done), slice(done, done + _BLOCK)
        recent = slice(max(done - 2 * _BLOCK, 0), done)
        image = factor.solve(inertia[:, now])
        inverse[recent, now] = inertia[:, recent].T @ image
        image -= basis[:, recent] @ inverse[recent, now]
        image -= basis[:, :done] @ (inertia[:, :done].T @ image)
        basis[:, after], inertia[:, after], rest = _orthonormal(image, mass)
        if done >= count and (done - count) // _BLOCK % _CHECK_EVERY == 0:
            value, vector = scipy.linalg.eigh(inverse[:done, :done], subset_by_index=(done - count, done - 1),
                                              lower=False)
            error = np.linalg.norm(rest @ vector[-_BLOCK:], axis=0) / value
            if error.max() < _LANCZOS_TOLERANCE:
                return 1 / value[::-1], basis[:, :done] @ vector[:, ::-1]
    raise ConvergenceError("lowest_modes", f"{count} modes within {most} Lanczos vectors", "less",
                           "change the shift or ask for fewer modes")


def _orthonormal(block, mass):
    """Mass-orthonormal basis Q of the columns, M Q, and R with block = Q R; Cholesky twice."""
    inertia, upper = mass @ block, np.eye(block.shape[1])
    for _ in range(2):
        factor = scipy.linalg.cholesky(block.T @ inertia)
        block, inertia = (scipy.linalg.solve_triangular(factor, b.T, trans="T").T for b in (block, inertia))
        upper = factor @ upper
    return block, inertia, upper


def _refuse_inaccurate(factor, mass, shifted, shape):
    """Check (K + s M)^-1 M x = x / (lambda + s) in the mass norm."""
    inertia = mass @ shape
    miss = factor.solve(inertia) * shifted - shape
    error = np.sqrt(np.maximum((miss * (mass @ miss)).sum(axis=0), 0))
    if not error.max() < _TOLERANCE:
        raise ConvergenceError("lowest_modes", f"an error below {_TOLERANCE:g}",
                               f"{error.max():.1e} in mode {int(error.argmax()) + 1}", "change the shift")
