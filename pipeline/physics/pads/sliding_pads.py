"""Pads at rest and in steady sliding: a PadSystem as a SlidingModel, solved and linearised as complex modes are.

Contacts keep their laws. Friction is that at time 0 in full and without memory, averaged over the parts of a patch on
the sub-discs. Nonlinear elements join as contacts without friction: an elongation e with the force F(e) is the closure
-e of a contact along the same row that presses with -F. In motion, where contacts slip in any direction,
``patch_contact`` has the same forces; its tangent in steady sliding is ``linearised`` (a test holds both together).
"""

from dataclasses import replace
from functools import partial

import numpy as np

from pipeline.physics.friction.sliding_friction import sliding_part
from pipeline.physics.numerics.compiled import njit
from pipeline.physics.pads.patch_contact import patch_shares, scattered, sub_disc_friction, surface
from pipeline.physics.sliding.equilibrium import closure_response, displacement, settled
from pipeline.physics.sliding.model import Contacts, FrictionState, Joints, SlidingModel
from pipeline.physics.time_stepping.contact_solver import yielding_force
from pipeline.physics.time_stepping.element_forces import DRY, element_force
from pipeline.physics.time_stepping.normal_laws import first_slopes

#: refinements of the springs at which bodies are condensed to their closures: the first are as soft as open contacts
_ROUNDS = 2


def static_start(system, where="static start"):
    """Displacement (n,) in equilibrium with the load before friction acts. Raises ConvergenceError."""
    return _state(system, 0.0, where)


def sliding_state(system, where="steady sliding"):
    """Displacement (n,) in equilibrium with the load and full friction. Raises ConvergenceError."""
    return _state(system, partial(_friction_state, system), where)


def linearised(system, place, friction=True):
    """(stiffness, damping), both (n, n), of small motions about the displacement ``place`` (n,), sliding steadily."""
    model = as_sliding(system)
    force, stiffness, damping = contact_forces(system, -(model.contacts.normal @ place + model.contacts.gap))
    state = _friction_state(system, force / model.contacts.area) if friction else FrictionState(0.0)
    contacts = replace(model.contacts, preload=force, stiffness=stiffness, damping=damping)
    _, damping, stiffness = replace(model, contacts=contacts).linearised(state)
    return stiffness, damping


def as_sliding(system):
    """SlidingModel of a PadSystem under its load, with the stiffness of contacts that have just closed."""
    contact, elements, size = system.contact, system.elements, len(system.mass)
    idle = np.zeros(len(elements.offset))
    drawn, none = elements.rows.reshape(len(idle), size), np.zeros((len(idle), size))
    rows = [np.vstack(pair) for pair in zip(contact.rows, (drawn, none, none), strict=True)]
    area, empty = np.append(contact.law.area, idle + 1), np.zeros(len(contact.radius) + len(idle))
    contacts = Contacts(*rows, np.zeros((len(area), 3)), area, np.append(contact.radius, idle), preload=empty,
                        stiffness=np.append(first_slopes(contact.law), idle), damping=empty,
                        gap=np.append(contact.law.gap + surface(contact, 0.0)[0], elements.offset))
    still = np.zeros((size, size))
    return SlidingModel(("pads",), np.zeros(size, int), system.mass, system.damping, still, system.stiffness, still,
                        Joints((), np.empty((0, size)), np.empty(0), np.empty(0)), contacts, ("load",),
                        system.load[None], (), np.empty((0, size)), contact.disc_speed)


@njit
def contact_forces(system, closure):
    """(3, c + e) of contacts and elements at rest at ``closure``: force in N, its slope over the closure, and over the
    closing speed."""
    contact, elements, result = system.contact, system.elements, np.empty((3, closure.size))
    waves, count = surface(contact, 0.0), contact.radius.size
    for i in range(count):
        result[0, i], result[1, i], result[2, i] = yielding_force(contact.law, i, closure[i], -waves[1, i])
    for k in range(elements.offset.size):
        force, slope, drag = element_force(elements.law, k, -closure[count + k], 0.0, elements.begin[k],
                                           elements.memory, elements.ahead, (0.0, 0.0, contact.disc_speed))
        result[0, count + k], result[1, count + k], result[2, count + k] = -force, slope, drag
    return result


@njit
def _friction(contact, pressure):
    """(3, c): friction coefficient, its slopes over pressure and slip speed, with what replaces sticking."""
    result, factor = np.empty((3, contact.radius.size)), scattered(contact, 0.0)
    shares = patch_shares(contact.angle, contact.half_angle, 0.0, contact.sectors)
    for i in range(contact.radius.size):
        slip = abs(contact.disc_speed * contact.radius[i])
        mu, by_pressure, by_slip = sub_disc_friction(contact.dry, i, pressure[i], slip, shares[i], contact.bedding)
        part, rise = sliding_part(slip, contact.stick_speed)
        result[0, i], result[1, i] = factor[i] * part * mu, factor[i] * part * by_pressure
        result[2, i] = factor[i] * (rise * mu + part * by_slip)
    return result


def _friction_state(system, pressure, _=None):
    """FrictionState (c + e,) at ``pressure`` (c + e,) Pa and the slip of the rigid disc; none at elements."""
    values = _friction(system.contact, pressure)
    return FrictionState(*np.pad(values, ((0, 0), (0, len(pressure) - values.shape[1]))))


def _state(system, friction, where):
    """Displacement (n,) in equilibrium with ``friction``, as of ``settled``."""
    resting = without_dry_elements(system)
    model = as_sliding(resting)
    first, guess, load = model.contacts.stiffness, None, np.ones(1)

    def law(closure):
        return contact_forces(resting, closure)[:2]

    for _ in range(_ROUNDS):
        state = settled(model, closure_response(model), load, law, first, friction, guess, where)
        contact, guess = state.contact, state.contact.closure
        place = displacement(model, contact, state.friction.coefficient, load)
        springs = np.maximum(contact.stiffness, first)
        model = replace(model, contacts=replace(model.contacts, stiffness=springs))
    return place


def without_dry_elements(system):
    """The same system whose elements with dry friction hold nothing: they do not bear loads at rest."""
    law = system.elements.law
    parameter = law.parameter.copy()
    parameter[law.kind == DRY, 0] = 0.0
    return system._replace(elements=system.elements._replace(law=law._replace(parameter=parameter)))
