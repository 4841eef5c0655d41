"""The linear part of a time step, compiled: pairs of states, the forces on them, their observables and energies."""

from typing import NamedTuple

import numpy as np

from pipeline.physics.numerics.compiled import borrowing, njit

#: sums may be reordered to use the width of the processor; nothing else is relaxed
_FAST = {"reassoc", "contract", "nsz"}


class LinearKernel(NamedTuple):
    """Linear step of m pairs under c contacts, i inputs and e elements: forces are N (c), T (c), inputs, elements."""

    step: np.ndarray        # (2, 2, m)
    first: np.ndarray       # (2 c + i + e, 2, m) effect of the forces at the begin of the step
    last: np.ndarray        # (2 c + i + e, 2, m) effect of the forces at its end, or of forces constant over it
    rows: np.ndarray        # (4 c, 2, m) observables: displacement, velocity along n, then along t
    response: np.ndarray    # (4, 2, c, c) of the observables to ``last``
    input_rows: np.ndarray  # (i, 2, m) displacement along the inputs
    sensors: np.ndarray     # (2 s, 2, m) displacement, then velocity
    constant_over_step: np.ndarray  # (2,) 1 where N, T are constant over the step
    omega_squared: np.ndarray   # (m,) squared frequencies, uncoupled
    damping: np.ndarray     # (m,) damping, uncoupled
    energy: np.ndarray      # (2m, 2m) energy form of coupled pairs, else empty
    power: np.ndarray       # (2m, 2m) loss form of coupled pairs, else empty
    impulse_response: np.ndarray    # (2 c, 2, m) effect at once of forces that are impulses; empty where none are


class HistoryKernel(NamedTuple):
    """Values at equal intervals from time 0, linear between or held until the next, constant beyond the last."""

    value: np.ndarray       # (samples, n)
    interval: float
    held: np.ndarray        # (n,) whether each is held until the next


@borrowing
def interpolate(history, time, values):
    """Fill ``values`` (n,) with those of a HistoryKernel at ``time``."""
    last = history.value.shape[0] - 1
    position = time / history.interval
    k = min(int(position), last)
    share = position - k
    for i in range(values.size):
        values[i] = history.value[k, i]
        if k < last:
            values[i] += share * (history.value[k + 1, i] - history.value[k, i])


@borrowing
def hold(history, middle, begin, end):
    """Fill ``begin`` and ``end`` (n,) of a step with the samples of a HistoryKernel that are held at its ``middle``."""
    k = min(int(middle / history.interval), history.value.shape[0] - 1)
    for i in range(begin.size):
        if history.held[i]:
            begin[i] = end[i] = history.value[k, i]


@borrowing
def copy(source, target):
    """Copy values (n,). A loop: numba compiles it in a tenth of the time of an assignment of arrays."""
    for i in range(source.size):
        target[i] = source[i]


@borrowing(fastmath=_FAST)
def advance(step, steady, begin, end):
    """Fill the pairs ``end`` (2, m) with a ``step`` (2, 2, m) from those at its ``begin``, and ``steady`` (2, m)."""
    for b in range(begin.shape[1]):
        first, second = begin[0, b], begin[1, b]
        end[0, b] = step[0, 0, b] * first + step[0, 1, b] * second + steady[0, b]
        end[1, b] = step[1, 0, b] * first + step[1, 1, b] * second + steady[1, b]


@borrowing(fastmath={"contract"})        # no sums here: the same bits wherever this is compiled into
def add_forces(columns, factors, pairs):
    """Add ``columns`` (n, 2, m) times ``factors`` (n,) to the pairs (2, m)."""
    for k in range(factors.size):
        factor = factors[k]
        if factor != 0.0:
            for b in range(pairs.shape[1]):
                pairs[0, b] += factor * columns[k, 0, b]
                pairs[1, b] += factor * columns[k, 1, b]


@borrowing(fastmath=_FAST)
def project_rows(rows, pairs, values):
    """Fill ``values`` (r,) with the rows (r, 2, m) of the pairs."""
    for k in range(values.size):
        total = 0.0
        for b in range(pairs.shape[1]):
            total += rows[k, 0, b] * pairs[0, b] + rows[k, 1, b] * pairs[1, b]
        values[k] = total


@njit(fastmath=_FAST)
def loss_rate(power, damping, pairs):
    """Power of the dampers, W."""
    if power.size:
        state = pairs.ravel()
        return state @ (power @ state)
    total = 0.0
    for b in range(pairs.shape[1]):
        total += damping[b] * pairs[1, b] ** 2
    return total


@njit
def stored_energy(energy, omega_squared, pairs):
    """Kinetic and strain energy, J."""
    if energy.size:
        state = pairs.ravel()
        return state @ (energy @ state)
    total = 0.0
    for b in range(pairs.shape[1]):
        total += pairs[1, b] ** 2 + omega_squared[b] * pairs[0, b] ** 2
    return 0.5 * total
