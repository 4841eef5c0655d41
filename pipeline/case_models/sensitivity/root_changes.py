"""First-order changes of the roots of a case, whose sliding state follows what is varied.

The sliding state q of a case follows from R(q, p) = 0, a root s from y^H T(s, q, p) x = 0, p what is varied, scaled so
that y^H (dT/ds) x = 1. Between two values of p the root changes by

    ds = - y^H (T(s, q + dq, p)|_high - T(s, q + dq, p)|_low) x,    dq = - (dR/dq)^-1 R(q, p),

so that no system is solved again: T is applied to x term by term, where terms differ, and dq is one step of Newton's
method. Contacts and friction follow their laws as ``local_laws`` has them.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import scipy

from pipeline.case_models.sensitivity.local_laws import LocalFriction, LocalLaw
from pipeline.case_models.sensitivity.matrices import Case, polished_root, varied
from pipeline.physics.contact.static_preload import Preload
from pipeline.physics.sliding.equilibrium import displacement, model_about
from pipeline.physics.stability.draws.added_physics import resting, slopes_of_elements
from pipeline.physics.stability.draws.draw_system import BodyLosses, draw_system
from pipeline.physics.stability.draws.sampled_sliding import Contact, GivenSliding, whole_sliding
from pipeline.physics.stability.draws.scatter import NOMINAL
from pipeline.physics.stability.draws.whole_roots import sliding_state
from pipeline.physics.system.terms import Kind

#: rows of their tables over which the slopes of contact law and friction are averaged
REACHES = (1, 2)
#: steps of Newton's method where friction remembers, whose tangent lacks what it remembers
_SETTLINGS = 3


@dataclass(frozen=True)
class FollowedRoots:
    """Roots of a Case with what follows them: ``place`` (n,) m its sliding state, ``modes`` a RootWithVectors of each
    root, ``settle(imbalance)`` what an imbalance (n,) N moves it by, ``laws``: of each reach the LocalLaw, None without
    one, and the LocalFriction."""

    case: Case
    place: np.ndarray
    modes: tuple
    settle: Callable | None
    laws: tuple

    def changes(self, ends, friction_map, points):
        """(reach, r) first-order change of each root, 1/s, from the first to the second of two Cases ``ends``."""
        made = [varied(replace(end, factors=NOMINAL), friction_map, points) for end in ends]
        found = []
        for law, friction in self.laws:
            low, high = (self._system(replace(each, friction=friction).varied(each.filled(end.factors)), law,
                                      end.factors.contact_stiffness) for each, end in zip(made, ends, strict=True))
            found.append([-(mode.left.conj() @ high.beyond(low, mode.root, mode.right)) for mode in self.modes])
        return np.array(found)

    def _system(self, family, law, steeper):
        """System of a Family that is varied, about where its sliding state has moved to."""
        place = self.place
        if law is not None:
            for _ in range(_SETTLINGS if family.added else 1):
                place = place - self.settle(_imbalance(family, _contact(family, law, steeper, place), place))
        return _about(family, _contact(family, law, steeper, place))


def followed_roots(case, roots, friction_map, points):
    """FollowedRoots of a Case, its model Fields as of ``without_surface``, for ``roots`` (r,) 1/s near its own."""
    made = varied(case, friction_map, points)
    place, preload = _sliding(made)
    laws = tuple((LocalLaw.about(made, preload, reach) if made.has_law else None,
                  LocalFriction.about(made, preload.force, friction_map, reach)) for reach in REACHES)
    contact = _contact(made, laws[0][0], case.factors.contact_stiffness, place)
    system = _about(made, contact)
    return FollowedRoots(case, place, tuple(polished_root(system, root) for root in roots),
                         _settling(made, contact, place) if made.has_law else None, laws)


def _sliding(family):
    """(place (n,) m, Preload) of a Family in steady sliding; a place of zeros without a normal law."""
    model = family.model
    if not family.has_law:
        contact = GivenSliding(family).slide(NOMINAL, model.speed)
        return np.zeros(model.size), Preload(contact.force, contact.stiffness, 0 * contact.force)
    if family.added is None:
        sliding = sliding_state(family)
        place = displacement(model, sliding.contact, sliding.friction.coefficient, family.input_force,
                             family.centrifugal)
        return place, sliding.contact
    basis = whole_sliding(family)
    place = basis.solve(NOMINAL, model.speed)
    contact = basis.slide(NOMINAL, model.speed)
    return place, Preload(contact.force, contact.stiffness, _closure(model, place))


def _closure(model, place):
    return -(model.contacts.normal @ place + model.contacts.gap)


def _contact(family, law, steeper, place):
    """Contact of a Family at a ``place`` (n,) m by a LocalLaw, whose slope is ``steeper`` times its own at a given
    pressure; without one as the model has it."""
    model = family.model
    if law is None:
        return GivenSliding(family).slide(NOMINAL, model.speed)
    area, (force, slope), damping = model.contacts.area, law(steeper, _closure(model, place)), None
    friction = family.friction(force / area, abs(model.sliding_speed))
    if family.law_added:
        damping = family.added.tangent(area, np.where(model.contacts.fixed, 0.0, force), NOMINAL)[1]
    drawn = model.direction() * friction.coefficient * force
    return Contact(force, slope, friction, damping, slopes_of_elements(model, place, force, drawn))


def _about(family, contact):
    """System of a Family about a Contact."""
    return draw_system(family, family.model, family.filled(NOMINAL), contact, BodyLosses.whole(family))


def _imbalance(family, contact, place):
    """(n,) N: what holds the bodies of a Family at rest in a ``place`` (n,) m less what pushes them."""
    model = family.model
    drawn = model.direction() * contact.friction.coefficient * contact.force
    held = model.supporting(False, family.centrifugal).of_kind(Kind.STIFFNESS, place) + resting(model, place)[0]
    pushed = contact.force @ model.contacts.normal + drawn @ model.contacts.tangent
    return held - family.input_force @ model.input_rows - pushed


def _settling(family, contact, place):
    """How a Family answers an imbalance (n,) N in steady sliding, by its tangent there."""
    model = model_about(family.model, contact)
    tangent = model.frictionless(False, family.centrifugal)[2] + model.friction_matrices(contact.friction, False)[1]
    factor = scipy.linalg.lu_factor(tangent + resting(model, place)[1])
    return lambda imbalance: scipy.linalg.lu_solve(factor, imbalance)
