"""Modes from measured frequency responses: poles by least squares over orders, then all poles and residues refined.

    H_n(w) = sum_k A_nk / (i w - p_k) + conj(A_nk) / (i w - conj(p_k)) + c_n + d_n w^2 + e_n / w^2

of every response n with the same poles p_k, whatever its quantity (receptance, mobility, accelerance): the last three
terms stand for modes beyond the band. First poles are those of a common denominator in z (least squares complex
frequency: Guillaume, Verboven, Vanlanduit, ISMA 1998) of rising order, kept where they come back from order to order;
they are refined together by Levenberg-Marquardt with residues eliminated (variable projection), whose Jacobian and
residual
give the standard deviations. Where more than noise is left, a pole is added or split, as the partner of a doublet.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError, ConvergenceError

#: a pole comes back if it moves by less than these shares of its distance from the imaginary axis and of its frequency
_MOVES, _FREQUENCY = 0.5, 2e-4
#: largest damping ratio of a pole of structures
_DAMPED = 0.2
#: poles closer than this share of their decay rate are one, and share of the orders at which one must come back
_ONE, _OFTEN = 0.5, 0.4
#: standard deviations that the residues of a mode exceed in the mean square, or it is none
_SEEN = 4.0
_ITERATIONS, _STEP, _LOWER = 100, 1e-9, 1e-11
#: modes that are added at most where something is left, standard deviations by which that must exceed noise, over so
#: many lines, and by how much more than the number of its values (half of them: chance) a mode must lower chi^2
_ADDED, _LEFT, _LINES, _GAIN = 20, 8.0, 3, 3.0
#: share of the band next to its ends in which what is left belongs to modes beside it
_EDGE = 0.05
#: share of a response below which what is left of it is rounding
_EXACT = 1e-6
#: half the distance of two poles that one stood for, and width of the band in which they are tried, over its decay rate
_APART, _ABOUT = 0.5, 40.0
#: share of the circle that the band fills
_CIRCLE = 0.9


@dataclass(frozen=True)
class Stabilisation:
    """Poles of every order: ``order`` (p,), ``pole`` (p,) in rad/s, whether each came back from the order before,
    ``stable`` (p,), and the mode that it became, ``chosen`` (p,), -1 for none."""

    order: np.ndarray
    pole: np.ndarray
    stable: np.ndarray
    chosen: np.ndarray


@dataclass(frozen=True)
class IdentifiedModes:
    """``pole`` (m,) in rad/s by rising frequency; ``std`` (m, 2) of decay rate and angular frequency in rad/s;
    ``residue`` (m, n) and ``residue_std`` (m, n) of the responses; ``noise`` (n,): standard deviation of the real and
    of the imaginary part of what is left of each; ``fitted`` (n, f); ``stabilisation``."""

    pole: np.ndarray
    std: np.ndarray
    residue: np.ndarray
    residue_std: np.ndarray
    noise: np.ndarray
    fitted: np.ndarray
    stabilisation: Stabilisation

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


def identify(frequency, response, most=60):
    """IdentifiedModes of ``response`` (n, f) over an even ``frequency`` (f,) axis in Hz, between its ends.

    ``most``: highest order of the denominator. Raises ConfigError for an axis that is not even or too short, and
    ConvergenceError if the refinement does not settle. A band without modes gives none.
    """
    _check(frequency, response)
    kept = frequency > 0.0
    frequency, response = frequency[kept], np.asarray(response, complex)[:, kept]
    diagram = _stabilisation(frequency, response, min(most, len(frequency) // 4))
    poles = _picked(diagram)
    fit = _refined(frequency, response, poles)
    fit = _pruned(frequency, response, fit)
    for _ in range(_ADDED):
        more = _with_another(frequency, response, fit)
        if more is None:
            break
        fit = more
    fit = _pruned(frequency, response, _refined(frequency, response, fit.pole))     # weights of what is left now
    own = _within(frequency, fit.pole)
    return replace(fit, pole=fit.pole[own], std=fit.std[own], residue=fit.residue[own],
                   residue_std=fit.residue_std[own], stabilisation=_told(diagram, fit.pole[own]))


def _within(frequency, poles):
    """(m,) whether a pole lies in the band; those beside it stand for the flanks of their modes alone."""
    return (poles.imag >= 2 * np.pi * frequency[0]) & (poles.imag <= 2 * np.pi * frequency[-1])


def _pruned(frequency, response, fit):
    """The fit without modes that are none."""
    while len(fit.pole) and (keep := _significant(fit, frequency)).sum() < len(keep):
        fit = _refined(frequency, response, fit.pole[keep])
    return fit


def _with_another(frequency, response, fit):
    """The fit with one mode more where most is left, such as the partner of a doublet that one pole stood for; None
    where nothing is left beyond noise, or another mode does not help."""
    left = abs(response - fit.fitted) ** 2
    noise = np.median(left, axis=1, keepdims=True) / np.log(2.0)       # of complex noise, exponentially distributed
    noise = np.maximum(noise, _EXACT**2 * np.mean(abs(response) ** 2, axis=1, keepdims=True))
    power = np.mean(left / np.maximum(noise, 1e-300), axis=0)
    smooth = scipy.ndimage.uniform_filter1d(power, _LINES)
    peak = int(smooth.argmax())
    if smooth[peak] < 1.0 + _LEFT / np.sqrt(_LINES * len(response)):
        return None
    at = 2 * np.pi * frequency[peak]
    near = int(abs(fit.pole.imag - at).argmin()) if len(fit.pole) else None
    decay = -np.median(fit.pole.real / abs(fit.pole)) * at if near is not None else 10 * _FREQUENCY * at
    edge = min(peak, len(frequency) - 1 - peak) < _EDGE * len(frequency)
    if edge:                    # the flank of a mode beside the band: a matter of all lines
        about, local = np.ones(len(frequency), bool), np.ones(len(fit.pole), bool)
        at += (1 if 2 * peak > len(frequency) else -1) * _EDGE * 2 * np.pi * (frequency[-1] - frequency[0])
    else:
        about = abs(2 * np.pi * frequency - at) < max(_ABOUT * decay, 32 * np.pi * (frequency[1] - frequency[0]))
        local = abs(fit.pole.imag - at) < 0.9 * _ABOUT * decay
    frequencies, responses, poles = frequency[about], response[:, about], fit.pole[local]
    starts = [np.append(poles, -decay + 1j * at)] if at > 0.0 else []
    if not edge and near is not None and abs(fit.pole[near].imag - at) < 4 * abs(fit.pole[near].real):
        apart = _APART * abs(fit.pole[near].real) * np.array([-1j, 1j])
        starts.append(np.append(poles[poles != fit.pole[near]], fit.pole[near] + apart))
    best, least = None, np.sum(np.log(_refined(frequencies, responses, poles).noise)) - _GAIN * (
        len(response) + 1) / len(frequencies)
    for start in starts:
        try:
            one = _pruned(frequencies, responses, _refined(frequencies, responses, start))
        except (ConvergenceError, np.linalg.LinAlgError):
            continue
        if len(one.pole) > len(poles) and np.sum(np.log(one.noise)) < least:
            best, least = one, np.sum(np.log(one.noise))
    return None if best is None else _pruned(frequency, response, _refined(
        frequency, response, np.concatenate([fit.pole[~local], best.pole]), fit.noise))


def _check(frequency, response):
    step = np.diff(frequency)
    if len(frequency) < 32 or np.abs(step - step.mean()).max(initial=0.0) > 1e-3 * step.mean():
        raise ConfigError("frequency responses", "32 or more lines at even distances", f"{len(frequency)} lines, "
                          f"{np.min(step, initial=np.inf):.4g} to {step.max(initial=0):.4g} Hz apart")
    if not np.isfinite(response).all() or not np.any(response, axis=1).all():
        raise ConfigError("frequency responses", "finite values that are not all 0", "others")


def _stabilisation(frequency, response, most):
    """Stabilisation of orders up to ``most``: roots of common denominators over the band, mapped onto the circle."""
    low, high = frequency[0], frequency[-1]
    interval = _CIRCLE / (high - low)
    angle = -2j * np.pi * (frequency - low) * interval
    powers = np.exp(angle[:, None] * np.arange(most + 1))
    scaled = response / np.sqrt(np.mean(abs(response) ** 2, axis=1, keepdims=True))
    numerator = np.linalg.inv(powers.conj().T @ powers + 1e-12 * len(frequency) * np.eye(most + 1))
    normal = np.zeros((most + 1, most + 1), complex)
    for row in scaled:
        weighted = row[:, None] * powers
        cross = powers.conj().T @ weighted
        normal += weighted.conj().T @ weighted - cross.conj().T @ numerator @ cross
    found, before = [], np.empty(0)
    for order in range(2, most + 1, 1):
        poles = _roots(normal[:order + 1, :order + 1], interval, low)
        stable = np.array([_came_back(p, before) for p in poles], bool)
        found += [(order, p, s, -1) for p, s in zip(poles, stable, strict=True)]
        before = poles
    columns = zip(*found, strict=True) if found else ((), (), (), ())
    order, pole, stable, chosen = map(np.array, columns)
    return Stabilisation(order.astype(int), pole.astype(complex), stable.astype(bool), chosen.astype(int))


def _roots(normal, interval, low):
    """Decaying poles in rad/s of the denominator of these normal equations, its last coefficient 1."""
    coefficient = np.append(np.linalg.lstsq(normal[:-1, :-1], -normal[:-1, -1], rcond=None)[0], 1.0)
    roots = np.roots(coefficient[::-1])
    poles = -np.log(roots[abs(roots) > 0.0]) / interval
    turn = 2 * np.pi / interval
    poles = poles.real + 1j * (np.mod(poles.imag + 0.05 * turn, turn) - 0.05 * turn + 2 * np.pi * low)
    damped = (poles.real < 0.0) & (-poles.real < _DAMPED * abs(poles)) & (poles.imag > 0.0)
    return poles[damped]


def _came_back(pole, before):
    reach = max(_MOVES * abs(pole.real), _FREQUENCY * abs(pole))
    return len(before) > 0 and abs(before - pole).min() < reach


def _picked(diagram):
    """Poles (m,): means of those that come back at often enough, close in the plane of poles."""
    poles, orders = diagram.pole[diagram.stable], diagram.order[diagram.stable]
    picked = []
    while len(poles):
        reach = np.maximum(_ONE * abs(poles.real), _FREQUENCY * abs(poles))
        near = abs(poles[:, None] - poles[None, :]) < reach[:, None]
        best = int(near.sum(axis=1).argmax())
        members = near[best]
        first = orders[members].min()
        possible = diagram.order.max() - first + 1
        if len(np.unique(orders[members])) >= max(_OFTEN * possible, 5):
            picked.append(np.median(poles[members].real) + 1j * np.median(poles[members].imag))
        poles, orders = poles[~members], orders[~members]
    return np.array(sorted(picked, key=lambda p: p.imag), complex)


def _basis(omega, poles):
    """(2 f, 2 m + 6) real columns of the model for Re and Im of the residues and of the terms beyond the band."""
    first, second = 1.0 / (1j * omega[:, None] - poles), 1.0 / (1j * omega[:, None] - poles.conj())
    scale = omega.mean()
    rest = np.column_stack([np.ones_like(omega), (omega / scale) ** 2, (scale / omega) ** 2]).astype(complex)
    columns = np.hstack([first + second, 1j * (first - second), rest, 1j * rest])
    return np.vstack([columns.real, columns.imag])


def _refined(frequency, response, poles, noise=None):
    """IdentifiedModes that begin at ``poles``; Levenberg and Marquardt's steps. ``noise`` (n,) of the
    responses where it is known about; else it is found in turns with the poles."""
    omega, count = 2 * np.pi * frequency, len(poles)
    data = np.vstack([response.real.T, response.imag.T])
    weight = np.ones(len(response)) if noise is None else 1.0 / np.maximum(noise, 1e-300)
    if count:
        for _ in range(3 if noise is None else 1):      # noise of each response by what the fit before leaves of it
            poles, left = _least_squares(omega, data * weight, poles)
            noise = np.sqrt(np.sum((left / weight) ** 2, axis=0) / _freedom(len(data), count))
            weight = 1.0 / np.maximum(noise, 1e-12 * abs(response).max())
    basis = _basis(omega, poles)
    factor, triangle = np.linalg.qr(basis)
    coefficient = np.linalg.solve(triangle, factor.T @ data)
    modelled = basis @ coefficient
    left = data - modelled
    noise = np.sqrt(np.sum(left**2, axis=0) / _freedom(len(data), count))
    fitted = modelled[:len(omega)] + 1j * modelled[len(omega):]
    residue = coefficient[:count] + 1j * coefficient[count:2 * count]
    inverse = np.linalg.inv(triangle)
    linear = np.sum(inverse**2, axis=1)
    spread = np.sqrt(linear[:count] + linear[count:2 * count])[:, None] * noise
    std = np.zeros((count, 2))
    if count:
        jacobian = _jacobian(omega, poles, factor, coefficient * weight)
        covariance = np.linalg.inv(jacobian.T @ jacobian)
        std = np.sqrt(np.diag(covariance)).reshape(2, count).T
        moved = _residue_by_pole(omega, poles, factor, triangle, coefficient)
        spread = np.sqrt(spread**2 + np.einsum("jrn,jk,krn->rn", moved.conj(), covariance, moved).real)
    order = np.argsort(poles.imag)
    nothing = Stabilisation(*(np.empty(0),) * 4)
    return IdentifiedModes(poles[order], std[order], residue[order], spread[order], noise, fitted.T, nothing)


def _freedom(rows, count):
    """Degrees of freedom of one response; its share in the poles is small."""
    return max(rows - 2 * count - 6, 1)


def _least_squares(omega, data, poles):
    """(poles, what they leave (2 f, n)); ConvergenceError where the steps do not end."""
    def left_by(at):
        factor, triangle = np.linalg.qr(_basis(omega, at))
        projected = factor.T @ data
        return data - factor @ projected, factor, np.linalg.solve(triangle, projected)

    state, damping = left_by(poles), 1e-3
    for _ in range(_ITERATIONS):
        left, factor, coefficient = state
        jacobian = _jacobian(omega, poles, factor, coefficient)
        size = np.sqrt(np.einsum("ij,ij->j", jacobian, jacobian))
        normal, slope = (jacobian / size).T @ (jacobian / size), (jacobian / size).T @ left.T.ravel()
        before, moved = np.sum(left**2), np.inf
        while moved > _STEP:
            step = -np.linalg.solve(normal + damping * np.eye(len(normal)), slope) / size
            tried = poles + step[:len(poles)] + 1j * step[len(poles):]
            tried = np.where(tried.real < 0.0, tried, 0.5 * poles.real + 1j * tried.imag)
            moved, after = abs(tried - poles).max() / abs(poles).max(), left_by(tried)
            if np.sum(after[0] ** 2) <= before:
                poles, state, damping = tried, after, max(damping / 10.0, 1e-12)
                break
            damping *= 5.0
        if moved < _STEP or before - np.sum(state[0] ** 2) < _LOWER * before:
            return poles, state[0]
    raise ConvergenceError("modes from frequency responses", f"poles that settle within {_ITERATIONS} steps",
                           f"a last step of {moved:.1e} of the frequency", "narrow the band")


def _jacobian(omega, poles, factor, coefficient):
    """(n 2 f, 2 m) derivative of what is left by real, then imaginary parts of the poles, residues following (Kaufman).
    """
    return np.column_stack([-(change - factor @ (factor.T @ change)).T.ravel()
                            for change in _changes(omega, poles, coefficient)])


def _residue_by_pole(omega, poles, factor, triangle, coefficient):
    """(2 m, m, n) derivative of the residues by real, then imaginary parts of the poles."""
    count = len(poles)
    moved = np.array([np.linalg.solve(triangle, -factor.T @ change) for change in _changes(omega, poles, coefficient)])
    return moved[:, :count] + 1j * moved[:, count:2 * count]


def _changes(omega, poles, coefficient):
    """Derivatives (2 f, n) of the model by real, then imaginary parts of the poles, the residues held."""
    count = len(poles)
    residue = coefficient[:count] + 1j * coefficient[count:2 * count]           # (m, n)
    first = 1.0 / (1j * omega[:, None] - poles) ** 2
    second = 1.0 / (1j * omega[:, None] - poles.conj()) ** 2
    for by in (1.0, 1j):
        for k in range(count):
            change = first[:, k, None] * (by * residue[k]) + second[:, k, None] * np.conj(by * residue[k])
            yield np.vstack([change.real, change.imag])


def _significant(fit, frequency):
    """(m,) whether the residues of a mode exceed their errors, and its pole is known and decays, if in the band."""
    strength = np.sqrt(np.mean((abs(fit.residue) / np.maximum(fit.residue_std, 1e-300)) ** 2, axis=1))
    known = fit.std[:, 1] < 0.5 * np.maximum(abs(fit.pole.real), _FREQUENCY * abs(fit.pole))
    known |= ~_within(frequency, fit.pole)
    return (strength > _SEEN) & known & (fit.damping_ratio < _DAMPED)


def _told(diagram, poles):
    """The diagram with the mode that each stable pole became."""
    if not len(poles) or not len(diagram.pole):
        return diagram
    distance = abs(diagram.pole[:, None] - poles[None, :])
    nearest = distance.argmin(axis=1)
    reach = np.maximum(_ONE * abs(poles[nearest].real), _FREQUENCY * abs(poles[nearest]))
    close = (distance[np.arange(len(nearest)), nearest] < reach) & diagram.stable
    return replace(diagram, chosen=np.where(close, nearest, -1))
