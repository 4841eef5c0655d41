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

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.contact_groups import parts
from pipeline.physics.dry_friction import FACTOR, RIGID, STIFFNESS, coefficient, constant, kernel
from pipeline.physics.element_forces import TOO_STIFF, UNSETTLED
from pipeline.physics.elements import element_kernel
from pipeline.physics.friction_state_steps import MEMORY
from pipeline.physics.friction_states import factors, started, state_kernel
from pipeline.physics.normal_law import Forward, Hard, Lagrange, Penalty, Table, normal_force, normal_kernel
from pipeline.physics.time_stepping_contact import (
    JAMMED,
    LARGEST_STIFFNESS,
    OPEN,
    PENALTY,
    SLIP,
    SOLVED,
    STICK,
    TABLE,
    TOO_LONG,
    UNCONVERGED,
)
from pipeline.physics.time_stepping_elements import no_memory, surface_shift
from pipeline.physics.time_stepping_linear import modal_system, newmark_matrices, step_matrices
from pipeline.physics.time_stepping_march import HistoryKernel, LinearKernel, Record, march

__all__ = ["Forward", "Hard", "History", "Lagrange", "Motion", "Penalty", "Start", "Table", "imposed", "simulate"]
#: fewest steps in a period of the highest mode
STEPS_PER_PERIOD = 2.5


@dataclass(frozen=True)
class History:
    """``value`` (samples,) or (samples, n) every ``interval`` s from time 0; linear between, constant beyond."""

    value: np.ndarray
    interval: float


