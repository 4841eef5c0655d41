"""Modes from measured frequency responses: poles by least squares over orders, then all poles and residues refined.

    H_n(w) = sum_k A_nk / (i w - p_k) + conj(A_nk) / (i w - conj(p_k)) + sum_j c_nj w^j + e_n / w^2,    j = 0 ... 4

of every response n with the same poles p_k, whatever its quantity (receptance, mobility, accelerance): the last terms
stand for modes beyond the band. First poles are those of a common denominator in z (least squares complex
frequency: Guillaume, Verboven, Vanlanduit, ISMA 1998) of rising order, kept where they come back from order to order;
they are refined together with their residues (``pole_refinement``). Where more than noise is left, a pole is added or
split, as the partner of a doublet, or put beside the band.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.modal.pole_refinement import Refined, noise_of, refined, unexplained

#: a pole comes back if it moves by less than these shares of its distance from the imaginary axis and of its frequency
_MOVES, _FREQUENCY = 0.5, 2e-4
#: largest damping ratio of a pole of structures
_DAMPED = 0.2
#: poles closer than this share of their decay rate are one, and share of the orders at which one must come back
_ONE, _OFTEN = 0.5, 0.4
#: standard deviations that the residues of a mode exceed in the mean square, or it is none
_SEEN = 4.0
#: share of the residues of the strongest mode below which a mode is rounding, in every response
_FAINT = 1e-9
#: modes that are added at most where something is left, standard deviations by which that must exceed noise, over so
#: many lines, and by how much more than the number of its values (half of them: chance) a mode must lower chi^2
_ADDED, _LEFT, _LINES, _GAIN = 20, 8.0, 3, 3.0
#: share of a response that what is left must exceed for that: less is the shape that windows give a peak
_SHARE = 0.08
#: share of the band next to its ends in which what is left belongs to modes beside it
_EDGE = 0.05
#: half the distance of two poles that one stood for, and width of the band in which they are tried, over its decay rate
_APART, _ABOUT = 0.5, 40.0
#: standard deviations that a pole may be from where it settles
_SETTLED = 0.3
#: distances of such a mode from the end of the band, as shares of it, that are tried
_BESIDE = 0.01, 0.05
#: what is left over noise, and as a share of the response, next to an end of the band from which such a mode is tried
_FLANK, _FLANK_SHARE = 3.0, 0.02
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
class IdentifiedModes(Refined):
    """Refined poles that lie in the band, and the ``stabilisation`` that they came from."""

    stabilisation: Stabilisation


def identify(frequency, response, most=60):
    """IdentifiedModes of ``response`` (n, f) over an even ``frequency`` (f,) axis in Hz, between its ends.

    ``most``: highest order of the denominator. Raises ConfigError for an axis that is not even or too short. A band
    without modes gives none; a pole that does not settle within what the noise leaves open is no mode.
    """
    _check(frequency, response)
    kept = frequency > 0.0
    frequency, response = frequency[kept], np.asarray(response, complex)[:, kept]
    diagram = _stabilisation(frequency, response, min(most, len(frequency) // 4))
    poles = _picked(diagram)
    fit = refined(frequency, response, poles)
    fit = _pruned(frequency, response, fit)
    for _ in range(_ADDED):
        more = _with_another(frequency, response, fit)
        if more is None:
            break
        fit = more
    fit = _pruned(frequency, response, refined(frequency, response, fit.pole))     # weights of what is left now
    fit = refined(frequency, response, fit.pole, unexplained(response, fit.fitted), apart=True)
    own = _within(frequency, fit.pole)
    return IdentifiedModes(fit.pole[own], fit.std[own], fit.away[own], fit.residue[own], fit.residue_std[own],
                           fit.noise, fit.fitted, _told(diagram, fit.pole[own]))


def _within(frequency, poles):
    """(m,) whether a pole lies in the band; those beside it stand for the flanks of their modes alone."""
    return (poles.imag >= 2 * np.pi * frequency[0]) & (poles.imag <= 2 * np.pi * frequency[-1])


def _pruned(frequency, response, fit):
    """The fit without modes that are none."""
    while len(fit.pole) and (keep := _significant(fit, frequency)).sum() < len(keep):
        fit = refined(frequency, response, fit.pole[keep])
    return fit


def _with_another(frequency, response, fit):
    """The fit with one mode more where most is left, such as the partner of a doublet that one pole stood for, or a
    mode beside the band; None where nothing is left beyond noise, or another mode does not help."""
    noise = noise_of(response, fit.fitted)
    edge = max(int(_EDGE * len(frequency)), 1)
    left = _left(response, fit, noise, edge)
    ends = {-1: slice(0, edge), 0: slice(edge, len(left) - edge), 1: slice(len(left) - edge, len(left))}
    peaks = {side: lines.start + int(left[lines].argmax()) for side, lines in ends.items()}
    for side in sorted((k for k in peaks if left[peaks[k]] > 0.0), key=lambda k: -left[peaks[k]]):
        more = _added(frequency, response, fit, noise, frequency[peaks[side]], side)
        if more is not None:
            return more
    return None


def _left(response, fit, noise, edge):
    """(f,) what a fit leaves over noise in the mean of all responses, 0 where it is not enough for another mode;
    ``edge``: lines next to the ends."""
    left, whole = (scipy.ndimage.uniform_filter1d(np.mean(each, axis=0) / 2.0, _LINES) for each in (
        _squares(response, fit, noise), abs(response / noise) ** 2))
    least, share = (np.full(len(left), value) for value in (_FLANK, _FLANK_SHARE))
    least[edge:-edge], share[edge:-edge] = 1.0 + _LEFT / np.sqrt(_LINES * len(response)), _SHARE
    return np.where((left > least) & (left > share**2 * whole), left, 0.0)


def _added(frequency, response, fit, noise, peak, side):
    """The fit with one mode more about ``peak`` in Hz, or beside the band at the end ``side`` (-1, 1; 0: within); None
    where it does not help. What stands for the flank of a mode beside the band is a matter of all lines."""
    at, poles = 2 * np.pi * peak, fit.pole
    near = poles[abs(poles.imag - at).argmin()] if len(poles) else None
    decay = 10 * _FREQUENCY * at if near is None else -np.median(poles.real / abs(poles)) * at
    reach = np.inf if side else _ABOUT * decay
    about = abs(2 * np.pi * frequency - at) < max(reach, 32 * np.pi * (frequency[1] - frequency[0]))
    local = abs(poles.imag - at) < 0.9 * reach
    tried = at + side * 2 * np.pi * (frequency[-1] - frequency[0]) * np.array(_BESIDE if side else (0.0,))
    starts = [np.append(poles[local], -decay + 1j * place) for place in tried if place > 0.0]
    if near is not None and (not _within(frequency, near) if side else abs(near.imag - at) < 4 * abs(near.real)):
        apart = _APART * abs(near.real) * np.array([-1j, 1j])
        starts.append(np.append(poles[local & (poles != near)], near + apart))
    best = _best(frequency[about], response[:, about], noise[:, about], poles[local], starts)
    if best is None:
        return None
    more = _pruned(frequency, response, refined(frequency, response, np.concatenate([poles[~local], best]), noise))
    added = np.count_nonzero(_within(frequency, more.pole)) - np.count_nonzero(_within(frequency, poles))
    return more if len(more.pole) > len(poles) and (added == 0 if side else added > 0) else None


def _best(frequency, response, noise, poles, starts):
    """Poles that one of the ``starts`` leads to, more than the ``poles`` and with so much less left that it is no
    chance; None where there are none."""
    best, least = None, np.sum(_squares(response, refined(frequency, response, poles, noise), noise)) - (
        4.0 * _GAIN * (len(response) + 1))
    for start in starts:
        try:
            one = _pruned(frequency, response, refined(frequency, response, start, noise))
        except np.linalg.LinAlgError:
            continue
        if len(one.pole) > len(poles) and (squares := np.sum(_squares(response, one, noise))) < least:
            best, least = one.pole, squares
    return best


def _squares(response, fit, noise):
    """(n, f) squares of what a fit leaves over that of the ``noise`` (n, f)."""
    return abs(response - fit.fitted) ** 2 / noise**2


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


def _significant(fit, frequency):
    """(m,) whether the residues of a mode exceed their errors and rounding, and its pole is known and decays, if in the
    band."""
    size = abs(fit.residue)
    faint = (size <= _FAINT * size.max(axis=0, initial=0.0)).all(axis=1)
    strength = np.sqrt(np.mean((abs(fit.residue) / np.maximum(fit.residue_std, 1e-300)) ** 2, axis=1))
    known = (fit.std[:, 1] < 0.5 * np.maximum(abs(fit.pole.real), _FREQUENCY * abs(fit.pole))) & (fit.away < _SETTLED)
    inside, about = (_within(band, fit.pole) for band in (frequency, 2 * frequency - frequency[::-1]))
    return (strength > _SEEN) & ~faint & (fit.damping_ratio < _DAMPED) & np.where(inside, known, about)


def _told(diagram, poles):
    """The diagram with the mode that each stable pole became."""
    if not len(poles) or not len(diagram.pole):
        return diagram
    distance = abs(diagram.pole[:, None] - poles[None, :])
    nearest = distance.argmin(axis=1)
    reach = np.maximum(_ONE * abs(poles[nearest].real), _FREQUENCY * abs(poles[nearest]))
    close = (distance[np.arange(len(nearest)), nearest] < reach) & diagram.stable
    return replace(diagram, chosen=np.where(close, nearest, -1))
