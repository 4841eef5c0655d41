"""Small motions of a bench about steady sliding: its matrices and complex roots, for hammer records and growth rates.

    M q'' + C q' + K q = B z,      z' = P q + V q' - R z

Contacts count with the slope of their law under the steady load, friction with its slopes over pressure and slip speed,
elements with the slope of their force where they stand; z are the Maxwell branches of elements and the states of
friction that settle in steady sliding, R diagonal. Excitations, wear, the shapes of surfaces and friction that varies
around the drive drop out; states that drift (heat, films, distance) stay where a run begins. The waveform of a squeal
is not compared with anything, its growth rate and frequency are.
"""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.bench import at_begin, run_friction
from pipeline.physics.contact_groups import parts
from pipeline.physics.element_forces import DRY, element_force, turn
from pipeline.physics.elements import Maxwell, alone
from pipeline.physics.friction_state_steps import MEMORY, SETTLING, factor_slope, rate_slopes
from pipeline.physics.friction_states import factors, shapeless, started, state_kernel
from pipeline.physics.sliding_model import FrictionState, spread
from pipeline.physics.time_stepping_elements import no_memory
from pipeline.physics.time_stepping_laws import tangent
from pipeline.physics.time_stepping_start import steady_start


@dataclass(frozen=True)
class SmallMotion:
    """The matrices above: ``mass``, ``damping``, ``stiffness`` (n, n); ``push`` B (n, k), ``by_place`` P and
    ``by_speed`` V (k, n), ``decay`` R (k,) of k branches and states."""

    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    push: np.ndarray
    by_place: np.ndarray
    by_speed: np.ndarray
    decay: np.ndarray

    def matrix(self):
        """State matrix (2 n + k, 2 n + k) of (q, q', z)."""
        size, states = self.push.shape
        whole = np.zeros((2 * size + states,) * 2)
        whole[:size, size:2 * size] = np.eye(size)
        whole[size:2 * size] = np.linalg.solve(self.mass, np.hstack((-self.stiffness, -self.damping, self.push)))
        whole[2 * size:] = np.hstack((self.by_place, self.by_speed, -np.diag(self.decay)))
        return whole


def roots(bench, run):
    """Complex roots (2 n + k,) in rad/s, by rising frequency: growth rate and angular frequency of each motion.

    Each of the k Maxwell branches, F' = k v - F / tau, and states of friction adds one.
    """
    found = np.linalg.eigvals(small_motion(bench, run).matrix())
    return found[np.lexsort((found.imag, abs(found.imag)))]


def linearised(bench, run):
    """(M, C, K), each (n, n), of ``small_motion``, without Maxwell branches, as in a motion so slow that they relax.

    ConfigError where friction has states that settle, which no such three hold.
    """
    motion = small_motion(bench, run)
    states = len(motion.decay) - len(_branches(bench.model)[2])
    if states:
        raise ConfigError("matrices of a bench", "friction without states", f"{states} states",
                          "take small_motion, whose matrix holds them")
    return motion.mass, motion.damping, motion.stiffness


def small_motion(bench, run):
    """SmallMotion about steady sliding under the first inputs and drive speed of ``run``.

    Friction turns in its plane with the motion only where an element says so, as in the simulation. Raises ConfigError
    for contacts that do not yield, and what ``steady_start`` raises.
    """
    speed, inputs = at_begin(bench, run)
    model = bench.model.at_speed(speed)
    friction = shapeless(run_friction(bench, run))
    start = steady_start(model, bench.law, friction, inputs)
    contacts, slip = model.contacts, model.sliding_speed
    stiffness, damping = tangent(bench.law, np.where(contacts.fixed, 0.0, start.normal), contacts.area)
    contacts = replace(contacts, preload=start.normal, stiffness=stiffness, damping=damping)
    states = state_kernel(friction, contacts.area)
    value = started(states, start.normal, slip)
    state = _friction_state(friction, slip, contacts.pressure, factors(states, value, 0.0))
    heard = np.isin(np.arange(len(slip)), states.contact[states.kind == MEMORY])
    present = FrictionState(*(np.where(heard, 0.0, v) for v in (state.coefficient, state.pressure_slope,
                                                                state.speed_slope)))
    mass, drag, spring = replace(model, contacts=contacts).linearised(present, friction_damping=False)
    rows, slope, loss = _elements(model, start, slip)
    push, place, rate, decay = _states(contacts, model.direction(), abs(slip), state, states, value)
    branches, springs, times = _branches(model)
    return SmallMotion(mass, drag + spread(rows, loss, rows), spring + spread(rows, slope, rows),
                       np.hstack((push, -branches.T)), np.vstack((place, 0 * branches)),
                       np.vstack((rate, springs[:, None] * branches)), np.append(decay, 1 / times))