@dataclass(frozen=True)
class Start:
    """Displacement and velocity (n,) at time 0; normal and friction force (c,) where they are known.

    ``memory`` (s,) of the elements, by default 0: those with memory draw with no force where the motion starts;
    ``angle`` rad of the drive and ``age`` s that passed before; ``states`` (k, 2) of friction, by default settled.
    """

    displacement: np.ndarray
    velocity: np.ndarray
    normal: np.ndarray | None = None
    friction: np.ndarray | None = None
    memory: np.ndarray | None = None
    angle: float = 0.0
    age: float = 0.0
    states: np.ndarray | None = None

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
    of the model, where many runs share it; ``book=False`` leaves out the work of inputs and the loss of dampers. Raises
    ConfigError for a step too long, ConvergenceError with time and contact where a step has no solution.
    """
    steps = round(duration / step)
    if not step > 0 or steps < 1 or record_every < 1:
        raise ConfigError("time stepping: step", "a positive step, at most as long as the motion",
                          f"{step:g} s for {duration:g} s")
    system = modal_system(model) if system is None else system
    friction = friction or constant(0.0)
    normal, dry = normal_kernel(law, model.contacts), kernel(friction, len(model.contacts.area))
    linear = _linear(model, system, law, dry, step)
    states = state_kernel(friction, model.contacts.area)
    _check(system, linear, normal, dry, states, model, step)
    rest = np.zeros(model.size)
    start = Start(rest, rest) if start is None else start
    elements = _elements(model, system, linear)
    memory = no_memory(elements) if start.memory is None else _own(start.memory)
    pairs, force, status, value = _begin(model, system, normal, dry, start, _speed_at_start(model, drive), elements,
                                         states)
    record = _empty(linear, elements, len(value), steps // record_every + 1, start.angle)
    code, number, contact = march(
        linear, normal, dry, elements, states, _own(model.contacts.lever),
        _history(model.speed if drive is None else drive, 1, "drive"), _inputs(model, inputs), pairs, force, status,
        memory, value, float(start.age), float(step), steps, int(record_every), bool(book), record)
    if code != SOLVED:
        raise _failure(code, number * step, contact, step, model)
    end = Start(*system.from_pairs(record.end), *force, record.memory, float(record.angle[0]),
                start.age + steps * step, record.states)
    return _motion(record, step * record_every, steps, end)


def imposed(model, joint):
    """The model with one more input, the displacement in m of the far end of ``joint``: the force k u along its row."""
    if joint not in model.joints.name:
        raise ConfigError("time stepping: joint", f"one of {', '.join(model.joints.name)}", repr(joint))
    k = model.joints.name.index(joint)
    row = model.joints.stiffness[k] * model.joints.rows[k]
    return replace(model, input_name=(*model.input_name, f"{joint}_imposed"),
                   input_rows=np.vstack((model.input_rows, row)))


def _linear(model, system, law, dry, step):
    """LinearKernel: rows of contacts, inputs and elements, seen and driven through one step."""
    contacts, count = model.contacts, len(model.contacts.area)
    law = parts(law, count)[0][0]       # those of all groups are stepped alike
    gamma = getattr(law, "gamma", None)
    matrices = step_matrices(system, step) if gamma is None else newmark_matrices(system, step, gamma)
    forced = system.driven(np.vstack((contacts.normal, contacts.tangent, model.input_rows, -_element_rows(model))))
    first, last = (np.einsum("bxy,ryb->rxb", matrix, forced) for matrix in matrices[1:])
    kicks = isinstance(law, Forward)
    hold = np.array([kicks or isinstance(law, Hard), dry.description == RIGID])
    if gamma is not None:
        hold[:] = False
    for f in np.flatnonzero(hold):
        own = slice(f * count, (f + 1) * count)
        flown = step * np.einsum("bxy,ryb->rxb", matrices[0], forced[own])
        last[own], first[own] = flown if kicks else first[own] + last[own], 0.0
    rows = np.concatenate([system.observed(r) for r in (contacts.normal, contacts.tangent)])
    response = np.einsum("oibx,fjbx->ofij", rows, last[:2 * count].reshape(2, count, *last.shape[1:]))
    struck = step * np.repeat(hold, count)[:, None, None] * forced[:2 * count]
    energy, power = _forms(system)
    arrays = (np.moveaxis(matrices[0], 0, 2), first, last, _stacked(rows), response,
              system.observed(model.input_rows)[0], _stacked(system.observed(model.sensor_rows)), hold, system.squared,
              np.diag(system.damping), energy, power, struck if kicks else struck[:0])
    return LinearKernel(*(_own(a) for a in arrays))


def _element_rows(model):
    return np.array([e.row for e in model.elements], float).reshape(-1, model.size)


def _elements(model, system, linear):
    """ElementKernel: rows of the elements, seen and driven through one step, with those of the contacts."""
    count, elements = len(model.contacts.area), len(model.elements)
    seen = system.observed(_element_rows(model))
    drawn, pressed = linear.last[len(linear.last) - elements:], linear.last[:2 * count]
    contact_rows = linear.rows.reshape(4, count, *linear.rows.shape[1:])
    arrays = {"rows": _stacked(seen), "own": np.einsum("oeax,fax->oef", seen, drawn),
              "to_contacts": np.einsum("ocax,fax->ocf", contact_rows, drawn),
              "to_elements": np.einsum("oeax,fax->oef", seen, pressed).reshape(2, elements, 2, count)}
    return element_kernel(model.elements, model.contacts.waviness, **{n: _own(a) for n, a in arrays.items()})


def _stacked(rows):
    """(a, r, 2, m) as (a r, 2, m)."""
    return rows.reshape(-1, *rows.shape[2:])


def _own(values):
    """A writable, contiguous copy: one type of array for all compiled calls."""
    return np.array(values, dtype=float, order="C")


def _forms(system):
    """Quadratic forms (2m, 2m) of energy and loss in coupled pairs; empty where the modes are the pairs."""
    if not system.coupled:
        return np.empty((0, 0)), np.empty((0, 0))
    place, speed = np.split(system.state.reshape(len(system.state), -1), 2)
    drag = (system.damping + system.damping.T) / 2
    return (speed.T @ speed + place.T @ (system.squared[:, None] * place)) / 2, speed.T @ drag @ speed


def _check(system, linear, normal, dry, states, model, step):
    """Refuse, before the first step, one that is too long, contacts that nothing can move, memory of impulses."""
    if np.any(states.kind == MEMORY) and (normal.kind not in (PENALTY, TABLE) or normal.newmark):
        raise ConfigError("time stepping: friction with memory", "contacts that yield, Penalty or Table without gamma",
                          "another law", "give the contacts a stiffness")
    if not normal.newmark and system.highest * step > 2 * np.pi / STEPS_PER_PERIOD:
        longest = 2 * np.pi / STEPS_PER_PERIOD / system.highest
        raise ConfigError("time stepping: step", f"at most {longest:.3g} s, {STEPS_PER_PERIOD:g} steps in a period of"
                          f" the highest mode ({system.highest / (2 * np.pi):.4g} Hz)", f"{step:.3g} s",
                          "shorten the step, or leave out the highest modes")
    for i in range(len(normal.gap)):
        if normal.fixed[i] < 0 and not linear.response[1, 0, i, i] > 0:
            raise ConfigError(f"time stepping: contact {i}", "bodies that its normal force moves", "none")
        if normal.newmark:
            continue
        found = [normal.stiffness[i] * linear.response[0, 0, i, i]]
        if dry.description != RIGID:
            found.append(dry.contact[i, STIFFNESS] * linear.response[2, 1, i, i])
        if max(found) > LARGEST_STIFFNESS:
            longest = step * np.sqrt(LARGEST_STIFFNESS / max(found))
            raise ConfigError("time stepping: step", f"at most about {longest:.2g} s for the stiffness of contact {i}",
                              f"{step:.3g} s", "shorten the step, soften the contact, or take hard contacts")


def _begin(model, system, normal, dry, start, speed, elements, states):
    """Pairs (2, m), forces (2, c), status (c,) and states of friction (k, 2) at time 0."""
    contacts = model.contacts
    gap = normal.gap + contacts.normal @ start.displacement
    rate, slip = contacts.normal @ start.velocity, contacts.lever * speed - contacts.tangent @ start.velocity
    if len(elements.waviness):
        shift = np.zeros((2, len(gap)))
        surface_shift(elements.waviness, (float(start.age), float(start.angle), float(speed)), shift)
        gap, rate = gap + shift[0], rate + shift[1]
    force = np.zeros((2, len(gap)))
    force[0], yields = normal_force(normal, gap, rate)
    if start.normal is not None:
        force[0] = np.where(yields, force[0], start.normal)
    force[0] = np.where(normal.fixed >= 0, normal.fixed, force[0])
    closed = (gap <= 0) | (force[0] > 0)
    value = started(states, force[0], slip) if start.states is None else _own(start.states)
    dry.contact[:, FACTOR] = factors(states, value, start.angle)
    mu = [coefficient(dry, i, force[0, i] / contacts.area[i], slip[i], slip[i]) for i in range(len(gap))]
    force[1] = np.sign(slip) * mu * force[0] if start.friction is None else start.friction
    status = np.where(closed, np.where(slip == 0, STICK, SLIP), OPEN).astype(np.int64)
    return _own(system.to_pairs(start.displacement, start.velocity)), force, status, value


def _speed_at_start(model, drive):
    if drive is None:
        return model.speed
    return float(np.ravel(drive.value)[0]) if isinstance(drive, History) else float(drive)


def _history(given, width, where):
    history = given if isinstance(given, History) else History(np.reshape(given, (1, width)), 1.0)
    value = _own(np.reshape(history.value, (len(history.value), -1)))
    if value.shape[1] != width or not np.isfinite(value).all() or not history.interval > 0:
        raise ConfigError(f"time stepping: {where}", f"finite samples of {width} values at a positive interval",
                          f"{value.shape[1]} values at {history.interval:g} s")
    return HistoryKernel(value, float(history.interval))


def _inputs(model, inputs):
    count = len(model.input_rows)
    if inputs is not None and not isinstance(inputs, History) and np.size(inputs) != count:
        raise ConfigError("time stepping: inputs", f"one force for each of {count} inputs", f"{np.size(inputs)}")
    return _history(np.zeros(count) if inputs is None else inputs, count, "inputs")


def _empty(linear, elements, states, kept, angle):
    sensors, contacts = len(linear.sensors) // 2, len(linear.rows) // 4
    return Record(*np.zeros((2, sensors, kept)), *np.zeros((4, contacts, kept)),
                  np.zeros((contacts, kept), np.int8), np.zeros(kept), np.zeros((6, kept)),
                  *np.zeros((2, len(elements.kind), kept)), np.zeros((contacts, 3)), np.zeros(linear.step.shape[1:]),
                  no_memory(elements), np.zeros((states, 2)), np.array([float(angle)]))


def _motion(record, interval, steps, end):
    return Motion(interval * np.arange(len(record.stored)), record.displacement, record.velocity, record.gap,
                  record.normal, record.friction, record.slip, record.status, record.share / steps, record.stored,
                  *record.work, record.elongation, record.element_force, end)


def _failure(code, time, contact, step, model):
    """The error that says what failed, when and where."""
    if code in (TOO_STIFF, UNSETTLED):
        where = f"time stepping at t = {time:.6g} s, element {model.elements[contact].name}"
        if code == TOO_STIFF:
            return ConfigError(where, "at least 8 steps in a period of the element", f"steps of {step:.3g} s",
                               "shorten the step, or soften the element")
        return ConvergenceError(where, "a force that settles", "none after the last sweep", "take a shorter step")
    where = f"time stepping at t = {time:.6g} s, contact {contact}"
    if code == TOO_LONG:
        return ConfigError(where, "at least 8 steps in a period of the contact", f"steps of {step:.3g} s",
                           "shorten the step, or soften the contact")
    if code == JAMMED:
        return ConvergenceError(where, "contact forces that stop the approach", "friction that jams the contact",
                                "lower friction, change the tilt, or let the contact yield")
    if code == UNCONVERGED:
        return ConvergenceError(where, "contact forces that settle", "none after the last sweep", "take a shorter step")
    return ConvergenceError(f"time stepping at t = {time:.6g} s", "a finite motion", "one that grows without bound",
                            "take a shorter step, or look for what drives the motion")
