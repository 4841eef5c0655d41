"""What is left of the equation of motion of a bench when measured motions and forces are put into it.

    r = M q'' + C q' + K q + sum_k b_k F_k - sum_i (n_i N_i + t_i T_i) - f        (n, samples), N

r is linear in every parameter that the forces are linear in, which makes it the cheap test of a missing term: no
simulation, no start state. Displacements are filtered without shift in phase before they are differentiated, the forces
of inputs, elements and contacts in the same way, so that what is linear closes whatever the corner; r is filtered once
more before it is decimated (Gautier, Janot & Vandanjon, IEEE Trans. Control Syst. Technol. 21 (2013) 428).
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.contact.groups import read
from pipeline.physics.friction.state_variables import friction_along
from pipeline.physics.numerics.compiled import njit
from pipeline.physics.numerics.spline_derivatives import derivatives
from pipeline.physics.time_stepping.coupled_solver import advance_wear, no_memory, surface_shift
from pipeline.physics.time_stepping.element_forces import DRY, element_force, update_turning_dampers
from pipeline.physics.time_stepping.elements import alone, wave_table
from pipeline.physics.time_stepping.normal_laws import force_along
from pipeline.physics.virtual_rig.inputs import holding, run_inputs
from pipeline.physics.virtual_rig.response import run_drive, run_friction
from pipeline.physics.virtual_rig.sensor import DISPLACEMENT

_SMALLEST_SHARE = 1e-9
#: standard deviations of a rate below which it does not tell rest from sliding
_RESTING = 3.0


class Motion(NamedTuple):
    """``displacement`` m, ``speed`` m/s and ``acceleration`` m/s^2 of the coordinates, each (n, samples)."""

    displacement: np.ndarray
    speed: np.ndarray
    acceleration: np.ndarray

    def thinned(self, decimation, trim):
        """The motion thinned out like the residual."""
        return Motion(*(thinned(values, decimation, trim) for values in self))


class Filter(NamedTuple):
    """Second-order ``sections`` (s, 6), the ``state`` (s, 2) in which they pass a constant of 1 on, and how many
    samples are added at both ends before it is run forth and back."""

    sections: np.ndarray
    state: np.ndarray
    ends: int


class Resting(NamedTuple):
    """Rigid dry friction along ``row`` (n,) while it rests, for a ``share`` (samples,) of each sample: any force of the
    element from -``backward`` to ``forward`` N."""

    row: np.ndarray
    share: np.ndarray
    forward: float
    backward: float


def equation_residual(bench, run, measured, corner=None, order=4, decimation=1, trim=0):
    """Residual (n, samples) of measured displacements ``measured`` {channel: (samples,)} and the inputs of ``run``.

    ``corner`` Hz of the Butterworth filter (``order``, run forth and back), None for none; every ``decimation``-th
    sample is kept, behind a low pass; ``trim`` samples are left out at both ends first. Channels are read as the bench
    scales them. Raises ConfigError where the channels do not give every coordinate, or a contact does not yield.
    """
    motion = moving(smoothed(bench, run, measured, corner, order), 1 / run.sample_rate, corner)
    return thinned(forces_missing(bench, run, motion, corner, order), decimation, trim)


def smoothed(bench, run, measured, corner=None, order=4):
    """Displacements (n, samples) of the coordinates behind the low pass of ``equation_residual``."""
    motion = coordinates(bench, run, measured)
    if corner is not None and not 0 < corner < run.sample_rate / 2:
        raise ConfigError("equation residual: corner", f"between 0 and {run.sample_rate / 2:g} Hz", f"{corner:g} Hz")
    return below(run, motion, corner, order)


def applied_force(bench, run, decimation=1, trim=0, corner=None):
    """Forces (n, samples) of the inputs of ``run`` on the coordinates, filtered and thinned out like the residual."""
    return thinned(below(run, _applied(bench, run), corner), decimation, trim)


def below(run, values, corner, order=4):
    """Values (n, samples) behind the low pass of ``equation_residual``; as they are without a ``corner``."""
    return values if corner is None else _forth_and_back(_low_pass(order, 2 * corner / run.sample_rate), values)


def thinned(values, decimation, trim):
    """Every ``decimation``-th of the samples (n, samples) behind a low pass, ``trim`` left out at both ends first."""
    values = values[:, trim:values.shape[1] - trim]
    return _forth_and_back(_before(decimation), values)[:, ::decimation] if decimation > 1 else values


def _forth_and_back(design, values):
    """(n, samples) behind a Filter, run forth and back over ends turned about their last sample, as by
    scipy.signal.sosfiltfilt, which finds the state of the sections anew each time. ConfigError for runs shorter than
    its ends."""
    sections, state, ends = design
    if values.shape[1] <= ends:
        raise ConfigError("equation residual: run", "as many samples as the filters need at its ends",
                          f"{values.shape[1]} samples, more than {ends} needed",
                          "take a longer stretch, decimate less, or state no corner")
    values = np.concatenate((2 * values[:, :1] - values[:, ends:0:-1], values,
                             2 * values[:, -1:] - values[:, -2:-ends - 2:-1]), axis=1)
    for _ in range(2):
        values = scipy.signal.sosfilt(sections, values, 1, state[:, None, :] * values[None, :, :1])[0][:, ::-1]
    return values[:, ends:values.shape[1] - ends]


@lru_cache
def _low_pass(order, corner):
    return _filter(scipy.signal.butter(order, corner, output="sos"))


@lru_cache
def _before(decimation):
    """The filter of scipy.signal.decimate: Chebyshev's first kind, order 8, 0.05 dB up to 0.8 of the new range."""
    return _filter(scipy.signal.cheby1(8, 0.05, 0.8 / decimation, output="sos"))


