"""A case about steady sliding: its model with the effects that small motions see, and where it comes to slide."""

from dataclasses import dataclass, field, replace
from functools import cached_property, partial

import numpy as np

from pipeline.case_models.virtual_rig import groups
from pipeline.contract import ConfigError
from pipeline.effects.effect import compose
from pipeline.physics.contact.closure_law import damping_at_rest
from pipeline.physics.contact.groups import alike, read
from pipeline.physics.contact.static_preload import Preload
from pipeline.physics.friction.dry_friction import Friction, constant, falling, under
from pipeline.physics.friction.friction_table import FrictionLaw, refuse_beyond
from pipeline.physics.friction.tangential_law import tangential_law
from pipeline.physics.sliding.doublets import doublets
from pipeline.physics.sliding.equilibrium import (
    closure_response,
    falling_with_speed,
    from_map,
    given_state,
    steady_sliding,
)
from pipeline.physics.sliding.model import FrictionState, sliding_model
from pipeline.physics.sliding.unreduced_equilibrium import sliding_on_elements
from pipeline.physics.stability.full_roots import sliding_as
from pipeline.physics.stability.linearisation import (
    beside_motion,
    element_rows,
    element_slopes,
    friction_about,
    maxwell_branches,
    present,
    with_slopes,
)
from pipeline.physics.system.forms import spread
from pipeline.physics.time_stepping.elements import Turning, bears
from pipeline.physics.time_stepping.initial_state import steady_start
from pipeline.physics.time_stepping.normal_laws import tangent
from pipeline.physics.time_stepping.simulate import Hard, Penalty, Start, Table
from pipeline.physics.virtual_rig.response import Bench

#: step of a bench that is not stepped: dry friction of joints, which alone asks for it, is left out
_STEP = 1e-6


@dataclass(frozen=True)
class Steady:
    """Steady sliding: contacts, their damping (c,) N s/m, friction with its states, slopes (2, e) of elements, and the
    elongations (e,) m and the memory (s,), or None, at which they ``rest``."""

    contact: Preload
    damping: np.ndarray
    friction: FrictionState
    states: tuple | None = None
    slopes: np.ndarray | None = None
    rest: tuple | None = None

    def about(self, model):
        """A SlidingModel linearised about it: contacts, and elements, whose slopes join the matrices of the bodies."""
        contacts = replace(model.contacts, preload=self.contact.force, stiffness=self.contact.stiffness,
                           damping=self.damping)
        return with_slopes(replace(model, contacts=contacts), self.slopes)

    def acting(self, slopes=True):
        """FrictionState that acts at once; without ``slopes`` that of a constant coefficient."""
        whole = self._friction(slopes)
        return whole if self.states is None else present(whole, self.states)

    def with_share(self, share):
        """The same state with a ``share`` of its friction; forces, stiffnesses and damping stay."""
        parts = (share * part for part in (self.friction.coefficient, self.friction.pressure_slope,
                                           self.friction.speed_slope))
        return replace(self, friction=FrictionState(*parts))

    def beside(self, model, slopes=True):
        """Settling of a model linearised ``about`` this state, in its coordinates; None where nothing settles."""
        return None if self.states is None else beside_motion(model, self._friction(slopes), self.states)

    def _friction(self, slopes):
        return self.friction if slopes else FrictionState(self.friction.coefficient)


