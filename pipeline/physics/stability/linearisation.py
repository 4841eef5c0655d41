"""Terms of small motions about steady sliding: friction with what it remembers, and the slopes of elements.

    M q'' + C q' + K q = B z,      z' = P q + V q' - R z

z are the Maxwell branches of elements and the states of friction that settle in steady sliding, R diagonal.
"""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.contact.groups import parts
from pipeline.physics.friction.state_kernels import EVOLVING, MEMORY, factor_slope, settles, state_slopes
from pipeline.physics.friction.state_variables import factors, started, state_kernel
from pipeline.physics.sliding.model import FrictionState
from pipeline.physics.system.forms import spread
from pipeline.physics.time_stepping.coupled_solver import no_memory
from pipeline.physics.time_stepping.element_forces import BOUC_WEN, FRICTION, element_force, update_turning_dampers
from pipeline.physics.time_stepping.elements import Maxwell, alone


@dataclass(frozen=True)
class Settling:
    """What settles beside a motion of n coordinates: ``push`` B (n, k), ``by_place`` P and ``by_speed`` V (k, n),
    ``decay`` R (k,)."""

    push: np.ndarray
    by_place: np.ndarray
    by_speed: np.ndarray
    decay: np.ndarray

    def projected(self, left, right):
        """The same for q = ``right`` r, (n, m), and equations tested by ``left`` (m, n)."""
        return Settling(left @ self.push, self.by_place @ right, self.by_speed @ right, self.decay)

    def answers(self, s, x=None):
        """(B (P + s V) / (s + R) (n, n), None) at ``s`` 1/s; that and its slope over s, each times ``x`` (n,), where it
        is given."""
        answer, heard = 1 / (s + self.decay), self.by_place + s * self.by_speed
        if x is None:
            return (self.push * answer) @ heard, None
        told = heard @ x
        return self.push @ (answer * told), self.push @ (answer * (self.by_speed @ x - answer * told))


def friction_about(friction, speed, load, area):
    """(FrictionState (c,), states) of a Friction, Grouped or not, in steady sliding at signed speeds (c,) m/s.

    ``load`` (c,) N, ``area`` (c,) m^2; states are (their StateKernel, values).
    """
    states = state_kernel(friction, area)
    value = started(states, load, speed)
    return _read(friction, speed, load / area, factors(states, value, 0.0)), (states, value)


def present(state, states):
    """The part of a FrictionState that acts at once: that of contacts which remember load and speed does not."""
    kernel, _ = states
    heard = np.isin(np.arange(len(kernel.area)), kernel.contact[kernel.kind == MEMORY])
    if not heard.any():
        return state
    return FrictionState(*(np.where(heard, 0.0, part) for part in (state.coefficient, state.pressure_slope,
                                                                   state.speed_slope)))


def _read(friction, speed, pressure, factor):
    values = np.empty((3, len(speed)))
    for law, members in parts(friction, len(speed)):
        turned, there, slip = np.where(speed[members] < 0, law.backward, 1.0), pressure[members], abs(speed[members])
        values[0, members] = turned * law.law.evaluate(there, slip, law.distance)[0]
        for row, axis in enumerate(("pressure", "speed"), 1):
            varies = getattr(law.law, axis).size > 1
            values[row, members] = turned * [law.law.slope(axis, p, v, law.distance) if varies else 0.0
                                        for p, v in zip(there, slip, strict=True)]
    return FrictionState(*(factor * values))


def settling(model, friction, states):
    """Settling of a SlidingModel whose contacts are linearised: states of friction, then Maxwell branches.

    ``friction`` is the whole FrictionState (c,), ``states`` as of ``friction_about``.
    """
    push, place, rate, decay = _of_friction(model.contacts, model.direction(), abs(model.sliding_speed), friction,
                                            *states)
    branches, springs, times = maxwell_branches(model)
    return Settling(np.hstack((push, -branches.T)), np.vstack((place, 0 * branches)),
                    np.vstack((rate, springs[:, None] * branches)), np.append(decay, 1 / times))


