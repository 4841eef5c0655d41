"""Which orders a record holds: what stands out of the spectra over the angle, and stays while the speed changes."""

from dataclasses import dataclass

import numpy as np
import scipy

#: lines beside a tone whose power counts as its own, and equivalent noise bandwidth of Hann frames [lines]
_OWN, _BANDWIDTH = 2, 1.5
#: lines about an order whose median it must pass, by how much [dB], and in which share of the blocks: in noise alone a
#: line or its neighbours do so in one of a hundred
_ABOUT, _ABOVE, _OFTEN = 12, 9.0, 0.3
#: tones of constant frequency that are tried in the place of an order, lines from it at which one has passed, and least
#: number of blocks without it
_TONES, _PASSES, _LEAST = 40, 4.0, 4


@dataclass(frozen=True)
class Outstanding:
    """Orders that stand out, strongest first.

    order : (order,) median over the blocks in which it stands out
    amplitude : (order, block) [unit of the signal]
    sure : (order,) whether no tone of constant frequency could pass for it: the speed varies enough
    """

    order: np.ndarray
    amplitude: np.ndarray
    sure: np.ndarray


def strongest(orders, most):
    """Up to ``most`` Outstanding orders.

    An order stands out of the lines about it in the mean over the blocks and in a good part of them, and stays where it
    is while the speed changes: a tone of constant frequency falls in order as the speed rises.
    """
    power = np.square(orders.amplitude, dtype=float)
    mean = power.mean(axis=0)
    peaks = scipy.signal.find_peaks(_decibel(mean), prominence=_ABOVE)[0]
    peaks = [k for k in peaks if _OWN < k < len(mean) - _OWN - 1 and _outstanding(mean[None], k)[0]]
    sure = {k: stays for k in peaks if (stays := _stays(orders, power, k)) is not None}
    chosen = sorted(sure, key=lambda k: -mean[k])[:most]
    return Outstanding(np.array([_middle(orders.order, power, k) for k in chosen]),
                       np.array([_own_amplitude(power, k) for k in chosen]).reshape(-1, len(power)),
                       np.array([sure[k] for k in chosen], bool))


def _decibel(power):
    return 10.0 * np.log10(np.maximum(power, np.finfo(float).tiny))


def _outstanding(power, line):
    """(block,) whether a line of ``power`` (block, line), or one next to it, stands out of the lines about it."""
    away = np.clip(line + np.r_[-_ABOUT:-_OWN, _OWN + 1:_ABOUT + 1], 0, power.shape[1] - 1)
    return _decibel(power[:, line - 1:line + 2].max(axis=1)) >= _decibel(np.median(power[:, away], axis=1)) + _ABOVE


def _own_amplitude(power, line):
    """(block,) amplitude of a tone near a line, wherever it lies between two."""
    return np.sqrt(power[:, line - _OWN:line + _OWN + 1].sum(axis=1) / _BANDWIDTH)


def _middle(order, power, line):
    """Order of a peak between the lines, median over the blocks: exact for a steady tone in Hann frames."""
    rows = power[_outstanding(power, line)]
    side = np.where(rows[:, line + 1] >= rows[:, line - 1], 1, -1)
    ratio = np.sqrt(rows[np.arange(len(rows)), line + side] / np.maximum(rows[:, line], np.finfo(float).tiny))
    shift = side * np.clip((2.0 * ratio - 1.0) / (ratio + 1.0), 0.0, 0.5)
    return float(order[line] + np.median(shift) * (order[1] - order[0]))


def _stays(orders, power, line):
    """True where a line stands out in a good part of the blocks, also of those that are left without the ones in which
    any one tone of constant frequency passes it; False where such a tone leaves too few blocks to say so, else None."""
    there, spacing, sure = _outstanding(power, line), orders.order[1], True
    if there.mean() < _OFTEN:
        return None
    passing = orders.order[line] * orders.speed
    for steady in np.linspace(passing.min(), passing.max(), _TONES):
        away = abs(steady / orders.speed / spacing - line) > _PASSES
        if away.sum() < _LEAST:
            sure = False
        elif there[away].mean() < _OFTEN:
            return None
    return sure