@dataclass(frozen=True)
class Posed:
    """One state of a case at one speed: the bench of its model alone (``base``), and with the effects ``terms``."""

    base: Bench
    bench: Bench
    terms: tuple = ()
    conditions: dict = field(default_factory=dict)

    @cached_property
    def moved(self):
        """Whether effects put the contacts elsewhere: by laws of their own, or elements that bear load at rest."""
        count = len(self.base.model.contacts.area)
        return any(map(bears, self.bench.model.elements)) or not alike(self.base.law, self.bench.law, count)

    def at_speed(self, speed):
        """The same at another speed of the drive."""
        return replace(self, **{name: replace(bench, model=bench.model.at_speed(speed))
                                for name, bench in (("base", self.base), ("bench", self.bench))})

    def within(self, model):
        """The same in other coordinates: those of ``model``, a projection of that of the bench."""
        return replace(self, base=replace(self.base, model=model), bench=replace(self.bench, model=model))

    def response(self, centrifugal):
        """ClosureResponse where the law of the model is what a sliding state is found with, else None."""
        tabled = isinstance(self.base.law, Table) and not self.moved
        return closure_response(self.bench.model, centrifugal) if tabled else None

    @property
    def seeking(self):
        """The same in the coordinates in which its sliding state is found."""
        return self.condensed() if self.moved else self

    def condensed(self):
        """The same in the static answers to the forces of contacts, elements and inputs, which hold all that rests;
        contacts without a table keep their coordinates."""
        model = self.bench.model
        if not isinstance(self.base.law, Table):
            return self
        rows = [model.contacts.normal, model.contacts.tangent, model.input_rows, *(e.row[None] for e in model.elements)]
        answers = np.linalg.solve(model.frictionless()[2], np.vstack(rows).T)
        sizes = np.linalg.norm(answers, axis=0)
        return self.within(model.projected(np.linalg.qr(answers[:, sizes > 0] / sizes[sizes > 0])[0]))

    def friction(self, given):
        """The Friction ``given`` with the effects on it; itself where they leave it alone."""
        terms = tuple(t for t in self.terms if t.effect.stage == "friction")
        return under(compose(replace(self.base, friction=given), terms).friction, self.conditions, "effects")

    def slide(self, response, input_force, given, plain, settings):
        """Steady of this state under ``input_force`` (i,) N.

        ``response``: ClosureResponse of the model, or None where its contacts have no law. ``given``: Friction before
        effects, ``plain`` the same as ``steady_sliding`` asks for it; ``settings``: the section ``complex_modes``.
        """
        if not self.terms:
            return self._found(self._as_given(response, input_force, plain), settings)
        friction, model = self.friction(given), self.bench.model
        state = plain if friction is given else partial(_state, friction, model)
        if not self.moved:
            solution = self._found(self._as_given(response, input_force, state), settings)
            drawn = model.direction() * solution.friction.coefficient * solution.contact.force
            start = Start(np.zeros(model.size), np.zeros(model.size), solution.contact.force, drawn)
        else:
            solution, start = self._anew(friction, input_force, settings)
        states = friction_about(friction, model.sliding_speed, solution.contact.force, model.contacts.area)[1]
        slopes = element_slopes(model, start, model.sliding_speed)[1:]
        rest = element_rows(model) @ start.displacement, start.memory
        return replace(solution, states=states, slopes=np.array(slopes), rest=rest)

    def slide_on_elements(self, full, begin, input_force, plain, settings, solve):
        """(SlidingModel ``full`` of the finite elements behind the model, about it, and its Steady) under
        ``input_force`` (i,) N, without effects.

        ``begin``: Steady of the model; ``plain``, ``settings``: as of ``slide``; ``solve``: Solutions, which states of
        the same elements may share. Contacts without a table keep the state of the model.
        """
        about, law = sliding_as(full, begin.about(self.bench.model)), self.base.law
        if not isinstance(law, Table):
            return about, begin
        found = self._found(sliding_on_elements(about, input_force, (law.closure, law.pressure), plain,
                                                begin.contact.closure, solve, settings.centrifugal), settings)
        return found.about(about), found

    def _as_given(self, response, input_force, state):
        if response is None:
            return given_state(self.bench.model, state)
        law = self.base.law
        return steady_sliding(self.bench.model, response, input_force, law.closure, law.pressure, state)

    def _found(self, sliding, settings):
        force = sliding.contact.force
        return Steady(sliding.contact, damping_at_rest(force, settings.damping_speed), sliding.friction)

    def _anew(self, friction, input_force, settings):
        """(Steady, Start) with the laws and elements of the effects."""
        model, law = self.bench.model, self.bench.law
        if not settings.centrifugal:
            model = replace(model, centrifugal=0 * model.centrifugal)
        start, area = steady_start(model, law, friction, input_force), model.contacts.area
        pressed = np.where(model.contacts.fixed, 0.0, start.normal)
        stiffness, damping = (0 * pressed, 0 * pressed) if isinstance(law, Hard) else tangent(law, pressed, area)
        closure = -(model.contacts.normal @ start.displacement + read(law, "gap", len(area)))
        state = friction_about(friction, model.sliding_speed, start.normal, area)[0]
        return Steady(Preload(start.normal, stiffness, closure), damping, state), start