def _friction_state(friction, speed, pressure, factor):
    """FrictionState (c,) at signed sliding speeds (c,) and pressures (c,), with the ``factor`` (c,) of its states."""
    found = np.empty((3, len(speed)))
    for law, own in parts(friction, len(speed)):
        for i in own:
            turned = law.backward if speed[i] < 0 else 1.0
            state = pressure[i], abs(speed[i]), law.distance
            found[:, i] = turned * np.array([law.law.evaluate(*state)[0], *(law.law.slope(axis, *state)
                                                                            for axis in ("pressure", "speed"))])
    return FrictionState(*(factor * found))


def _states(contacts, sign, speed, friction, states, value):
    """(B, P, V, R) of the states of friction that settle: memory of the load, of the speed, and factors."""
    push, place, rate, decay = [], [], [], []

    def add(i, drawn, by_load, by_speed, leaving):
        """One state: dT = sign drawn z, z' = by_load dN + by_speed dv - leaving z."""
        push.append(sign[i] * drawn * contacts.tangent[i])
        place.append(-by_load * contacts.stiffness[i] * contacts.normal[i])
        rate.append(-by_load * contacts.damping[i] * contacts.normal[i] - by_speed * sign[i] * contacts.tangent[i])
        decay.append(leaving)

    for k, (kind, i, p) in enumerate(zip(states.kind, states.contact, states.parameter, strict=True)):
        load, x = contacts.preload[i], value[k, 0]
        if kind == MEMORY:
            leaving = speed[i] / p[0]
            add(i, friction.coefficient[i] + contacts.pressure[i] * friction.pressure_slope[i], leaving, 0.0, leaving)
            add(i, load * friction.speed_slope[i], 0.0, leaving, leaving)
        elif kind in SETTLING:
            leaving, by_load, by_speed = rate_slopes(kind, p, load, contacts.area[i], speed[i])
            add(i, load * friction.coefficient[i] * factor_slope(kind, p, x), -x * by_load, -x * by_speed, leaving)
    none = np.empty((0, contacts.tangent.shape[1]))
    return (np.array(push or none).T, np.array(place or none), np.array(rate or none), np.array(decay, float))


def _branches(model):
    """(rows (b, n), stiffness (b,), time (b,)) of the Maxwell branches of all elements."""
    laws = [(e.row, k, t) for e in model.elements if isinstance(e.law, Maxwell)
            for k, t in zip(e.law.stiffness, e.law.time, strict=True)]
    rows, springs, times = zip(*laws, strict=True) if laws else ((), (), ())
    return np.array(rows, float).reshape(-1, model.size), np.array(springs, float), np.array(times, float)


def _elements(model, start, slip):
    """(rows (e, n), stiffness (e,), damping (e,)) of the elements about the start; dry friction sticks or slides
    through zero, which no matrix says, and counts as nothing."""
    kernel, rows = alone(model.elements), np.array([e.row for e in model.elements]).reshape(-1, model.size)
    memory = no_memory(kernel) if start.memory is None else start.memory
    turn(kernel, start.friction, slip, np.zeros(len(rows)))
    slopes = np.zeros((2, len(rows)))
    for k, row in enumerate(rows):
        if kernel.kind[k] != DRY:
            place = float(row @ start.displacement)
            slopes[:, k] = element_force(kernel, k, place, 0.0, place, memory, memory.copy(),
                                         (0.0, 0.0, model.speed))[1:]
    return rows, *slopes
