"""A sliding state as a system of matrices: terms of mass, damping, stiffness and loss, by what they stand for.

The terms are those of ``SlidingModel.linearised``, one by one, with what each is multiplied by as speed and friction
change while contacts and their forces stay: the form in which the chain ``matrices`` reads a system.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from pipeline.case_models.effect_block import conditions, physics_terms
from pipeline.case_models.operating_points import StabilitySettings
from pipeline.case_models.steady_sliding import Posed, Steady, posed, sliding_friction
from pipeline.contract import ConfigError, ProductError
from pipeline.physics.sliding.model import SlidingModel, at_state
from pipeline.physics.sliding.unreduced_equilibrium import Solutions
from pipeline.physics.stability.constrained_modes import is_hard
from pipeline.physics.stability.growth_balance import Losses
from pipeline.physics.system.forms import Block
from pipeline.physics.system.system import System
from pipeline.physics.system.terms import Kind, Term, What

#: contact forces that were computed again may differ from those of the product by this share of the largest
_SAME = 1e-6


@dataclass(frozen=True)
class SlidingState:
    """A case about steady sliding: its Posed, its Steady, the section ``complex_modes``, and the SlidingModel ``about``
    it; ``losses``: of the product ReducedModel; ``input_force`` (i,) N, ``plain``: as of ``Posed.slide``."""

    posed: Posed
    sliding: Steady
    settings: object
    about: SlidingModel
    losses: Losses
    input_force: np.ndarray
    plain: Callable

    @property
    def friction(self):
        """FrictionState that acts about it."""
        return self.sliding.acting(self.settings.friction_slopes)

    @property
    def hysteretic(self):
        """((n, n) damping, (n, n) imaginary stiffness) that make loss factors hysteretic; None where they are not."""
        if not self.settings.hysteretic:
            return None
        return self.losses.enlarged(self.about.size).change(self.posed.base.model)

    @property
    def beside(self):
        """Settling of effects with states of their own beside the model, None without any."""
        return self.sliding.beside(self.about, self.settings.friction_slopes)

    def on_elements(self, full, solver):
        """The same about the steady sliding of the SlidingModel ``full``, the finite elements behind the model."""
        about, sliding = self.posed.slide_on_elements(full, self.sliding, self.input_force, self.plain, self.settings,
                                                      Solutions(solver))
        return replace(self, about=about, sliding=sliding)

    @property
    def linearised(self):
        """(M, C, K), each (n, n), without what makes loss factors hysteretic."""
        points = self.settings
        return self.about.linearised(self.friction, points.friction_damping, points.gyroscopic, points.centrifugal)


def sliding_at(modes, model, friction_map, effects, operating):
    """SlidingState of the products ComplexModes, ReducedModel, FrictionMap or None, Effects or None, at an operating
    point, an index of the first."""
    settings = StabilitySettings.of(modes)
    pressure, speed = modes.operating_pressure[operating], float(modes.operating_speed[operating])
    state = int(np.argmin(abs(model.pressure - pressure)))
    case = posed(model, state, speed, settings.damping_speed, physics_terms(effects), conditions(effects))
    load, law = model.pressure[state] * model.input_area, sliding_friction(friction_map, model, settings)
    sliding = case.seeking.slide(case.response(settings.centrifugal), load, *law, settings)
    return SlidingState(case, sliding, settings, sliding.about(case.bench.model), Losses.of(at_state(model, state)),
                        load, law[1])


def sliding_state(modes, model, friction_map, effects, operating):
    """The same where matrices can hold it.

    Raises ConfigError for contacts that do not yield and for effects with states of their own, neither of which
    matrices can hold; ProductError for products that do not belong together.
    """
    state = sliding_at(modes, model, friction_map, effects, operating)
    if is_hard(state.about):
        raise ConfigError("export: contacts", "a normal stiffness, which matrices can hold", "hard contacts",
                          "give them a contact law or a stiffness")
    if state.beside is not None:
        raise ConfigError("export: effects", "forces of displacement and velocity alone", "effects with states of their"
                          f" own, among {', '.join(t.effect.name for t in state.posed.terms)}", "leave these out")
    force, known = state.sliding.contact.force, modes.operating_force[operating]
    if force.shape != known.shape or abs(force - known).max(initial=0.0) > _SAME * abs(known).max(initial=0.0):
        raise ProductError("export: contact forces", "those of complex_modes.h5", "others from reduced_model.h5, whose"
                           " run or effects differ", "'brakechain run' computes what is out of date")
    return state


def terms_of(state):
    """Terms of a SlidingState in the reduced model."""
    return terms_about(state.about, state.friction, state.settings, state.hysteretic)


def terms_about(about, friction, settings, hysteretic=None):
    """Terms of a SlidingModel, dense or sparse, with a FrictionState; those without entries are left out.

    ``hysteretic``: (damping, imaginary stiffness) to add, or None. Imaginary parts of stiffnesses are terms of loss.
    """
    parts = [*about.system(friction, settings.friction_damping, settings.gyroscopic, settings.centrifugal).terms]
    if hysteretic is not None:
        parts += [Term(What.STRUCTURAL_DAMPING, Kind.DAMPING, Block(hysteretic[0])),
                  Term(What.STRUCTURAL_STIFFNESS, Kind.STIFFNESS, Block(hysteretic[1]))]
    whole = System(tuple(parts), about.coordinate_body)
    found = []
    for what in What:
        members = whole.where(lambda term, what=what: term.name == what)
        if not members.terms:
            continue
        kind = members.terms[0].kind
        matrix = members.matrix(kind)
        found.append(Term.whole(what, kind, matrix.real, members.terms[0].times))
        if kind is Kind.STIFFNESS and np.iscomplexobj(matrix):
            found.append(Term.whole(What.HYSTERETIC_LOSS, Kind.LOSS, matrix.imag))
    return tuple(term for term in found if abs(term.matrix).max() > 0)
