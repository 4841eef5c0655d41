"""Lowest natural modes of large undamped structures: shift-invert Lanczos with a completeness check."""

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.numerics.sparse_solver import factorise

#: largest accepted error of an eigenvalue of the shifted problem, relative
_TOLERANCE = 1e-7
#: automatic shift: share of the largest ratio of stiffness and mass diagonals
_DIAGONAL_SHARE = 1e-6
#: where between zero and the limit the shift lies that modes below a limit are found from, as a share of its square
_AMID = 0.5
#: below this size, dense
_DENSE = 400
_BLOCK = 8
#: rows of vectors that are combined at once
_ROWS = 4096
#: most Lanczos vectors per mode
_LONGEST = 8
_CHECK_EVERY = 2
_LANCZOS_TOLERANCE = 1e-10


def all_modes(stiffness, mass):
    """(squares (n,) of the angular frequencies, modes (n, n) of unit modal mass) of dense symmetric matrices, lowest
    first; ``mass`` positive definite, and not factorised where it is diagonal."""
    inertia = np.diag(mass)
    if np.count_nonzero(mass) > len(mass) or not (inertia > 0).all():
        return scipy.linalg.eigh(stiffness, mass)
    scale = 1 / np.sqrt(inertia)
    square, modes = scipy.linalg.eigh(stiffness * scale * scale[:, None], driver="evd", overwrite_a=True)
    return square, modes * scale[:, None]


