"""Poles and residues of frequency responses, refined together: variable projection, and what it tells of their errors.

Residues and terms beyond the band follow from the poles by linear least squares; Levenberg and Marquardt's steps move
the poles, with Kaufman's Jacobian. Of the real columns (lines, 2 modes) that are the derivatives of the basis by the
poles it takes only the products, so that a step costs little more than the basis. The steps end where the next one
would move the poles of the band by a small share of their standard deviations, or changes nothing.
"""

from dataclasses import dataclass

import numpy as np
import scipy

#: steps at most; share of the frequency below which a step is none, and share of the squares by which one must lower
#: them
_ITERATIONS, _STEP, _LOWER = 60, 1e-9, 1e-11
#: distance of the poles from the optimum, in standard deviations, at which they have settled
_SETTLED = 1e-2
#: share of a response below which what is left of it is rounding
_EXACT = 1e-6
#: turns in which noise is told apart, and times of its variance beyond which a square is that of something else
_TURNS, _FAR = 12, 6.0
#: terms that stand for modes beyond the band: powers from 0 on, and 1 / w^2
_BEYOND = 6
#: part of a column of the basis beyond those before it, from which products tell it
_ALIKE = 1e-5
#: lines over which what modes leave beyond noise is averaged, and its standard deviations that are chance
_SMOOTH, _CHANCE = 9, 2.0
#: rounds in which noise of each response and poles are found in turns
_ROUNDS = 3


@dataclass(frozen=True)
class Refined:
    """``pole`` (m,) in rad/s by rising frequency; ``std`` (m, 2) of decay rate and angular frequency in rad/s; ``away``
    (m,): how far it may still be from where it settles, in these; ``residue`` (m, n) and ``residue_std`` (m, n);
    ``noise`` (n, f): standard deviation of the real and of the imaginary part of each response, by what is left of it;
    ``fitted`` (n, f)."""

    pole: np.ndarray
    std: np.ndarray
    away: np.ndarray
    residue: np.ndarray
    residue_std: np.ndarray
    noise: np.ndarray
    fitted: np.ndarray

    @property
    def frequency(self):
        """Natural frequencies (m,) in Hz: absolute values of the poles."""
        return abs(self.pole) / (2 * np.pi)

    @property
    def frequency_std(self):
        """Their standard deviations (m,)."""
        share = np.column_stack([self.pole.real, self.pole.imag]) / abs(self.pole)[:, None]
        return np.hypot(*(share * self.std).T) / (2 * np.pi)

    @property
    def damping_ratio(self):
        """Damping ratios (m,)."""
        return -self.pole.real / abs(self.pole)

    @property
    def damping_ratio_std(self):
        """Their standard deviations (m,)."""
        size = abs(self.pole)
        return np.hypot(self.pole.imag**2 / size**3 * self.std[:, 0],
                        self.pole.real * self.pole.imag / size**3 * self.std[:, 1])


def refined(frequency, response, poles, noise=None, apart=False):
    """Refined of ``response`` (n, f) over ``frequency`` (f,) in Hz that begins at ``poles`` (m,) in rad/s.

    ``noise`` (n, f) of the responses where it is known about; else it is found in turns with the poles. ``apart``: each
    response counts at each line by its own noise, which takes n times as long; else lines count alike in all of them.
    """
    omega, count, known = 2 * np.pi * frequency, len(poles), noise is not None
    noise = noise if known else np.ones(response.shape)
    for _ in range(1 if known or not count else _ROUNDS):
        parts = _parts(omega, response, noise, apart)
        poles, away = _least_squares(parts, omega, poles)
        if not known:
            fitted = [part.fitted(each) for part, each in zip(parts, _at(parts, poles), strict=True)]
            noise = unexplained(response, np.concatenate(fitted))
    parts = _parts(omega, response, noise, apart)
    found = [part.solved(poles, each) for part, each in zip(parts, _at(parts, poles), strict=True)]
    covariance = np.linalg.inv(sum(one.normal for one in found)) if count else np.empty((0, 0))
    order, std = np.argsort(poles.imag), np.sqrt(np.diag(covariance)).reshape(2, count).T
    residue = np.concatenate([one.residue for one in found], axis=1)
    spread = np.concatenate([one.spread(covariance) for one in found], axis=1)
    return Refined(poles[order], std[order], away[order], residue[order], spread[order],
                   np.concatenate([one.noise for one in found]), np.concatenate([one.fitted for one in found]))


