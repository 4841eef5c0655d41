"""Lowest natural modes of large undamped structures: shift-invert Lanczos with a completeness check."""

import numpy as np
from scipy.linalg import cholesky, eigh, solve_triangular

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.linear_solver import factorise

#: largest accepted error of an eigenvalue of the shifted problem, relative
_TOLERANCE = 1e-7
#: automatic shift, as a share of the largest ratio of stiffness and mass diagonals
_SHIFT_SHARE = 1e-8
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
    shift : the factorised matrix is K + (2 pi shift)^2 M [Hz]; chosen from the diagonals by default

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
    offset = _offset(stiffness, mass) if shift is None else (2 * np.pi * shift)**2
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


def _modes_below(stiffness, mass, solver, below):
    negative = factorise(stiffness - (2 * np.pi * below)**2 * mass, solver).negative
    if negative is None:
        raise ConvergenceError("lowest_modes", "a factor without row exchanges to count modes", "exchanges",
                               "change the frequency limit a little, or use the solver pypardiso")
    return negative


def _offset(stiffness, mass):
    return _SHIFT_SHARE * (stiffness.diagonal() / mass.diagonal()).max()


def _solve(stiffness, mass, solver, count, offset):
    """(m,) squared angular frequencies, ascending, and (n, m) shapes."""
    size = stiffness.shape[0]
    if count == 0:
        return np.zeros(0), np.zeros((size, 0))
    if size < _DENSE or count > size // 8:
        square, shape = eigh(stiffness.toarray(), mass.toarray())
        return square[:count], shape[:, :count]
    factor = factorise(stiffness + offset * mass, solver)
    shifted, shape = _lanczos(factor, mass, count)
    _refuse_inaccurate(factor, mass, shifted, shape)
    return shifted - offset, shape


def _lanczos(factor, mass, count):
    """Smallest ``count`` eigenvalues of (A, M) and their vectors, A = L D L^T given by its factor.

    Block Lanczos on A^-1 M with full reorthogonalisation in the mass norm (Grimes, Lewis and
    Simon 1994, without restart): whole blocks keep double modes together and solve several
    right-hand sides at once.
    """
    size, most = mass.shape[0], min(_LONGEST * count + 20 * _BLOCK, mass.shape[0] // 2)
    basis = np.empty((size, most + _BLOCK), order="F")
    inverse = np.zeros((most, most))
    start = np.random.default_rng(0).standard_normal((size, _BLOCK))
    basis[:, :_BLOCK], _ = _orthonormal(factor.solve(mass @ start), mass)
    for done in range(_BLOCK, most + 1, _BLOCK):
        known, now = basis[:, :done], slice(done - _BLOCK, done)
        image, component = _without(known, factor.solve(mass @ basis[:, now]), mass)
        inverse[:done, now] = component
        inverse[now, :done] = component.T
        basis[:, done:done + _BLOCK], rest = _orthonormal(image, mass)
        if done >= count and (done - count) // _BLOCK % _CHECK_EVERY == 0:
            value, vector = eigh(inverse[:done, :done], subset_by_index=(done - count, done - 1))
            error = np.linalg.norm(rest @ vector[-_BLOCK:], axis=0) / value
            if error.max() < _LANCZOS_TOLERANCE:
                return 1 / value[::-1], known @ vector[:, ::-1]
    raise ConvergenceError("lowest_modes", f"{count} modes within {most} Lanczos vectors",
                           f"{int((error < _LANCZOS_TOLERANCE).sum())}", "change the shift or ask for fewer modes")


def _without(known, image, mass):
    """``image`` made orthogonal to the ``known`` vectors in the mass norm, twice, and what was taken away."""
    total = 0.0
    for _ in range(2):
        component = known.T @ (mass @ image)
        image = image - known @ component
        total = total + component
    return image, total


def _orthonormal(block, mass):
    """Mass-orthonormal basis Q of the columns and R, block = Q R; Cholesky twice."""
    upper = np.eye(block.shape[1])
    for _ in range(2):
        factor = cholesky(block.T @ (mass @ block))
        block = solve_triangular(factor, block.T, trans="T").T
        upper = factor @ upper
    return block, upper


def _refuse_inaccurate(factor, mass, shifted, shape):
    """Check (K + s M)^-1 M x = x / (lambda + s) in the mass norm."""
    inertia = mass @ shape
    miss = factor.solve(inertia) * shifted - shape
    error = np.sqrt(np.maximum((miss * (mass @ miss)).sum(axis=0), 0))
    if not error.max() < _TOLERANCE:
        raise ConvergenceError("lowest_modes", f"an error below {_TOLERANCE:g}",
                               f"{error.max():.1e} in mode {int(error.argmax()) + 1}", "change the shift")
