"""A sliding system of twelve coordinates and five contacts, and its contact forces as the laws are written down."""

from functools import partial
from math import inf

import numpy as np

from pipeline.physics.friction.dry_friction import Friction
from pipeline.physics.sliding.equilibrium import closure_response, from_map, model_about, steady_sliding
from pipeline.physics.sliding_motion.motion import sliding_motion
from pipeline.physics.sliding_motion.sliding_modes import sliding_modes
from pipeline.physics.time_stepping.simulate import Table
from tests.physics.sliding.test_equilibrium import LOAD, rising_friction

#: closure and pressure, so finely sampled that no row shows
LAW = np.linspace(0, 6e-6, 20001), 2e11 * np.linspace(0, 6e-6, 20001) + 1e17 * np.linspace(0, 6e-6, 20001) ** 2
#: above all modes, and the closing speed that doubles the contact force
BELOW, SETTLING = 1e6, 0.5
STICK, KICK = 0.02, 0.008


def sliding(model, law=LAW, friction=None, load=LOAD, patch=1, damped=0.0):
    """(model about its steady sliding, SlidingMotion with all its modes), the upper half of them ``damped``."""
    friction = Friction(rising_friction(), distance=0.5) if friction is None else friction
    state = steady_sliding(model, closure_response(model), np.array([load]), *law,
                           partial(from_map, friction.law, friction.distance))
    about = model_about(model, state.contact, SETTLING)
    modes = sliding_modes(about, state.friction, BELOW, 1e-12)
    modes = modes.damped_above(np.median(abs(modes.root)) / (2 * np.pi), damped) if damped else modes
    return about, sliding_motion(about, state.contact.closure, friction, Table(*law, SETTLING), modes,
                                 np.zeros(len(model.contacts.area), int), (patch, inf), STICK)


def contact_force(model, law, friction, place, velocity):
    """Generalised force (n,) of all contacts: the laws as they are written down, contact by contact."""
    contacts, total = model.contacts, np.zeros(model.size)
    for i, area in enumerate(contacts.area):
        n, t, lateral = contacts.normal[i], contacts.tangent[i], contacts.lateral[i]
        pressure = max(np.interp(-n @ place, *law) * (1 - n @ velocity / SETTLING), 0.0)
        slip = np.array([model.sliding_speed[i] - t @ velocity, -lateral @ velocity])
        size = np.hypot(*slip)
        mu = friction.law.evaluate(pressure, size, friction.distance)[0]
        part = min(size / STICK, 1.0)
        drawn = area * pressure * mu * part * (3 - part**2) / 2 * slip / size
        total += area * pressure * n + drawn[0] * t + drawn[1] * lateral
    return total


def steady_friction(about):
    """FrictionState of the steady sliding of a model."""
    return from_map(rising_friction(), 0.5, about.contacts.pressure, abs(about.sliding_speed))