def beside_motion(model, friction, states):
    """``settling``; None where nothing settles."""
    made = settling(model, friction, states)
    return made if made.decay.size else None


def _of_friction(contacts, sign, speed, friction, states, value):
    """(B, P, V, R) of the states of friction that settle: memory of the load, of the speed, and factors."""
    push, place, rate, decay = [], [], [], []

    def add(i, drawn, by_load, by_speed, leaving):
        """One state: dT = sign drawn z, z' = by_load dN + by_speed dv - leaving z."""
        push.append(sign[i] * drawn * contacts.tangent[i])
        place.append(-by_load * contacts.stiffness[i] * contacts.normal[i])
        rate.append(-by_load * contacts.damping[i] * contacts.normal[i] - by_speed * sign[i] * contacts.tangent[i])
        decay.append(leaving)

    settled = settles(states)
    for k, (kind, i, p) in enumerate(zip(states.kind, states.contact, states.parameter, strict=True)):
        load, x = contacts.preload[i], value[k, 0]
        leaving, by_load, by_speed = (state_slopes(p, x, load, contacts.area[i], speed[i]) if kind == EVOLVING
                                      else (0.0, float(kind == MEMORY), 0.0))
        if by_load and settled[k] and load > 0 and contacts.stiffness[i] == 0 and not contacts.fixed[i]:
            raise ConfigError("friction that remembers its load", "contacts that yield", "a hard one",
                              "give the contact a stiffness")
        if kind == MEMORY:
            leaving = speed[i] / p[0]
            add(i, friction.load_slope(contacts.pressure)[i], leaving, 0.0, leaving)
            add(i, load * friction.speed_slope[i], 0.0, leaving, leaving)
        elif settled[k]:
            add(i, load * friction.coefficient[i] * factor_slope(p, x), by_load, by_speed, leaving)
    none = np.empty((0, contacts.tangent.shape[1]))
    return (np.array(push or none).T, np.array(place or none), np.array(rate or none), np.array(decay, float))


def maxwell_branches(model):
    """(rows (b, n), stiffness (b,), time (b,)) of the Maxwell branches of all elements that have a stiffness."""
    laws = [(e.row, k, t) for e in model.elements if isinstance(e.law, Maxwell)
            for k, t in zip(e.law.stiffness, e.law.time, strict=True) if k > 0]
    rows, springs, times = zip(*laws, strict=True) if laws else ((), (), ())
    return np.array(rows, float).reshape(-1, model.size), np.array(springs, float), np.array(times, float)


def element_rows(model):
    """(e, n) rows of the elements of a SlidingModel."""
    return np.array([e.row for e in model.elements]).reshape(-1, model.size)


def with_slopes(model, slopes):
    """A SlidingModel with the ``slopes`` (2, e) N/m and N s/m of its elements among the matrices of the bodies."""
    if not model.elements:
        return model
    rows = element_rows(model)
    return replace(model, stiffness=model.stiffness + spread(rows, slopes[0], rows),
                   damping=model.damping + spread(rows, slopes[1], rows))


def element_slopes(model, start, slip):
    """(rows (e, n), stiffness (e,), damping (e,)) of the elements about a Start, contacts slipping at ``slip`` (c,).

    Dry friction sticks or slides through zero, which no matrix says, and counts as nothing. A law of Bouc and Wen is as
    stiff as where it begins: small cycles about a load creep until they are centred.
    """
    kernel, rows = alone(model.elements), element_rows(model)
    memory = no_memory(kernel) if start.memory is None else start.memory
    update_turning_dampers(kernel, start.friction, slip, np.zeros(len(rows)))
    slopes = np.zeros((2, len(rows)))
    for k, row in enumerate(rows):
        if kernel.kind[k] == BOUC_WEN:
            slopes[0, k] = kernel.parameter[k, :2].sum()
        elif kernel.kind[k] not in FRICTION:
            place = float(row @ start.displacement)
            slopes[:, k] = element_force(kernel, k, place, 0.0, place, memory, memory.copy(),
                                         (0.0, 0.0, model.speed))[1:]
    return rows, *slopes
