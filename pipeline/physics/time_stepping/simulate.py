"""Transient motion of a SlidingModel with unilateral contacts and dry friction, on its real modes with open contacts.

    simulate(model, Hard(), constant(0.3), step=1e-6, duration=0.5) -> Motion

Displacements count from where nothing is loaded; contact i touches where n_i q + gap_i = 0 and gains the sliding
velocity v_i = lever_i W(t) of the drive. The linear part is stepped exactly for forces that are linear in time, so
that without events the step matters only for contact and friction forces; ``Lagrange``, and ``Penalty`` with a
``gamma``, step by Newmark's rule instead, for comparison; ``Forward`` sets its multipliers as explicit codes do.
Friction acts along the tangent rows: what turns sideways with the slip (equation (3) of the sliding model) is left
out. Nothing is accepted that has not converged.
"""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.contract.errors import ConfigError, ConvergenceError, LongStepError, UnsettledStepError
from pipeline.physics.friction.dry_friction import FACTOR, coefficient, constant, kernel
from pipeline.physics.friction.state_variables import factors, started, state_kernel
from pipeline.physics.time_stepping.contact_solver import JAMMED, OPEN, SLIP, SOLVED, STICK, TOO_LONG, UNCONVERGED
from pipeline.physics.time_stepping.coupled_solver import no_memory, surface_shift
from pipeline.physics.time_stepping.element_forces import TOO_STIFF, UNSETTLED
from pipeline.physics.time_stepping.first_loading import loaded
from pipeline.physics.time_stepping.kernel_arrays import elements_kernel, linear_kernel, matrices_of, refuse
from pipeline.physics.time_stepping.linear_step import HistoryKernel
from pipeline.physics.time_stepping.modal_integrator import modal_system
from pipeline.physics.time_stepping.normal_laws import (
    Forward,
    Hard,
    Lagrange,
    Penalty,
    Table,
    contiguous,
    normal_force,
    normal_kernel,
)
from pipeline.physics.time_stepping.rigid_friction import part_of, rigid_kernel
from pipeline.physics.time_stepping.step_loop import UNTURNED, Record, Schedule, State, System, integrate
from pipeline.physics.time_stepping.turning import turning_kernel

__all__ = ["Forward", "Hard", "History", "Lagrange", "Motion", "Penalty", "Start", "Table", "imposed", "simulate",
           "stepper"]


@dataclass(frozen=True)
class History:
    """``value`` (samples,) or (samples, n) every ``interval`` s from time 0; linear between, constant beyond.

    ``held``, one or (n,): forces that are held until the next sample instead, in steps that divide the interval.
    """

    value: np.ndarray
    interval: float
    held: np.ndarray | bool = False


@dataclass(frozen=True)
class Start:
    """Displacement and velocity (n,) at time 0; normal and friction force (c,) where they are known.

    ``memory`` (s,) of the elements, by default 0: those with memory draw with no force where the motion starts, or at
    ``relaxed`` (n,) m, from where they were loaded to the start; ``angle`` rad of the drive, ``age`` s that passed
    before, ``worn`` (c,) m that the contacts have receded by, which needs ``normal``; ``states`` (k, 2) of friction, by
    default settled.
    """

    displacement: np.ndarray
    velocity: np.ndarray
    normal: np.ndarray | None = None
    friction: np.ndarray | None = None
    memory: np.ndarray | None = None
    angle: float = 0.0
    age: float = 0.0
    worn: np.ndarray | None = None
    states: np.ndarray | None = None
    relaxed: np.ndarray | None = None

    def kicked(self, velocity):
        """The same with ``velocity`` (n,) added."""
        return replace(self, velocity=self.velocity + velocity)


