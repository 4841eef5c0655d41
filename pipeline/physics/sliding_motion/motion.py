"""Motion of a sliding system from small to large: its modes, its contact patches, and integration over time.

    system = sliding_motion(model, closure, friction, law, modes, ...)      # once an operating point
    run = system.run(start, step=2e-6, duration=0.05)

The linear motion is that of the complex modes, root by root; what the contacts do beyond it (opening, stiffening,
sticking, friction that changes with load and slip) acts through patches of contacts.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.contact.closure_law import force_at_rest
from pipeline.physics.friction.dry_friction import FACTOR, READ_AT, at_one_distance, characteristic, kernel
from pipeline.physics.friction.state_kernels import MEMORY, StateKernel, settles
from pipeline.physics.friction.state_variables import factors, started, state_kernel
from pipeline.physics.sliding.model import FrictionState
from pipeline.physics.sliding_motion.attached_elements import AttachedKernel, attached, beyond_slopes
from pipeline.physics.sliding_motion.exponential_step import (
    ADDED,
    DEPTH,
    DONE,
    LOSS,
    STORED,
    WORK,
    EnergyKernel,
    Record,
    advance,
    modal_rate,
    step_kernel,
)
from pipeline.physics.sliding_motion.patch_forces import PatchKernel, beyond_linear, foresee
from pipeline.physics.sliding_motion.patches import contact_patches
from pipeline.physics.stability.linearisation import element_rows
from pipeline.physics.time_stepping.normal_laws import normal_kernel

#: rows of the tables of normal force on either side of steady sliding, and the share of the law that they span at least
_ROWS, _RESTING, _LAWS = 1600, 2400, 4
#: of a motion whose energy is not kept
NO_BOOK = EnergyKernel(*np.empty((4, 0, 0)))
#: into how many parts a step without a solution is cut, again and again, and the most
_PARTS, _FINEST = 4, 64


@dataclass(frozen=True)
class Run:
    """States (r, m) at ``time`` (r,) s; ``open`` and ``stick`` (r,) shares of contacts and patches; energies (r,) J
    since the begin (0 without a book): ``work`` of the contact forces, ``loss`` in bodies and joints, ``added`` in the
    damping of moved roots, ``stored``; ``sweeps`` a step of the iteration; ``end``, where another run may start."""

    time: np.ndarray
    state: np.ndarray
    open: np.ndarray
    stick: np.ndarray
    work: np.ndarray
    loss: np.ndarray
    added: np.ndarray
    stored: np.ndarray
    sweeps: float
    end: tuple

    @property
    def imbalance(self):
        """Largest error of the energy balance over the largest energy that has passed; 0 without a book."""
        passed = [each - each[0] for each in (self.stored, self.work, self.loss, self.added)]
        error, largest = passed[0] - passed[1] + passed[2] + passed[3], max(abs(each).max() for each in passed)
        return float(abs(error).max() / largest) if largest else 0.0


@dataclass(frozen=True)
class SlidingMotion:
    """A sliding system about steady sliding: its SlidingModes and PatchKernel, which entries of a Settling of its
    contacts the states (s, 2) of friction are, its AttachedKernel and what elements have ``held`` (h,), rows of patches
    and elements (4p, 2m) and modal forces (3p, 2m) as in a StepKernel, and the forms of its energy."""

    modes: object
    patches: PatchKernel
    settling: np.ndarray
    attached: AttachedKernel
    held: np.ndarray
    motion: np.ndarray
    force: np.ndarray
    energy: EnergyKernel

    def velocity_rows(self, rows):
        """(r, m): Re(result @ z) is the velocity along ``rows`` (r, n)."""
        modes = self.modes
        return modes.weight * ((rows @ modes.basis) @ modes.right) * modes.own

    def run(self, start, step, duration, every=1, book=False, settled=None):
        """Run from ``start``: modal coordinates (m,), or the ``end`` of an earlier run, kept every so many steps.

        ``settled`` (k,): what the entries of a Settling of the contacts begin with, else 0.
        Raises ConfigError without a step, ConvergenceError with the time where a step has no solution.
        """
        count = round(duration / step) if step > 0 else 0
        if count < every:
            raise ConfigError("sliding motion: step", "a positive step, at most as long as the motion",
                              f"{step:g} s for {duration:g} s")
        begin = start if isinstance(start, tuple) else self._begin(start, settled)
        state, past, *memory = (each.copy() for each in begin)
        rows = count // every
        record = Record(np.empty((rows, len(state))), np.empty((rows, 2)), np.zeros((rows, 4)))
        energy = self.energy if book else NO_BOOK
        sweeps = self._advance((state, past, *memory), step, count, every, record, energy)
        half, energies = len(state) // 2, record.energy.T
        return Run(step * every * np.arange(1, rows + 1), record.state[:, :half] + 1j * record.state[:, half:],
                   *record.share.T, energies[WORK], energies[LOSS], energies[ADDED], energies[STORED], sweeps / count,
                   (state, past, *memory))

    def _advance(self, motion, step, count, every, record, energy):
        """Sweeps of all steps; a step that has no solution is taken in finer ones."""
        done, sweeps, spent, none = 0, 0, np.zeros(3), Record(*np.empty((2, 0, 0)), np.empty((0, 4)))
        while done < count:
            code, number, more = advance(self.patches, self.attached, self._kernel(step), energy, *motion[:2],
                                         motion[2:], done, count, every, record, spent)
            done, sweeps = number, sweeps + more
            parts, before = 1, tuple(each.copy() for each in (*motion, spent))
            while code != DONE:
                parts *= _PARTS
                for each, value in zip((*motion, spent), before, strict=True):
                    each[:] = value
                if parts > _FINEST:
                    raise ConvergenceError(f"sliding motion at t = {number * step:.6g} s", "contact forces that settle",
                                           "none after the last iteration", "lower limit_cycle.patch"
                                           " or limit_cycle.step, or raise limit_cycle.stick_speed")
                code, _, more = advance(self.patches, self.attached, self._kernel(step / parts), energy, *motion[:2],
                                        motion[2:], 0, parts, parts + 1, none, spent)
                sweeps += more
        return sweeps

    def _kernel(self, step):
        """StepKernel of steps of ``step`` s, made once."""
        if step not in self._kernels:
            self._kernels[step] = step_kernel(self.modes.root, self.motion, self.force, step)
        return self._kernels[step]

    @cached_property
    def _kernels(self):
        return {}

    def _begin(self, start, settled=None):
        """(state, forces beyond the linear ones, as if they had always been, and what is remembered, see ``advance``)
        at modal coordinates (m,), as in steady sliding."""
        patches, attached, p = self.patches, self.attached, len(self.force) // 3
        state, rest = np.concatenate((start.real, start.imag)), np.zeros((3, p))
        value = started(patches.states, patches.load, patches.speed)
        held = self.held.copy()
        if settled is not None:
            value += np.where(self.settling < 0, 0.0, settled[self.settling])
            held[attached.branch] += settled[len(settled) - len(attached.branch):]
        seen = np.array([[patches.load, abs(patches.speed), abs(patches.drawn)]] * 2)
        foresee(patches, value, seen, 0.0)
        y, slope = (self.motion @ state).reshape(4, -1), np.zeros((3, 4, p))
        beyond_linear(patches, y, rest, slope)
        beyond_slopes(attached, held, attached.place, 0.0, y, rest, slope, held.copy())
        begun = attached.place + y[0, len(patches.load):]
        return state, np.array([rest] * DEPTH), value, seen, held, begun, np.zeros(1)

    def rate(self, start):
        """dz/dt (m,) at modal coordinates (m,): for other integrators and for tests."""
        change, half = self.real_rate(np.concatenate((start.real, start.imag))), len(start)
        return change[:half] + 1j * change[half:]

    def real_rate(self, state):
        """The same in real coordinates (Re z, Im z), (2m,)."""
        change = np.empty(len(state))
        modal_rate(self.patches, self.motion, self.force, self._root, state, change)
        return change

    @cached_property
    def _root(self):
        return np.array([self.modes.root.real, self.modes.root.imag])

    def reaching(self, coordinates):
        """Modal ``coordinates`` (m,) times what makes a patch move by the scale of the contact law over a period."""
        rows = self.motion[:len(self.patches.load)]
        moved = (rows @ np.concatenate((part.real, part.imag)) for part in (coordinates, 1j * coordinates))
        return self.patches.scale / max(np.hypot(*moved).max(), np.finfo(float).tiny) * coordinates

    @cached_property
    def reach(self):
        """(m,) amplitude of each modal coordinate at which a patch moves by the scale of the contact law."""
        m, p = len(self.modes.root), len(self.patches.load)
        largest = np.hypot(self.motion[:p, :m], self.motion[:p, m:]).max(axis=0)
        return self.patches.scale / np.maximum(largest, np.finfo(float).tiny)


def sliding_motion(model, closure, friction, law, modes, group, size, stick_speed, slopes=None, rest=None,
                   turns=True):
    """SlidingMotion of a SlidingModel linearised about its contacts.

    ``closure`` (c,) m in steady sliding; ``friction``: Friction of the contacts, whose states settle; ``law``: Table;
    ``modes``: SlidingModes; ``group`` (c,) number of the face of each contact, ``size`` (contacts in a patch at
    most, patches of a face at most): see ``contact_patches``; ``stick_speed`` m/s; ``slopes`` (2, e) of the elements of
    the model, and their elongations (e,) m and memory (s,), or None, at ``rest``; both None without any. ``turns``:
    whether friction turns with the slip, as by an element for it.
    """
    contacts = model.contacts
    patches = contact_patches(contacts.position, contacts.stiffness, group, *size)
    springs, (place, memory) = element_rows(model), ((), None) if rest is None else rest
    elements = attached(model.elements, place, np.zeros((2, 0)) if slopes is None else slopes, memory, model.speed)
    rows = np.vstack([np.vstack((patches.mean @ each, own)) @ modes.basis for each, own in (
        (contacts.normal, springs), (contacts.tangent, 0 * springs), (contacts.lateral, 0 * springs))])
    position, force = modes.weight * (rows @ modes.right), rows @ modes.left
    p = len(rows) // 3
    return SlidingMotion(
        modes, *_patch_kernel(model, closure, friction, law, patches, stick_speed, turns), *elements,
        np.ascontiguousarray(_real(np.vstack((position[:p], position * modes.own)))),
        np.ascontiguousarray(np.hstack((force.real, force.imag))), _energy(model, modes))


def _real(rows):
    """(r, 2m) of complex rows (r, m): their real part at (Re z, Im z)."""
    return np.hstack((rows.real, -rows.imag))


def _patch_kernel(model, closure, friction, law, patches, stick_speed, turns):
    contacts = model.contacts
    normal, dry = normal_kernel(law, contacts), kernel(friction, len(contacts.area))
    lowest, interval, force, closed = _normal_tables(normal, closure, patches)
    load, speed = patches.summed(contacts.preload), patches.mean @ model.sliding_speed
    dry, per_load = at_one_distance(dry), 1 / patches.summed(contacts.area)
    np.divide(patches.summed(contacts.preload * contacts.pressure), load**2, out=per_load, where=load > 0)
    first = patches.member[patches.first[:-1]]
    states, settling = _states(friction, len(contacts.area), first, 1 / per_load)
    dry = dry._replace(contact=dry.contact[first])
    dry.contact[:, FACTOR] *= factors(states, started(states, load, speed), 0.0)
    mu, over_pressure, over_slip = np.array([
        characteristic(dry, i, load[i] * per_load[i], abs(speed[i]), dry.contact[i, READ_AT], speed[i])[:3]
        for i in range(len(load))]).T
    load, stiffness, damping = force[:, _RESTING], *map(patches.summed, (contacts.stiffness, contacts.damping))
    at_once = np.ones(len(load))
    at_once[states.contact[states.kind == MEMORY]] = 0.0
    coupling = at_once * np.sign(speed) * FrictionState(mu, over_pressure).load_slope(load * per_load)
    linear = np.array([stiffness, damping, coupling * stiffness, coupling * damping, at_once * load * over_slip,
                       turns * np.divide(mu * load, abs(speed), out=np.zeros(len(load)), where=speed != 0)])
    return PatchKernel(
        lowest, interval, force, closed, len(closure), normal.damping_speed[first], load, np.sign(speed) * mu * load,
        speed, per_load, dry, states, linear, float(stick_speed), float(turns),
        float(load.sum() / stiffness.sum())), settling


def _states(friction, count, first, area):
    """(StateKernel of the states that settle at patches of ``area`` (p,) m^2, each with the laws of its ``first`` (p,)
    contact of ``count``; their entries (s, 2) in a Settling of the contacts, -1 for none)."""
    whole, patch = state_kernel(friction, np.ones(count)), np.full(count, -1)
    patch[first] = np.arange(len(first))
    entries = np.where(settles(whole), 1 + (whole.kind == MEMORY), 0)
    begin, kept = np.cumsum(entries) - entries, (patch[whole.contact] >= 0) & (entries > 0)
    settling = np.column_stack((begin, np.where(entries > 1, begin + 1, -1)))[kept]
    return StateKernel(whole.kind[kept], patch[whole.contact[kept]], whole.parameter[kept], np.array(area, float),
                       whole.begin[first]), settling


def _normal_tables(law, closure, patches):
    """(first displacement m, interval m, force (p, k) N, closed contacts (p, k)) of the patches over displacement.

    Steady sliding is the row _RESTING; the tables end where no contact is closed.
    """
    reach = max(closure.max(), law.closure[-1] / _LAWS)
    interval = reach / _ROWS
    moved = interval * np.arange(-_RESTING, _ROWS + 2)
    force, closed = np.zeros((2, len(closure), len(moved)))
    for j, area in enumerate(law.area):
        rise = law.pressure[law.first[j]:law.first[j] + len(law.closure)]
        force[j] = force_at_rest(closure[j] - moved, np.full(len(moved), area), law.closure, rise)[0]
        closed[j] = closure[j] > moved
    grouped = (np.add.reduceat(each[patches.member], patches.first[:-1], axis=0) for each in (force, closed))
    return float(moved[0]), float(interval), *map(np.ascontiguousarray, grouped)


def _energy(model, modes):
    """EnergyKernel of bodies and joints, on which the contacts do work."""
    mass, damping, stiffness = (modes.basis.T @ each @ modes.basis for each in model.supported(gyroscopic=False))
    right = modes.weight * modes.right
    position, rate = _real(right), _real(right * modes.own)
    moved, quickened = (_real(each * (modes.root - modes.own)) for each in (right, right * modes.own))
    contact = -(rate.T @ (modes.damping - damping) @ rate + rate.T @ (modes.stiffness - stiffness) @ position)
    added = -(position.T @ stiffness @ moved + rate.T @ mass @ quickened)
    forms = (0.5 * (position.T @ stiffness @ position + rate.T @ mass @ rate), contact, rate.T @ damping @ rate, added)
    return EnergyKernel(*(np.ascontiguousarray((form + form.T) / 2) for form in forms))
