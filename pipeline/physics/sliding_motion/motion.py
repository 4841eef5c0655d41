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
from pipeline.physics.friction.dry_friction import READ_AT, at_one_distance, characteristic, kernel
from pipeline.physics.sliding.model import FrictionState
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
from pipeline.physics.sliding_motion.patch_forces import PatchKernel, beyond_linear
from pipeline.physics.sliding_motion.patches import contact_patches
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
    """A sliding system about steady sliding: its SlidingModes and PatchKernel, rows of the patches (4p, 2m) and modal
    forces (3p, 2m) as in a StepKernel, and the forms of its energy."""

    modes: object
    patches: PatchKernel
    motion: np.ndarray
    force: np.ndarray
    energy: EnergyKernel

    def velocity_rows(self, rows):
        """(r, m): Re(result @ z) is the velocity along ``rows`` (r, n)."""
        modes = self.modes
        return modes.weight * ((rows @ modes.basis) @ modes.right) * modes.own

    def run(self, start, step, duration, every=1, book=False):
        """Run from ``start``: modal coordinates (m,), or the ``end`` of an earlier run, kept every so many steps.

        Raises ConfigError without a step, ConvergenceError with the time where a step has no solution.
        """
        count = round(duration / step) if step > 0 else 0
        if count < every:
            raise ConfigError("sliding motion: step", "a positive step, at most as long as the motion",
                              f"{step:g} s for {duration:g} s")
        state, past = (each.copy() for each in (start if isinstance(start, tuple) else self._begin(start)))
        rows = count // every
        record = Record(np.empty((rows, len(state))), np.empty((rows, 2)), np.zeros((rows, 4)))
        energy = self.energy if book else NO_BOOK
        sweeps = self._advance((state, past), step, count, every, record, energy)
        half, energies = len(state) // 2, record.energy.T
        return Run(step * every * np.arange(1, rows + 1), record.state[:, :half] + 1j * record.state[:, half:],
                   *record.share.T, energies[WORK], energies[LOSS], energies[ADDED], energies[STORED], sweeps / count,
                   (state, past))

    def _advance(self, motion, step, count, every, record, energy):
        """Sweeps of all steps; a step that has no solution is taken in finer ones."""
        done, sweeps, spent, none = 0, 0, np.zeros(3), Record(*np.empty((2, 0, 0)), np.empty((0, 4)))
        while done < count:
            code, number, more = advance(self.patches, self._kernel(step), energy, *motion, done, count, every, record,
                                         spent)
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
                code, _, more = advance(self.patches, self._kernel(step / parts), energy, *motion, 0, parts, parts + 1,
                                        none, spent)
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

    def _begin(self, start):
        """(state, contact forces beyond the linear ones, as if they had always been) at modal coordinates (m,)."""
        p = len(self.patches.load)
        state, rest = np.concatenate((start.real, start.imag)), np.zeros((3, p))
        beyond_linear(self.patches, (self.motion @ state).reshape(4, -1), rest, np.zeros((3, 4, p)))
        return state, np.array([rest] * DEPTH)

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

    @cached_property
    def reach(self):
        """(m,) amplitude of each modal coordinate at which a patch moves by the scale of the contact law."""
        m, p = len(self.modes.root), len(self.patches.load)
        largest = np.hypot(self.motion[:p, :m], self.motion[:p, m:]).max(axis=0)
        return self.patches.scale / np.maximum(largest, np.finfo(float).tiny)


def sliding_motion(model, closure, friction, law, modes, group, size, stick_speed):
    """SlidingMotion of a SlidingModel linearised about its contacts.

    ``closure`` (c,) m in steady sliding; ``friction``: Friction of the contacts, without states; ``law``: Table;
    ``modes``: SlidingModes; ``group`` (c,) number of the face of each contact, ``size`` (contacts in a patch at
    most, patches of a face at most): see ``contact_patches``; ``stick_speed`` m/s.
    """
    contacts = model.contacts
    patches = contact_patches(contacts.position, contacts.stiffness, group, *size)
    rows = np.vstack([patches.mean @ (each @ modes.basis)
                      for each in (contacts.normal, contacts.tangent, contacts.lateral)])
    position, force = modes.weight * (rows @ modes.right), rows @ modes.left
    p = len(patches.first) - 1
    return SlidingMotion(
        modes, _patch_kernel(model, closure, friction, law, patches, stick_speed),
        np.ascontiguousarray(_real(np.vstack((position[:p], position * modes.own)))),
        np.ascontiguousarray(np.hstack((force.real, force.imag))), _energy(model, modes))


def _real(rows):
    """(r, 2m) of complex rows (r, m): their real part at (Re z, Im z)."""
    return np.hstack((rows.real, -rows.imag))


def _patch_kernel(model, closure, friction, law, patches, stick_speed):
    contacts = model.contacts
    normal, dry = normal_kernel(law, contacts), kernel(friction, len(contacts.area))
    lowest, interval, force, closed = _normal_tables(normal, closure, patches)
    load, speed = patches.summed(contacts.preload), patches.mean @ model.sliding_speed
    dry, per_load = at_one_distance(dry), 1 / patches.summed(contacts.area)
    np.divide(patches.summed(contacts.preload * contacts.pressure), load**2, out=per_load, where=load > 0)
    first = patches.member[patches.first[:-1]]
    dry = dry._replace(contact=dry.contact[first])
    mu, over_pressure, over_slip = np.array([
        characteristic(dry, i, load[i] * per_load[i], abs(speed[i]), dry.contact[i, READ_AT], speed[i])[:3]
        for i in range(len(load))]).T
    load, stiffness, damping = force[:, _RESTING], *map(patches.summed, (contacts.stiffness, contacts.damping))
    coupling = np.sign(speed) * FrictionState(mu, over_pressure).load_slope(load * per_load)
    linear = np.array([stiffness, damping, coupling * stiffness, coupling * damping, load * over_slip,
                       np.divide(mu * load, abs(speed), out=np.zeros(len(load)), where=speed != 0)])
    return PatchKernel(
        lowest, interval, force, closed, len(closure), normal.damping_speed[first], load, np.sign(speed) * mu * load,
        speed, per_load, dry, linear, float(stick_speed), float(load.sum() / stiffness.sum()))


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