@dataclass(frozen=True)
class Motion:
    """What is kept at ``time`` (r,): sensors (s, r), contacts (c, r), energies (r,) in J since time 0.

    ``normal_force`` and ``friction_force`` are means since the record before; ``status`` is 0 open, 1 sticking, 2
    sliding; ``status_share`` (c, 3) counts every step. ``stored`` is kinetic and strain energy of bodies and joints;
    ``sliding_loss`` the work of friction on the slip; ``normal_work`` and ``friction_work`` those of the contact
    forces on the bodies, ``element_work`` that of the elements; ``elongation`` and ``element_force`` are (e, r).
    """

    time: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray
    gap: np.ndarray
    normal_force: np.ndarray
    friction_force: np.ndarray
    slip: np.ndarray
    status: np.ndarray
    status_share: np.ndarray
    stored: np.ndarray
    input_work: np.ndarray
    damping_loss: np.ndarray
    normal_work: np.ndarray
    friction_work: np.ndarray
    sliding_loss: np.ndarray
    element_work: np.ndarray
    elongation: np.ndarray
    element_force: np.ndarray
    end: Start

    @property
    def imbalance(self):
        """Largest error of the energy balance over the largest energy that has passed; 0 without any."""
        given = self.input_work + self.normal_work + self.friction_work + self.element_work - self.damping_loss
        passed = max(abs(e).max() for e in (self.stored, self.input_work, self.damping_loss, self.friction_work,
                                            self.element_work))
        return abs(self.stored - self.stored[0] - given).max() / passed if passed else 0.0


def simulate(model, law, friction=None, *, step, duration, drive=None, inputs=None, record_every=1, start=None,
             system=None, book=True):
    """Motion of a SlidingModel over ``duration`` s in steps of ``step`` s, every ``record_every``-th kept.

    ``law``: Hard, Penalty, Table, Lagrange or Forward; ``friction``: Friction, none by default; either may be Grouped;
    ``drive``: speed of the drive in rad/s, a number or a History, by default that of the model; ``inputs``: forces (i,)
    N on the inputs, or their History; ``start``: Start, by default at rest in the origin; ``system``: the ModalSystem
    of the model, where many runs share it; ``book=False`` leaves out energy, the work of inputs and the loss of
    dampers. Raises ConfigError for a step too long, ConvergenceError with time and contact where a step has no
    solution.
    """
    return stepper(model, law, friction, step, system).run(duration, drive, inputs, record_every, start, book)