def _filter(sections):
    taps = 2 * len(sections) + 1 - min((sections[:, 2] == 0).sum(), (sections[:, 5] == 0).sum())
    return Filter(sections, scipy.signal.sosfilt_zi(sections), 3 * int(taps))


def coordinates(bench, run, measured):
    """Displacements (n, samples) that the displacement channels in ``measured`` show, gain, offset and delay undone."""
    channels, shares = channel_shares(bench, measured)
    return shares @ np.array([channel.measured(measured[channel.name], run.time) for channel in channels])


def channel_shares(bench, names):
    """(Displacement channels of a bench among ``names``, (n, c) what the coordinates are of each, in m per m)."""
    channels = [c for c in bench.channels if c.measurand == DISPLACEMENT and c.name in names]
    rows = np.reshape(np.array([bench.sensor(c.source) for c in channels], float), (-1, bench.model.size))
    share = np.linalg.svd(rows, compute_uv=False)
    if len(rows) < bench.model.size or share[-1] < _SMALLEST_SHARE * share[0]:
        raise ConfigError("equation residual", f"displacement channels that give all {bench.model.size} coordinates",
                          f"{len(rows)} channels", "measure more points, hold bodies, or simulate instead")
    return channels, np.linalg.pinv(rows)


def rate_doubt(bench, run, measured, corner, order=4):
    """Standard deviation (n, samples) in m/s that the speeds of ``smoothed`` displacements are known to: what an octave
    more of frequencies (without a ``corner``, the upper half of them) adds about every sample, noise or sharp turns.
    """
    motion, highest = coordinates(bench, run, measured), run.sample_rate / 2
    low, high = corner or highest / 2, 2 * corner if corner else highest
    less, more = (_forth_and_back(_low_pass(order, f / highest), motion) if f < highest else motion
                  for f in (low, high))
    added = np.gradient(more - less, 1 / run.sample_rate, axis=1)
    power = scipy.ndimage.uniform_filter1d(added**2, 2 * int(run.sample_rate / low) + 1, mode="nearest")
    return np.sqrt(np.maximum(power, 0.0))      # running sums round below 0


def forces_missing(bench, run, motion, corner=None, order=4):
    """r (n, samples) of a Motion, forces of inputs, elements and contacts up to the ``corner`` in Hz."""
    drawn = drawn_forces(bench, run, motion)[0]
    return linear_forces(bench, run, motion) + below(run, drawn - _applied(bench, run), corner, order)


