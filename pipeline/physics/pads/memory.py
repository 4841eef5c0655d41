"""What contacts and elements of the pads remember: states of friction, wear, hysteresis; accepted step by step.

Within a step all memory stands still, so that forces are functions of the motion at its end; ``accept`` then brings it
there. Both integrators call it once after every step, and the history of the contact forces repeats it. States of
friction go on as in ``state_kernels``, elements as in ``element_forces``; wear goes on at the pace of the step before.
"""

from typing import NamedTuple

import numpy as np

from pipeline.physics.friction.state_kernels import expect, settle
from pipeline.physics.friction.state_variables import started
from pipeline.physics.numerics.compiled import njit
from pipeline.physics.pads.pad_system import element_at
from pipeline.physics.pads.patch_contact import contact_state
from pipeline.physics.time_stepping.element_forces import DRY


class ContactMemory(NamedTuple):
    """Where the contacts stood after the last accepted step."""

    value: np.ndarray       # (k, 2) states of friction
    load: np.ndarray        # (c,) N
    slip: np.ndarray        # (c,) m/s, along sliding
    drawn: np.ndarray       # (c,) N, friction along sliding
    pace: np.ndarray        # (c,) m/s of wear


def remembers(system):
    """Whether anything in a PadSystem changes with what happened before."""
    contact = system.contact
    return bool(contact.states.kind.size or contact.wear.any() or system.elements.memory.size)


def begun(system, displacement, step):
    """(PadSystem with memory of its own, ContactMemory) at rest at ``displacement`` (n,), for steps of ``step`` s."""
    contact, memory = begun_contact(system.contact, displacement, step)
    elements = system.elements._replace(**{n: getattr(system.elements, n).copy() for n in ("memory", "ahead", "begin")})
    system = system._replace(contact=contact, elements=elements)
    accept_elements(system, 0.0, displacement, np.zeros_like(displacement))
    for k in np.flatnonzero(elements.law.kind == DRY):      # holds nothing where the motion starts
        elements.memory[elements.law.first[k]] = 0.0
    return system, memory


def begun_contact(contact, displacement, step):
    """(PatchContact, ContactMemory) of ``begun``."""
    dry = contact.dry._replace(contact=contact.dry.contact.copy())
    contact = contact._replace(dry=dry, receded=np.zeros_like(contact.receded))
    state = contact_state(contact, 0.0, displacement, np.zeros_like(displacement))
    slip, pace = contact.disc_speed * contact.radius, np.zeros_like(contact.radius)
    memory = ContactMemory(started(contact.states, state.normal, slip), state.normal, slip, state.friction[:, 0].copy(),
                           pace)
    pace[:] = contact.wear * state.normal * abs(slip)
    _prepare(contact, memory, 0.0, step)
    return contact, memory


@njit
def _prepare(contact, memory, time, step):
    """Friction and wear of the step to come, from what is remembered at ``time``."""
    if contact.states.kind.size > 0:
        expect(contact.states, memory.value, contact.dry, memory.load, memory.slip, memory.drawn,
               contact.disc_speed * time, contact.disc_speed * (time + step), step, False)
    for i in range(memory.pace.size):
        contact.receded[0, i] += step * memory.pace[i]
        contact.receded[1, i] = memory.pace[i]


@njit
def accept_contact(contact, memory, time, displacement, velocity, step):
    """ContactState at the end of a step of ``step`` s at ``time``, from which memory goes on."""
    state = contact_state(contact, time, displacement, velocity)
    slip = np.empty(memory.slip.size)
    for i in range(slip.size):
        along = 0.0
        for k in range(velocity.size):
            along += contact.rows[1, i, k] * velocity[k]
        slip[i] = contact.disc_speed * contact.radius[i] - along
        memory.drawn[i] = 0.5 * (memory.drawn[i] + state.friction[i, 0])
    settle(contact.states, memory.value, memory.load, state.normal, memory.slip, slip, memory.drawn, step)
    for i in range(slip.size):
        pace = contact.wear[i] * state.normal[i] * abs(slip[i])
        contact.receded[0, i] += 0.5 * step * (pace - memory.pace[i])     # the trapezoidal rule
        memory.load[i], memory.slip[i], memory.drawn[i] = state.normal[i], slip[i], state.friction[i, 0]
        memory.pace[i] = pace
    _prepare(contact, memory, time, step)
    return state


@njit
def accept(system, memory, time, displacement, velocity, step):
    """Bring all memory of a PadSystem to the end of a step of ``step`` s at ``time``."""
    accept_contact(system.contact, memory, time, displacement, velocity, step)
    accept_elements(system, time, displacement, velocity)


@njit
def accept_elements(system, time, displacement, velocity):
    """Bring the memory of the elements of a PadSystem to the end of a step at ``time``."""
    elements = system.elements
    for k in range(elements.offset.size):
        element_at(system, k, time, displacement, velocity)
        elements.begin[k] = elements.offset[k] + elements.rows[k] @ displacement
    for s in range(elements.memory.size):
        elements.memory[s] = elements.ahead[s]