def noise_of(response, fitted):
    """(n, f) standard deviation of the real and of the imaginary part of white noise in ``response`` (n, f).

    Its square is a constant and a share of the square of the ``fitted`` response: noise of the sensors, and what
    averages leave open of a response. Both are found from second differences of what is left, in which a mode that is
    still missing counts little.
    """
    left, power = response - fitted, abs(fitted) ** 2
    bend = abs(left[:, :-2] - 2 * left[:, 1:-1] + left[:, 2:]) ** 2 / 12.0
    mean = np.maximum(power.mean(axis=1, keepdims=True), 1e-300)
    about = (power[:, :-2] + 4 * power[:, 1:-1] + power[:, 2:]) / (6.0 * mean)
    least = np.maximum(_EXACT**2 * mean, 1e-300)
    constant, share = np.maximum(bend.mean(axis=1, keepdims=True), least), np.zeros_like(mean)
    for _ in range(_TURNS):         # likelihood of exponentially distributed squares, what is far beyond it cut
        variance = constant + share * about
        seen, weight = np.minimum(bend, _FAR * variance), 1.0 / variance**2
        sums = [np.sum(weight * about**k, axis=1, keepdims=True) for k in range(3)]
        first, second = (np.sum(weight * about**k * seen, axis=1, keepdims=True) for k in range(2))
        determinant = np.maximum(sums[0] * sums[2] - sums[1] ** 2, 1e-300)
        slope = (sums[0] * second - sums[1] * first) / determinant
        share = np.clip(slope, 0.0, second / np.maximum(sums[2], 1e-300))
        constant = np.maximum((first - share * sums[1]) / sums[0], least)
    return np.sqrt(constant + share * power / mean)


def unexplained(response, fitted):
    """(n, f) the same with what modes that are missing leave beyond the noise, in the mean of all responses about each
    line. As that is no noise but alike over lines, it counts by their number."""
    noise = noise_of(response, fitted)
    left = np.mean(abs(response - fitted) ** 2 / (2.0 * noise**2), axis=0)
    more = scipy.ndimage.uniform_filter1d(left, _SMOOTH) - 1.0 - _CHANCE / np.sqrt(_SMOOTH * len(response))
    return noise * np.sqrt(1.0 + _SMOOTH * np.maximum(more, 0.0))


def _parts(omega, response, noise, apart):
    """[_Part] of responses (n, f) whose lines count alike: of all together, or of each."""
    return [_Part(omega, response[rows], noise[rows]) for rows in (
        [slice(k, k + 1) for k in range(len(response))] if apart else [slice(None)])]