def moving(displacement, interval, corner=None):
    """Motion of displacements (n, samples): behind a low pass by a spline; else by central differences, which hold
    noise back and are exact under held forces."""
    if corner is not None:
        return Motion(displacement, *derivatives(displacement, interval))
    speed = np.gradient(displacement, interval, axis=1, edge_order=2)
    inertia = np.gradient(speed, interval, axis=1, edge_order=2)
    inertia[:, 1:-1] = (displacement[:, 2:] - 2 * displacement[:, 1:-1] + displacement[:, :-2]) / interval**2
    return Motion(displacement, speed, inertia)


def linear_forces(bench, run, motion):
    """Forces (n, samples) of masses, joints and rotation that a Motion takes; the drive turns evenly for one thinned
    out."""
    model, (displacement, speed, acceleration) = bench.model, motion
    mass, damping, stiffness = model.supported(gyroscopic=False, centrifugal=False)
    turning = np.broadcast_to(run_drive(bench, run), displacement.shape[1])
    forces = mass @ acceleration + damping @ speed + stiffness @ displacement
    if turning.any():
        forces = forces + turning * (model.gyroscopic @ speed) + turning**2 * (model.centrifugal @ displacement)
    return forces


def drawn_forces(bench, run, motion, doubt=None):
    """(Forces (n, samples) of elements, less those of contacts, along a Motion, [Resting] that they are without).

    ``doubt`` as of ``rate_doubt``: with it rigid dry friction at rest is left out; None where speeds are exact.
    """
    model = bench.model
    if not len(model.contacts.area):
        return element_forces(bench, run, motion, model.elements, doubt)
    instants = _instants(bench, run)
    normal, drawn, slip = _contacts(bench, run, motion, instants)
    elements, resting = _elements(model.elements, motion, instants, drawn, slip, doubt)
    return elements - (model.contacts.normal.T @ normal + model.contacts.tangent.T @ drawn), resting


def element_forces(bench, run, motion, elements, doubt=None):
    """``drawn_forces`` of some Elements of a bench without contacts."""
    none = np.zeros((0, motion.displacement.shape[1]))
    return _elements(elements, motion, _instants(bench, run), none, none, doubt)


def _instants(bench, run):
    """(samples, 3): time in s, angle and speed of the drive."""
    time, turning = run.time, run_drive(bench, run)
    if not np.ndim(turning):
        return np.column_stack((time, turning * time, np.full(len(time), turning)))
    return np.column_stack((time, scipy.integrate.cumulative_trapezoid(turning, time, initial=0.0), turning))


def held_at_rest(residual, resting, noise):
    """(r less the friction (n, samples) that [Resting] may hold, share (n, samples) of its noise that this takes off).

    The ``noise`` (n,) N is that of r. A force that may lie anywhere up to F is known to F / sqrt(3) beforehand: beside
    more noise than that, what is seen of r is noise, and nothing is taken off.
    """
    taken = np.zeros_like(residual)
    for row, share, forward, backward in resting:
        square = max(row @ row, 1e-300)
        variance = (forward + backward)**2 / 12 * share**2
        likely = variance / np.maximum(variance + row**2 @ noise**2 / square**2, 1e-300)
        residual = residual + np.outer(row, likely * np.clip(-row @ residual / square, -backward * share,
                                                             forward * share))
        taken += np.outer(row**2 / square, 1 - (1 - likely)**2)
    return residual, np.clip(taken, 0.0, 1.0)


def _applied(bench, run):
    """Forces (n, samples) of the inputs. Central differences over a held force see the mean before and after."""
    forces = np.array([np.broadcast_to(f, run.samples) for f in run_inputs(bench, run)]).reshape(-1, run.samples)
    before = np.concatenate((forces[:, :1], forces[:, :-1]), axis=1)
    forces = np.where(holding(bench, run)[:, None], (before + forces) / 2, forces)
    return bench.model.input_rows.T @ forces