def posed(model, state, speed, damping_speed, terms=(), conditions=None):
    """Posed of a product ReducedModel at one row of its preload table, with those of the Terms that small motions see.

    ConfigError for unknown locations, of any of the terms.
    """
    sliding = sliding_model(model, state, speed)
    base = Bench(sliding, _law(model, sliding.contacts, damping_speed), constant(0.0), _STEP, (), groups(model),
                 doublets=doublets(sliding) if terms else {})
    compose(base, terms)
    seen = tuple(t for t in terms if t.effect.small)
    return Posed(base, compose(base, seen), seen, conditions or {})


def refuse_twice(bench, friction_damping):
    """Refuse friction that turns with the slip by an effect and by the setting of complex modes as well."""
    turning = [e.name for e in bench.model.elements if isinstance(e.law, Turning) and e.law.share > 0]
    if turning and friction_damping:
        raise ConfigError("effects.friction_induced_damping", "complex_modes.friction_damping: false beside it",
                          "true, which is the same physics", "set it to false, or leave the effect out")


def branch_stiffness(model):
    """(n, n) N/m of the Maxwell branches of a SlidingModel as they answer at once; None without any."""
    rows, springs, _ = maxwell_branches(model)
    return spread(rows, springs, rows) if len(springs) else None


def _state(friction, model, pressure, speed):
    """FrictionState of a Friction at pressures (c,) Pa, sliding as the model does."""
    area = model.contacts.area
    return friction_about(friction, model.sliding_speed, pressure * area, area)[0]


def _law(model, contacts, damping_speed):
    """Law of the contacts of a product ReducedModel: its table, the stiffness of its preload, or none that yields."""
    if len(model.law_closure):
        return Table(model.law_closure, model.law_pressure, damping_speed, model.contact_gap)
    stiffness = contacts.stiffness
    if not stiffness.any():
        return Hard(0.0, model.contact_gap)
    return Penalty(np.where(stiffness > 0, stiffness, stiffness.max()),
                   damping_at_rest(contacts.preload, damping_speed), model.contact_gap)


def stated_friction(settings):
    """The same as of ``mapped_friction`` for the friction that the section ``complex_modes`` states."""
    decay_speed, last = settings.decay_speed, settings.friction
    at_rest = last if settings.friction_at_rest is None else settings.friction_at_rest
    return falling(at_rest, last, decay_speed), partial(falling_with_speed, last, at_rest, decay_speed)


def mapped_friction(friction_map, distance):
    """(Friction, function of pressure and speed, each (c,), giving a FrictionState) of a product FrictionMap, read at
    the sliding ``distance`` in m."""
    law = FrictionLaw.of(friction_map)
    return Friction(law, distance=distance), partial(from_map, law, distance)


def sliding_friction(friction_map, model, settings):
    """The same of the products FrictionMap, or None, and ReducedModel: of the map; without one, of the ``settings`` (as
    of the section ``complex_modes``) or of the model. Raises ConfigError beyond the distances of the map."""
    if friction_map is not None:
        refuse_beyond(settings.sliding_distance, friction_map.distance[-1], "complex_modes.sliding_distance")
        return mapped_friction(friction_map, settings.sliding_distance)
    if settings.friction is None:
        law = tangential_law(model).friction_law()
        return Friction(law), partial(from_map, law, 0.0)
    return stated_friction(settings)