class _Part:
    """Responses (n, f), and columns of the model, over their ``noise`` (n, f): by line in the mean, and by response."""

    def __init__(self, omega, response, noise):
        own = np.exp(np.mean(np.log(noise), axis=1))
        self._line = np.tile(np.sqrt(np.mean((noise / own[:, None]) ** 2, axis=0)), 2)[:, None]
        self._omega, self._own = omega, own
        self.data = np.vstack([response.real.T, response.imag.T]) / (self._line * own)

    def columns(self, poles):
        """(basis (2 f, 2 m + 2 _BEYOND) without weights, its slopes by the poles (2 f, 2 m))."""
        return _basis(self._omega, poles), _slopes(self._omega, poles)

    def at(self, columns):
        """(what such ``columns`` leave (2 f, n), their basis (2 f, p), orthonormal, its triangle (p, p), coefficients
        (p, n), slopes (2 f, 2 m))."""
        factor, triangle = _orthonormal(columns[0] / self._line)
        projected = factor.T @ self.data
        return (self.data - factor @ projected, factor, triangle, np.linalg.solve(triangle, projected),
                columns[1] / self._line)

    def fitted(self, state):
        """(n, f) responses of such a ``state`` as ``at`` tells."""
        return self._responses(self.data - state[0])

    def solved(self, poles, state):
        """_Solved with these poles."""
        left, factor, triangle, coefficient, slopes = state
        count, own = len(poles), self._own
        scale = np.sqrt(np.sum(left**2, axis=0) / _freedom(len(left), count))
        residue = coefficient[:count] + 1j * coefficient[count:2 * count]
        linear = np.sum(np.linalg.inv(triangle) ** 2, axis=1)
        return _Solved(
            residue * own, np.sqrt(linear[:count] + linear[count:2 * count])[:, None] * scale * own,
            _normal(_outside(slopes, factor), _turned(residue / np.maximum(scale, 1e-300))),
            _residue_by_pole(np.linalg.solve(triangle, -factor.T @ slopes), _turned(residue * own)),
            (own * scale)[:, None] * self._line[:len(self._omega), 0], self._responses(self.data - left))

    def _responses(self, columns):
        columns = columns * (self._line * self._own)
        return (columns[:len(self._omega)] + 1j * columns[len(self._omega):]).T


@dataclass(frozen=True)
class _Solved:
    """``residue`` (m, n), its ``own`` error (m, n) with the poles held, the ``normal`` matrix (2 m, 2 m) of the poles,
    derivatives of the residues ``by_pole`` (2 m, m, n), ``noise`` (n, f) and ``fitted`` (n, f)."""

    residue: np.ndarray
    own: np.ndarray
    normal: np.ndarray
    by_pole: np.ndarray
    noise: np.ndarray
    fitted: np.ndarray

    def spread(self, covariance):
        """(m, n) standard deviations of the residues, with the ``covariance`` (2 m, 2 m) of the poles."""
        moved = np.einsum("jrn,jk,krn->rn", self.by_pole.conj(), covariance, self.by_pole).real
        return np.sqrt(self.own**2 + moved)


def _freedom(rows, count):
    """Degrees of freedom of one response; its share in the poles is small."""
    return max(rows - 2 * count - 2 * _BEYOND, 1)


def _least_squares(parts, omega, poles):
    """(poles (m,) that leave least of [_Part], how far each may still be from there in standard deviations (m,))."""
    if not len(poles):
        return poles, np.zeros(0)
    state, damping, own = _at(parts, poles), 1e-3, _within(omega, poles)
    for _ in range(_ITERATIONS):
        normal, slope, size = _equations(state, len(poles))
        before, moved, away = _squares(state), np.inf, _away(normal, slope, state, len(poles))
        if away[own].max(initial=0.0) < _SETTLED:
            break
        while moved > _STEP:
            step = -np.linalg.solve(normal + damping * np.eye(len(normal)), slope) / size
            tried = poles + step[:len(poles)] + 1j * step[len(poles):]
            tried = np.where(tried.real < 0.0, tried, 0.5 * poles.real + 1j * tried.imag)
            moved, after = abs(tried - poles).max() / abs(poles).max(), _at(parts, tried)
            if _squares(after) <= before:
                poles, state, damping = tried, after, max(damping / 10.0, 1e-12)
                break
            damping *= 5.0
        if moved < _STEP or before - _squares(state) < _LOWER * before:
            away = np.zeros(len(poles))
            break
    return poles, away


def _within(omega, poles):
    return (poles.imag >= omega[0]) & (poles.imag <= omega[-1])


def _at(parts, poles):
    basis = parts[0].columns(poles)
    return [part.at(basis) for part in parts]


def _squares(state):
    return sum(np.sum(left**2) for left, *_ in state)