def _elements(elements, motion, instants, drawn, slip, doubt):
    """(sum_k b_k F_k (n, samples), [Resting] left out of it), contacts drawn at and slipping as said (c, samples)."""
    rows = np.array([e.row for e in elements], float).reshape(-1, len(motion.displacement))
    kernel, rate = alone(elements), rows @ motion.speed
    force, resting = _along(kernel, rows @ motion.displacement, rate, instants, no_memory(kernel), drawn, slip), []
    for k in () if doubt is None else np.flatnonzero((kernel.kind == DRY) & np.isinf(kernel.parameter[:, 0])):
        still = abs(rate[k]) < _RESTING * np.sqrt(rows[k]**2 @ doubt**2)
        force[k, still] = 0.0
        forward, backward = kernel.parameter[k, 1:3] * (1 + kernel.parameter[k, 3])
        resting.append(Resting(rows[k], still.astype(float), float(forward), float(backward)))
    return rows.T @ force, resting


@njit
def _along(kernel, elongation, rate, instants, memory, drawn, slip):
    """Forces (e, samples) along ``elongation`` and its ``rate`` (e, samples)."""
    force, memory_end = np.zeros_like(elongation), memory.copy()
    for s in range(elongation.shape[1]):
        instant = (instants[s, 0], instants[s, 1], instants[s, 2])
        if drawn.shape[0]:
            update_turning_dampers(kernel, drawn[:, s], slip[:, s], rate[:, s])
        for k in range(elongation.shape[0]):
            begin = elongation[k, max(s - 1, 0)]
            force[k, s] = element_force(kernel, k, elongation[k, s], rate[k, s], begin, memory, memory_end, instant)[0]
        for k in range(memory.size):
            memory[k] = memory_end[k]
    return force


def _contacts(bench, run, motion, instants):
    """(N, T, slip), each (c, samples), sliding everywhere."""
    contacts, fixed = bench.model.contacts, bench.model.contacts.fixed
    normal = np.where(fixed, contacts.preload, 0.0)[:, None] * np.ones(len(instants))
    shift = _surface(contacts, instants)
    gap = (read(bench.law, "gap", len(fixed))[:, None] + contacts.normal @ motion.displacement) + shift[0]
    opening = contacts.normal @ motion.speed + shift[1]
    slip = contacts.lever[:, None] * instants[:, 2] - contacts.tangent @ motion.speed
    wear = np.broadcast_to(contacts.wear, len(fixed))
    for i in np.flatnonzero(~fixed):
        if wear[i]:
            worn = _worn(bench, i, gap[i], opening[i], wear[i] * abs(slip[i]), instants[:, 0])
            gap[i], opening[i] = gap[i] + worn[0], opening[i] + worn[1]
        normal[i] = force_along(bench.law, i, contacts.area, -gap[i], -opening[i])
    drawn = friction_along(run_friction(bench, run), contacts.area, normal, slip, instants[:, 1], 1 / run.sample_rate)
    return normal, drawn, slip


def _surface(contacts, instants):
    """(2, c, samples): what waviness adds to gaps and opening rates."""
    shift = np.zeros((2, len(contacts.area), len(instants)))
    waves = wave_table(contacts.waviness)
    for s, instant in enumerate(instants if len(waves) else ()):
        surface_shift(waves, tuple(instant), shift[:, :, s])
    return shift


def _worn(bench, i, gap, opening, rate, time):
    """(2, samples): what wear adds to gap and opening rate of contact ``i``, rate (m/s) per normal force."""
    area = bench.model.contacts.area
    shift, worn, pace = np.zeros((2, len(time))), np.zeros(1), np.zeros(1)
    for s, interval in enumerate(np.diff(time, prepend=time[0])):
        shift[:, s] = worn[0] + interval * pace[0], pace[0]
        force = force_along(bench.law, i, area, -gap[s] - shift[0, s], -opening[s] - shift[1, s])
        advance_wear(rate[s:s + 1], np.reshape(force, 1), np.ones(1), np.zeros(1), interval, worn, pace)
    return shift