def lowest_modes(stiffness, mass, solver, count=None, below=None, shift=None):
    """Modes of K x = (2 pi f)^2 M x, lowest first; a free body keeps its six rigid modes at 0 Hz.

    Parameters
    ----------
    stiffness, mass : (n, n) sparse symmetric [N/m, kg]; ``mass`` positive definite
    solver : "pypardiso" or "superlu"
    count : number of modes, or
    below : frequency [Hz] below which all modes are wanted
    shift : with ``count`` the factorised matrix is K + (2 pi shift)^2 M [Hz]; chosen by itself by default

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
    if count is not None and count > stiffness.shape[0]:
        raise ConfigError("lowest_modes", f"at most {stiffness.shape[0]} modes", str(count))
    if below is None:
        offset = _offset(stiffness, mass) if shift is None else (2 * np.pi * shift)**2
        square, shape = _solve(stiffness, mass, solver, count, offset)
    else:
        square, shape = _below(stiffness, mass, solver, below)
    order = np.argsort(square, kind="stable")
    frequency, shape = np.sqrt(np.maximum(square[order], 0)) / (2 * np.pi), shape[:, order]
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


def _offset(stiffness, mass):
    return _DIAGONAL_SHARE * (stiffness.diagonal() / mass.diagonal()).max()


def _below(stiffness, mass, solver, below):
    """Squared angular frequencies (m,) below a frequency and shapes (n, m).

    The inertia of K - (2 pi below)^2 M counts them. Lanczos' method with a shift amid their range finds them: as they
    lie on both sides of it, they are those whose shifted and inverted eigenvalues are largest in magnitude.
    """
    limit = (2 * np.pi * below)**2
    size, count = stiffness.shape[0], _counted(stiffness, mass, solver, limit).negative
    if not count:
        return np.zeros(0), np.zeros((size, 0))
    if _is_dense(size, count):
        square, shape = _dense(stiffness, mass, count)
    else:
        shift = _AMID * limit
        factor = _counted(stiffness, mass, solver, shift)
        shifted, shape = _lanczos(factor, mass, count - factor.negative, factor.negative, 1 / (limit - shift))
        _refuse_inaccurate(factor, mass, shifted, shape)
        square = _quotients(stiffness, shape)       # far from the shift better than by its eigenvalue
    if not (square < limit).all():
        raise ConvergenceError("lowest_modes", f"{count} modes below {below:g} Hz (inertia)",
                               str(int((square < limit).sum())), "change the frequency limit a little")
    return square, shape


def _counted(stiffness, mass, solver, shift):
    """Factor of K - shift M with the number of its negative eigenvalues."""
    factor = factorise(stiffness - shift * mass, solver)
    if factor.negative is None:
        raise ConvergenceError("lowest_modes", "a factor without row exchanges to count modes", "exchanges",
                               "change the frequency limit a little, or use the solver pypardiso")
    return factor


def _solve(stiffness, mass, solver, count, offset):
    """(m,) squared angular frequencies, ascending, and (n, m) shapes of the lowest ``count`` modes."""
    size = stiffness.shape[0]
    if count == 0:
        return np.zeros(0), np.zeros((size, 0))
    if _is_dense(size, count):
        return _dense(stiffness, mass, count)
    factor = factorise(stiffness + offset * mass, solver)
    shifted, shape = _lanczos(factor, mass, count)
    _refuse_inaccurate(factor, mass, shifted, shape)
    return shifted - offset, shape


def _is_dense(size, count):
    return size < _DENSE or count > size // 8


def _dense(stiffness, mass, count):
    square, shape = scipy.linalg.eigh(stiffness.toarray(), mass.toarray())
    return square[:count], shape[:, :count]


def _lanczos(factor, mass, above, beneath=0, edge=None):
    """Eigenvalues of (A, M) next to zero, ``above`` of them above it and ``beneath`` below, and their vectors, in no
    order. ``beneath`` not zero: all that are below zero. ``edge``: refused if there are others whose inverses lie below
    zero or above it.

    Block Lanczos on A^-1 M with full reorthogonalisation in the mass norm (Grimes, Lewis and
    Simon 1994, without restart): whole blocks keep double modes together and solve several
    right-hand sides at once.
    """
    size, count = mass.shape[0], above + beneath
    most = min(_LONGEST * count + 20 * _BLOCK, size // 2)
    basis, inverse = np.empty((size, most + _BLOCK), order="F"), np.zeros((most + _BLOCK, most + _BLOCK))
    start = factor.solve(mass @ np.random.default_rng(0).standard_normal((size, _BLOCK)))
    basis[:, :_BLOCK], inertia, _ = _orthonormal(start, mass)       # M times the last block, then the last two
    for done in range(_BLOCK, most + 1, _BLOCK):
        now, after = slice(done - _BLOCK, done), slice(done, done + _BLOCK)
        recent = slice(max(done - 2 * _BLOCK, 0), done)
        image = factor.solve(inertia[:, -_BLOCK:])
        inverse[recent, now] = inertia.T @ image
        image -= basis[:, recent] @ inverse[recent, now]
        image -= basis[:, :done] @ (basis[:, :done].T @ (mass @ image))
        basis[:, after], following, rest = _orthonormal(image, mass)
        inertia = np.hstack((inertia[:, -_BLOCK:], following))
        if done >= count and (done - count) // _BLOCK % _CHECK_EVERY == 0:
            value, vector = _ends(inverse[:done, :done], above, beneath)
            error = np.linalg.norm(rest @ vector[-_BLOCK:], axis=0) / abs(value)
            if error.max() < _LANCZOS_TOLERANCE and (value > 0).sum() == above:
                if edge is not None:
                    _refuse_uncounted(inverse[:done, :done], count, edge)
                return 1 / value, _combined(basis[:, :done], vector)
    raise ConvergenceError("lowest_modes", f"{count} modes within {most} Lanczos vectors", "less",
                           "change the shift or ask for fewer modes")


def _combined(basis, vector):
    """basis (n, k) @ vector (k, m), in the memory of the basis."""
    count = vector.shape[1]
    for rows in range(0, len(basis), _ROWS):
        part = slice(rows, rows + _ROWS)
        basis[part, :count] = basis[part] @ vector
    return basis[:, :count]


def _quotients(stiffness, shape):
    """(m,) x.K x of mass-normalised shapes (n, m), a block at a time."""
    blocks = (shape[:, k:k + _BLOCK] for k in range(0, shape.shape[1], _BLOCK))
    return np.concatenate([np.einsum("nm,nm->m", block, stiffness @ block) for block in blocks])


def _ends(inverse, above, beneath):
    """The ``above`` largest eigenvalues, largest first, then the ``beneath`` smallest; and their vectors."""
    size = len(inverse)
    wanted = None if beneath else (size - above, size - 1)
    value, vector = scipy.linalg.eigh(inverse, subset_by_index=wanted, lower=False)
    ends = np.r_[len(value) - 1:len(value) - 1 - above:-1, :beneath]
    return value[ends], vector[:, ends]


def _refuse_uncounted(inverse, count, edge):
    """Of ``count`` eigenvalues below zero or above ``edge`` no more may be found (of fewer there are never more)."""
    value = scipy.linalg.eigvalsh(inverse, lower=False)
    found = int(((value < 0) | (value > edge)).sum())
    if found != count:
        raise ConvergenceError("lowest_modes", f"{count} modes below the limit (inertia)", str(found),
                               "change the frequency limit a little")


def _orthonormal(block, mass):
    """Mass-orthonormal basis Q of the columns, M Q, and R with block = Q R; Cholesky twice."""
    inertia, identity = mass @ block, np.eye(block.shape[1])
    upper = identity
    for _ in range(2):
        factor = scipy.linalg.cholesky(block.T @ inertia)
        back = scipy.linalg.solve_triangular(factor, identity)      # few columns: a product is faster than solving
        block, inertia, upper = block @ back, inertia @ back, factor @ upper
    return block, inertia, upper


def _refuse_inaccurate(factor, mass, shifted, shape):
    """Check (K + s M)^-1 M x = x / (lambda + s) in the mass norm: of a few sums of all modes with seeded signs,
    in which no error of a mode is lost, and of every mode where these miss it."""
    count = shape.shape[1]
    if count > _BLOCK:
        signs = np.where(np.random.default_rng(0).random((count, _BLOCK)) < 0.5, -1.0, 1.0)
        mixed, pulled = shape @ signs, shape @ (signs * shifted[:, None])
        if _error(factor.solve(mass @ pulled) - mixed, mass).max() < _TOLERANCE:
            return
    error = _error(factor.solve(mass @ shape) * shifted - shape, mass)
    if not error.max() < _TOLERANCE:
        raise ConvergenceError("lowest_modes", f"an error below {_TOLERANCE:g}",
                               f"{error.max():.1e} in mode {int(error.argmax()) + 1}", "change the shift")


def _error(miss, mass):
    """(m,) mass norms of columns (n, m)."""
    return np.sqrt(np.maximum((miss * (mass @ miss)).sum(axis=0), 0))