@dataclass(frozen=True)
class Stepper:
    """A SlidingModel with the arrays that steps of ``step`` s need, for runs that differ in loads, start and length.

    ``modes``: its ModalSystem; ``system``: what the compiled loop steps; ``matrices``: step matrices of the modes.
    """

    model: object
    modes: object
    step: float
    system: System
    matrices: tuple

    def run(self, duration, drive=None, inputs=None, record_every=1, start=None, book=True):
        """Motion over ``duration`` s; arguments and errors as of ``simulate``."""
        model, step = self.model, self.step
        steps = round(duration / step)
        if steps < 1 or record_every < 1:
            raise _no_step(f"{step:g} s for {duration:g} s")
        rest = np.zeros(model.size)
        start = Start(rest, rest) if start is None else start
        system = _fresh(self.system)
        if isinstance(drive, History) and len(drive.value) > 1:
            system = self._turned(system)
        state = _begin(model, self.modes, system, start, _speed_at_start(model, drive))
        record = _empty(system.linear, system.elements, steps // record_every + 1)
        schedule = Schedule(_history(model.speed if drive is None else drive, 1, "drive"), _inputs(model, inputs),
                            float(start.age), float(step), steps, int(record_every), bool(book))
        code, number, contact = integrate(system, schedule, state, record)
        if code != SOLVED:
            raise _failure(code, number * step, contact, step, model)
        end = Start(*self.modes.from_pairs(state.pairs), *state.force, state.memory, float(state.angle[0]),
                    start.age + steps * step, state.worn, state.friction)
        return _motion(record, step * record_every, steps, end)

    def _turned(self, system):
        """The System with terms of a drive whose speed varies; beside them switches of friction are not located."""
        model, modes = self.model, self.modes
        turning = turning_kernel(model, modes, self.matrices, varies=True)
        if turning.rows.size and system.rigid.index.size:
            linear = linear_kernel(model, modes, Hard(), system.friction, self.step, captured=True)
            elements = elements_kernel(model, modes, linear, captured=True)
            rigid = rigid_kernel(model, modes, captured=True)
            system = system._replace(linear=linear, elements=elements, rigid=rigid, part=part_of(rigid, elements))
        return system._replace(turning=turning)


def stepper(model, law, friction, step, system=None):
    """Stepper of a SlidingModel; arguments and errors as of ``simulate``."""
    if not step > 0:
        raise _no_step(f"{step:g} s")
    modes, count = modal_system(model) if system is None else system, len(model.contacts.area)
    friction = friction or constant(0.0)
    normal, dry = normal_kernel(law, model.contacts), kernel(friction, count)
    captured, states = count > 0, state_kernel(friction, model.contacts.area)
    linear = linear_kernel(model, modes, law, dry, step, captured)
    refuse(modes, linear, normal, dry, states, model, step)
    elements, rigid = elements_kernel(model, modes, linear, captured), rigid_kernel(model, modes, captured)
    matrices = matrices_of(modes, law, count, step)
    return Stepper(model, modes, step, System(linear, normal, dry, elements, states, contiguous(model.contacts.lever),
                                              turning_kernel(model, modes, matrices, varies=False), rigid,
                                              part_of(rigid, elements)), matrices)


def _fresh(system):
    """The System with copies of the numbers that a run changes: those of friction with states, of turning dampers."""
    friction, elements = system.friction, system.elements
    return system._replace(friction=friction._replace(contact=friction.contact.copy()),
                           elements=elements._replace(parameter=elements.parameter.copy()))


def _no_step(found):
    return ConfigError("time stepping: step", "a positive step, at most as long as the motion", found)


def imposed(model, joint):
    """The model with one more input, the displacement in m of the far end of ``joint``: the force k u along its row."""
    if joint not in model.joints.name:
        raise ConfigError("time stepping: joint", f"one of {', '.join(model.joints.name)}", repr(joint))
    k = model.joints.name.index(joint)
    row = model.joints.stiffness[k] * model.joints.rows[k]
    return replace(model, input_name=(*model.input_name, f"{joint}_imposed"),
                   input_rows=np.vstack((model.input_rows, row)))


def _begin(model, modes, system, start, speed):
    """The State at time 0."""
    contacts, elements, states = model.contacts, system.elements, system.states
    normal, dry = system.law, system.friction
    gap = normal.gap + contacts.normal @ start.displacement
    rate, slip = contacts.normal @ start.velocity, contacts.lever * speed - contacts.tangent @ start.velocity
    if start.worn is not None:
        gap = gap + start.worn
    if len(elements.waviness):
        shift = np.zeros((2, len(gap)))
        surface_shift(elements.waviness, (float(start.age), float(start.angle), float(speed)), shift)
        gap, rate = gap + shift[0], rate + shift[1]
    force = np.zeros((2, len(gap)))
    force[0], yields = normal_force(normal, gap, rate)
    if start.worn is not None and elements.wear.size:       # goes on where damping felt the wear as well
        force[0] = start.normal
    elif start.normal is not None:
        force[0] = np.where(yields, force[0], start.normal)
    force[0] = np.where(normal.fixed >= 0, normal.fixed, force[0])
    closed = (gap <= 0) | (force[0] > 0)
    value = started(states, force[0], slip) if start.states is None else contiguous(start.states)
    dry.contact[:, FACTOR] = factors(states, value, start.angle)
    mu = [coefficient(dry, i, force[0, i] / contacts.area[i], slip[i], slip[i]) for i in range(len(gap))]
    force[1] = np.sign(slip) * mu * force[0] if start.friction is None else start.friction
    status = np.where(closed, np.where(slip == 0, STICK, SLIP), OPEN).astype(np.int64)
    return State(contiguous(modes.to_pairs(start.displacement, start.velocity)), force, status,
                 _memory(model, elements, start, speed),
                 np.array(value, float), np.array([float(start.angle)]),
                 np.zeros(len(gap)) if start.worn is None else np.array(start.worn, float))


def _memory(model, elements, start, speed):
    """What the elements remember (s,) at the Start."""
    if start.memory is not None:
        return np.array(start.memory, float)
    if start.relaxed is None or not model.elements:
        return no_memory(elements, start.age)
    rows = np.array([element.row for element in model.elements])
    return loaded(elements, rows, start.relaxed, start.displacement, float(start.age), float(speed))


def _speed_at_start(model, drive):
    if drive is None:
        return model.speed
    return float(np.ravel(drive.value)[0]) if isinstance(drive, History) else float(drive)


def _history(given, width, where):
    history = given if isinstance(given, History) else History(np.reshape(given, (1, width)), 1.0)
    value = contiguous(np.reshape(history.value, (len(history.value), -1)))
    if value.shape[1] != width or not np.isfinite(value).all() or not history.interval > 0:
        raise ConfigError(f"time stepping: {where}", f"finite samples of {width} values at a positive interval",
                          f"{value.shape[1]} values at {history.interval:g} s")
    return HistoryKernel(value, float(history.interval), np.array(np.broadcast_to(history.held, width), bool))


def _inputs(model, inputs):
    count = len(model.input_rows)
    if inputs is not None and not isinstance(inputs, History) and np.size(inputs) != count:
        raise ConfigError("time stepping: inputs", f"one force for each of {count} inputs", f"{np.size(inputs)}")
    return _history(np.zeros(count) if inputs is None else inputs, count, "inputs")


def _empty(linear, elements, rows):
    sensors, contacts = len(linear.sensors) // 2, len(linear.rows) // 4
    return Record(*np.zeros((2, sensors, rows)), *np.zeros((4, contacts, rows)),
                  np.zeros((contacts, rows), np.int8), np.zeros(rows), np.zeros((6, rows)),
                  *np.zeros((2, len(elements.kind), rows)), np.zeros((contacts, 3)))


def _motion(record, interval, steps, end):
    return Motion(interval * np.arange(len(record.stored)), record.displacement, record.velocity, record.gap,
                  record.normal, record.friction, record.slip, record.status, record.share / steps, record.stored,
                  *record.work, record.elongation, record.element_force, end)


def _failure(code, time, contact, step, model):
    """The error that says what failed, when and where."""
    if code in (TOO_STIFF, UNSETTLED):
        where = f"time stepping at t = {time:.6g} s, element {model.elements[contact].name}"
        if code == TOO_STIFF:
            return LongStepError(f"{where}: step", "at least 8 steps in a period of the element",
                               f"steps of {step:.3g} s", "shorten the step, or soften the element")
        return UnsettledStepError(where, "a force that settles", "none after the last sweep", "take a shorter step")
    if code == UNTURNED:
        return UnsettledStepError(f"time stepping at t = {time:.6g} s", "gyroscopic forces that settle",
                                  "none after the last sweep", "take a shorter step")
    where = f"time stepping at t = {time:.6g} s, contact {contact}"
    if code == TOO_LONG:
        return LongStepError(f"{where}: step", "at least 8 steps in a period of the contact", f"steps of {step:.3g} s",
                           "shorten the step, or soften the contact")
    if code == JAMMED:
        return ConvergenceError(where, "a solvable contact problem", "frictional wedging (jamming)",
                                "lower friction, change the tilt, or let the contact yield")
    if code == UNCONVERGED:
        return UnsettledStepError(where, "contact forces that settle", "none after the last sweep",
                                  "take a shorter step")
    return ConvergenceError(f"time stepping at t = {time:.6g} s", "a finite motion", "unbounded growth",
                            "take a shorter step, or look for an unphysical source of energy")
