"""Where modes of sliding on one hard contact coalesce, read off two receptances.

Undamped bodies with modes of squared frequency w_j, whose contact moves by a_j along the normal and t_j along the
tangent, are in steady sliding with s mu (s = sign of the sliding velocity, so that T = s mu N) at the roots L = w^2 of

    G_nn(L) + s mu G_nt(L) = 0,    G_nn = sum_j a_j^2 / (w_j - L),    G_nt = sum_j a_j t_j / (w_j - L),             (1)

which is n q = 0 under the force (n + s mu t) N. So every frequency has its friction, mu(L) = -s G_nn / G_nt: modes at
mu are where this curve passes it. At a maximum two of them meet and flutter begins, at a minimum flutter ends.
"""

from dataclasses import dataclass

import numpy as np

#: a change of friction from sample to sample that tells a pole of the curve from a maximum
_POLE = 0.2


@dataclass(frozen=True)
class ContactModes:
    """``squared`` (m,) rad^2/s^2 of the bodies apart, ``normal`` and ``tangent`` (m,) 1/kg^0.5 at the contact."""

    squared: np.ndarray
    normal: np.ndarray
    tangent: np.ndarray


@dataclass(frozen=True)
class Coalescences:
    """Frequencies (Hz) of the modes without friction; frequency and friction where flutter begins and ends."""

    frictionless: np.ndarray
    onset_frequency: np.ndarray
    onset_friction: np.ndarray
    end_frequency: np.ndarray
    end_friction: np.ndarray


def friction_over_frequency(modes, frequency, direction):
    """(G_nn, mu), each (k,), of equation (1) at ``frequency`` (k,) Hz; ``direction`` is s, 1 or -1."""
    receptance = 1 / (modes.squared[:, None] - (2 * np.pi * frequency) ** 2)
    direct, cross = (modes.normal * np.array([modes.normal, modes.tangent])) @ receptance
    with np.errstate(divide="ignore"):
        return direct, -direction * direct / cross


def coalescences(modes, frequency, direction, most=0.5):
    """Coalescences on the samples ``frequency`` (k,) Hz, rising, for friction between 0 and ``most``.

    Maxima and minima are refined by a parabola; modes nearer than two samples are not told apart.
    """
    direct, friction = friction_over_frequency(modes, frequency, direction)
    rising = np.flatnonzero((direct[:-1] < 0) & (direct[1:] >= 0))
    share = -direct[rising] / (direct[rising + 1] - direct[rising])
    frictionless = frequency[rising] + share * (frequency[rising + 1] - frequency[rising])
    tops, ends = (_peaks(frequency, sign * friction) for sign in (1, -1))
    ends = ends[0], -ends[1]
    kept = [(value > 0) & (value < most) for _, value in (tops, ends)]
    return Coalescences(frictionless, tops[0][kept[0]], tops[1][kept[0]], ends[0][kept[1]], ends[1][kept[1]])


def _peaks(x, y):
    """(places, heights) of the maxima of a curve with poles."""
    before, after = y[1:-1] - y[:-2], y[2:] - y[1:-1]
    top = 1 + np.flatnonzero((before > 0) & (after <= 0) & (before < _POLE) & (-after < _POLE))
    slope, bend = (y[top + 1] - y[top - 1]) / 2, y[top + 1] - 2 * y[top] + y[top - 1]
    move = -slope / bend
    return x[top] + move * (x[top + 1] - x[top - 1]) / 2, y[top] + move * slope / 2
