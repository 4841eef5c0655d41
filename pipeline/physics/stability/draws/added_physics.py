"""What effects add to a Family beyond its matrices: a law of its contacts, elements that rest on a force, friction that
remembers.

Masses, springs and rows that effects change are those of the SlidingModel of the Family, and so are its ``elements``.
"""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.physics.contact.closure_law import force_at_rest
from pipeline.physics.contact.groups import parts
from pipeline.physics.stability.linearisation import element_slopes, friction_about
from pipeline.physics.time_stepping.elements import alone
from pipeline.physics.time_stepping.initial_state import forces_at_rest
from pipeline.physics.time_stepping.normal_laws import Penalty, tangent
from pipeline.physics.time_stepping.simulate import Start


@dataclass(frozen=True)
class AddedPhysics:
    """``friction``: the Friction with effects, Grouped or not, under the conditions of the case; ``law``: Table or
    Penalty, Grouped or not, in place of the table of a Family, None where that holds.

    ``steeper`` and ``faster``: factors of a draw on the slope of the law and on the closing speed of its damping.
    """

    friction: object
    law: object = None
    steeper: float = 1.0
    faster: float = 1.0

    def varied(self, factors):
        """The same with the Factors of a draw."""
        return replace(self, steeper=factors.contact_stiffness * self.steeper,
                       faster=factors.damping_speed * self.faster)

    def pressed(self, area, closure, steeper=1.0):
        """(force (c,) N, slope (c,) N/m) of contacts of ``area`` (c,) m^2 by the law at ``closure`` (c,) m, at a given
        pressure another ``steeper`` times as steep."""
        steeper, (force, slope) = steeper * self.steeper, np.zeros((2, len(closure)))
        for law, members in parts(self.law, len(closure)):
            pushed = steeper * closure[members]
            if isinstance(law, Penalty):
                spring = np.broadcast_to(law.stiffness, len(closure))[members]
                force[members], slope[members] = np.maximum(spring * pushed, 0.0), np.where(pushed > 0, spring, 0.0)
            else:
                force[members], slope[members] = force_at_rest(pushed, area[members], law.closure, law.pressure)
        return force, steeper * slope

    def curvature(self, area, closure, of_table):
        """(c,) N/m^2 of the law at ``closure`` (c,) m: of tables ``of_table(closure, closures, pressures)`` Pa/m^2, of
        springs 0."""
        found = np.zeros(len(closure))
        for law, members in parts(self.law, len(closure)):
            if not isinstance(law, Penalty):
                found[members] = area[members] * of_table(self.steeper * closure[members], law.closure, law.pressure)
        return self.steeper**2 * found

    def tangent(self, area, force, factors):
        """(stiffness (c,) N/m, damping (c,) N s/m) of contacts that carry a ``force`` (c,) N in a draw of Factors."""
        stiffness, damping = tangent(self.law, force, area)
        return factors.contact_stiffness * self.steeper * stiffness, damping / (factors.damping_speed * self.faster)

    def states(self, model, load):
        """(StateKernel, values) of friction in steady sliding of a SlidingModel under a ``load`` (c,) N."""
        return friction_about(self.friction, model.sliding_speed, load, model.contacts.area)[1]


def acting(friction, direction, area, pressure, speed):
    """FrictionState (c,) of a Friction in steady sliding at a ``pressure`` (c,) Pa and a ``speed`` (c,) m/s in a
    ``direction`` (c,), 1 or -1, of contacts of ``area`` (c,) m^2."""
    return friction_about(friction, direction * speed, pressure * area, area)[0]


def resting(model, place):
    """(force (n,) N, its slope (n, n) N/m) of the elements of a SlidingModel at rest in ``place`` (n,) m, which resist
    it."""
    if not model.elements:
        return 0.0, 0.0
    rows, force, slope, _ = forces_at_rest(alone(model.elements), model, place)
    return force @ rows, (rows.T * slope) @ rows


def slopes_of_elements(model, place, force, drawn):
    """(2, e) stiffness N/m and damping N s/m of the elements of a SlidingModel about a sliding state: ``place`` (n,) m,
    normal ``force`` and friction ``drawn`` (c,) N."""
    if not model.elements:
        return np.zeros((2, 0))
    start = Start(place, np.zeros(model.size), force, drawn)
    return np.array(element_slopes(model, start, model.sliding_speed)[1:])