def _equations(state, count):
    """(normal matrix (2 m, 2 m) of unit diagonal, slope (2 m,) and size (2 m,) of its rows) by the real, then the
    imaginary parts of the poles, the residues following."""
    normal, slope = np.zeros((2 * count, 2 * count)), np.zeros(2 * count)
    for left, factor, _, coefficient, slopes in state:
        outside = _outside(slopes, factor)
        residue = _turned(coefficient[:count] + 1j * coefficient[count:2 * count])
        normal += _normal(outside, residue)
        slope -= np.einsum("ikn,bikn->bk", (outside.T @ left).reshape(2, count, -1), residue).ravel()
    size = np.sqrt(np.diag(normal))
    return normal / np.outer(size, size), slope / size, size


def _away(normal, slope, state, count):
    """(m,) distances of the poles from the optimum of the equations, in standard deviations of the noise that is left.
    """
    inverse = np.linalg.pinv(normal, hermitian=True)
    freedom = sum(_freedom(len(left), count) * left.shape[1] for left, *_ in state)
    noise = np.maximum(_squares(state) / freedom, 1e-300)
    steps = abs(inverse @ slope) / np.sqrt(np.maximum(np.diag(inverse), 1e-300) * noise)
    return steps.reshape(2, count).max(axis=0)


def _orthonormal(columns):
    """(orthonormal columns (r, p), triangle (p, p)) of ``columns`` (r, p): Cholesky's factor of their products, taken
    twice; by reflections where these are too much alike."""
    size = np.sqrt(np.einsum("ij,ij->j", columns, columns))
    factor, triangle = columns / size, np.diag(size)
    try:
        for _ in range(2):
            upper = np.linalg.cholesky(factor.T @ factor).T
            if upper.diagonal().min() < _ALIKE:
                return np.linalg.qr(columns)
            factor, triangle = factor @ np.linalg.inv(upper), upper @ triangle
    except np.linalg.LinAlgError:
        return np.linalg.qr(columns)
    return factor, triangle


def _outside(slopes, factor):
    return slopes - factor @ (factor.T @ slopes)


def _basis(omega, poles):
    """(2 f, 2 m + 2 _BEYOND) real columns of the model for Re and Im of the residues and of the terms beyond the band.
    """
    first, second = 1.0 / (1j * omega[:, None] - poles), 1.0 / (1j * omega[:, None] - poles.conj())
    share = (2.0 * omega - omega[0] - omega[-1]) / (omega[-1] - omega[0])
    rest = np.column_stack([np.polynomial.chebyshev.chebvander(share, _BEYOND - 2), (omega.mean() / omega) ** 2])
    return _real(np.hstack([first + second, 1j * (first - second), rest.astype(complex), 1j * rest]))


def _slopes(omega, poles):
    """(2 f, 2 m) derivatives of the columns of the basis for Re, then Im of the residues, by their poles."""
    first = 1.0 / (1j * omega[:, None] - poles) ** 2
    second = 1.0 / (1j * omega[:, None] - poles.conj()) ** 2
    return _real(np.hstack([first + second, 1j * (first - second)]))


def _real(columns):
    return np.vstack([columns.real, columns.imag])


def _turned(residue):
    """(2, 2, m, n) Re and Im of what a residue (m, n) becomes by a step of its pole: itself, and times i."""
    return np.array([[residue.real, residue.imag], [-residue.imag, residue.real]])


def _normal(outside, residue):
    """(2 m, 2 m) products of Kaufman's Jacobian of slopes ``outside`` the basis (2 f, 2 m) and turned residues."""
    count = residue.shape[2]
    products = (outside.T @ outside).reshape(2, count, 2, count)
    flat = residue.reshape(-1, residue.shape[-1])
    together = (flat @ flat.T).reshape(2, 2, count, 2, 2, count)
    return np.einsum("ikjl,bikcjl->bkcl", products, together).reshape(2 * count, 2 * count)


def _residue_by_pole(solved, residue):
    """(2 m, m, n) derivative of the residues by real, then imaginary parts of the poles; ``solved`` (p, 2 m)."""
    count = residue.shape[2]
    both = solved.reshape(len(solved), 2, count)
    moved = np.einsum("pik,bikn->bkpn", both, residue).reshape(2 * count, len(solved), residue.shape[-1])
    return moved[:, :count] + 1j * moved[:, count:2 * count]
