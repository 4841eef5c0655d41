"""Equations of motion in weak form: linear in all values and in every law of a library.

    integral of phi (m_i x_i'' + sum_l R_li (k_l e_l + c_l e_l' + F)) = integral of phi f_i,

phi = (1 - (t - t_j)^2 / T^2)^4, derivatives moved onto it: D. A. Messenger, D. M. Bortz, Multiscale Model. Simul. 19
(2021) 1474. Laws see smoothed motion (A. Savitzky, M. J. E. Golay). What sensors do is undone: x(t) = y(t + d) +
y'(t + d) / w.
"""

from dataclasses import dataclass

import numpy as np
from scipy.signal import savgol_filter

#: half width of test functions and distance between them, s; the smoothing, samples and order
_HALF, _APART, _SMOOTH = 0.2, 0.04, (9, 3)


@dataclass(frozen=True)
class Term:
    """A law of the library: its name and place as a diagnosis calls them."""

    name: str
    place: str
    kind: str = "physics"


@dataclass(frozen=True)
class Equations:
    """``target`` (row,), ``nominal`` (row, value) of values that are fitted, ``library`` {Term: (row,)}."""

    target: np.ndarray
    nominal: np.ndarray
    library: dict

    def residual(self, terms=(), fitted=None):
        """(row,) left by the nominal values and the ``terms``, fitted to these equations, or as others ``fitted``."""
        columns = self.columns(terms)
        return self.target - columns @ (self.fit(terms) if fitted is None else fitted)

    def fit(self, terms=()):
        """Values of the nominal model, then of the ``terms``, by least squares."""
        return np.linalg.lstsq(self.columns(terms), self.target, rcond=None)[0]

    def columns(self, terms):
        """(row, value) of the nominal values and the ``terms``."""
        return np.column_stack([self.nominal, *(self.library[term] for term in terms)])


def equations(rig, runs):
    """Equations of a Rig in some of its runs."""
    parts = [_of_run(rig, run) for run in runs]
    return Equations(*(np.concatenate([getattr(p, name) for p in parts]) for name in ("target", "nominal")),
                     {term: np.concatenate([p.library[term] for p in parts]) for term in parts[0].library})


def _of_run(rig, run):
    weak = _Weak(rig, run)
    known, nominal = np.zeros(weak.shape), []
    pieces = [(f"masses.{name}", rig.mass[i], weak.only(i, weak.inertia[i])) for i, name in enumerate(rig.masses)]
    for k, (name, row) in enumerate(zip(rig.joints, rig.rows, strict=True)):
        pieces.append((f"joints.{name}.stiffness", rig.stiffness[k], weak.along(row, row @ weak.place)))
        pieces.append((f"joints.{name}.damping", rig.damping[k], weak.along(row, row @ weak.rate)))
    for name, value, column in pieces:
        if name in rig.free:
            nominal.append(column)
        else:
            known = known + value * column
    if rig.contact is not None:
        nominal.append(weak.law(rig.contact, -run.load * np.sign(weak.slip)))
    library = {term: column.ravel() for term, column in _library(rig, run, weak)}
    return Equations((weak.push - known).ravel(), np.column_stack([c.ravel() for c in nominal]), library)


def _library(rig, run, weak):
    """(Term, (mass, function)) of every law at every place."""
    for name, row in zip(rig.joints, rig.rows, strict=True):
        e, v = row @ weak.moved, row @ weak.speed
        laws = {"coulomb": np.sign(v), "asymmetric_friction": (v > 0) * 1.0, "cubic_stiffness": e**3,
                "quadratic_stiffness": e**2, "quadratic_damping": v * abs(v), "thermal_softening": -weak.time * e}
        if f"joints.{name}.damping" not in rig.free:
            laws["joint_damping"] = v
        if f"joints.{name}.stiffness" not in rig.free:
            laws["compliant_arm"] = -e
        for law, force in laws.items():
            yield Term(law, name), weak.law(row, force)
    for i, name in enumerate(rig.masses):
        if f"masses.{name}" not in rig.free:
            yield Term("attached_mass", name), weak.only(i, weak.inertia[i])
        yield Term("added_stiffness", name), weak.only(i, weak.place[i])
        shift = (rig.rows.T * rig.stiffness) @ rig.rows[:, i]
        yield Term("sensor_offset_drift", rig.channels[i], "sensor"), np.outer(shift, weak.ones)
    if rig.contact is not None:
        slip, drawn = weak.slip, run.load * np.sign(weak.slip)
        typical = np.sqrt(np.mean(slip**2))
        for law, force in {"falling_friction": drawn * np.exp(-abs(slip) / typical), "viscous": run.load * slip,
                           "pressure_dependent_friction": drawn * run.load,
                           "directional_friction": abs(drawn)}.items():
            yield Term(law, "contact"), weak.law(rig.contact, -force)


class _Weak:
    """Integrals of a run over all test functions: ``place``, ``rate``, ``inertia``, ``push`` (mass, function)."""

    def __init__(self, rig, run):
        step = 1 / rig.rate
        count = run.shown.shape[1]
        self.time = step * np.arange(count)
        centres = np.arange(_HALF + 2 * step, self.time[-1] - _HALF - max(d for d, _ in rig.sensors) - step, _APART)
        self._phi = step * _bump(self.time[None] - centres[:, None])
        self.ones = self._phi.sum(axis=1)
        seen = [[_seen(self.time, centres, delay, corner, y, step, order) for order in (0, 1, 2)]
                for (delay, corner), y in zip(rig.sensors, run.shown, strict=True)]
        self.place, self.rate, self.inertia = np.array(seen).transpose(1, 0, 2)
        self.push = run.push @ self._phi.T
        self.shape = self.place.shape
        smooth = [_undone(self.time, y, delay, corner, step) for (delay, corner), y in zip(
            rig.sensors, run.shown, strict=True)]
        self.moved, self.speed = np.array(smooth).transpose(1, 0, 2)
        self.slip = None if rig.contact is None else run.belt - rig.contact @ self.speed

    def only(self, mass, values):
        """(mass, function) with ``values`` (function,) in the equation of one mass."""
        return np.outer(np.arange(self.shape[0]) == mass, values)

    def along(self, row, values):
        """(mass, function) of integrals (function,) of a force that resists along a row."""
        return np.outer(row, values)

    def law(self, row, force):
        """The same of its samples (n,)."""
        return np.outer(row, self._phi @ force)


def _bump(apart, order=0):
    """The test function (or a derivative of it up to the third) at distances ``apart`` s from its centre."""
    inside = np.clip(1 - (apart / _HALF) ** 2, 0, None)
    u = np.polynomial.Polynomial([1, 0, -1 / _HALF**2]) ** 4
    return np.where(inside > 0, u.deriv(order)(apart) if order else inside**4, 0.0)


def _seen(time, centres, delay, corner, shown, step, order):
    """(function,) of integrals of phi and the derivative of this order of x, from what its sensor showed."""
    apart = time[None] - delay - centres[:, None]
    lag = 0.0 if np.isinf(corner) else 1 / (2 * np.pi * corner)
    return (-1) ** order * step * (_bump(apart, order) - lag * _bump(apart, order + 1)) @ shown


def _undone(time, shown, delay, corner, step):
    """(displacement, velocity) (n,) of x, smoothed."""
    lag = 0.0 if np.isinf(corner) else 1 / (2 * np.pi * corner)
    y, rate, bend = (savgol_filter(shown, *_SMOOTH, deriv=k, delta=step) for k in range(3))
    return [np.interp(time + delay, time, value) for value in (y + lag * rate, rate + lag * bend)]

