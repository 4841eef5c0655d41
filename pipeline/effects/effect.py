"""What an effect is: a piece of physics that a model may lack, where it can be, and how it changes the model.

    changed = compose(bench, (Term(effect, "joint_0", {"coefficient": 1e9}),))

A model is a Bench or, at the scale of the roughness, a Rubbing, whose only location are its asperities. An effect
never changes the model it is given. With every parameter at its null, the changed model gives the same results bit for
bit. Effects are applied in the order of STAGES, within a stage in the order of the terms.
"""

from collections.abc import Callable
from dataclasses import dataclass

from pipeline.contract.errors import ConfigError
from pipeline.effects.typical import ASPERITIES, Typical, locations, typical
from pipeline.physics.rough.sliding_pair import Rubbing

#: order in which effects are put on: what others refer to (joints, masses) first, sensors last
STAGES = ("structure", "contact", "friction", "excitation", "measurement")


@dataclass(frozen=True)
class Effect:
    """One effect.

    ``summary``: its sentence in a report; ``location``: kind of location (see ``typical``); ``stage``: one of STAGES;
    ``parameters(typical)``: its Parameters, with priors scaled by typical quantities, whose supports are the bounds of
    sign and passivity; ``apply(bench, location, values)``: the equation; ``source``; ``valid``: "Valid while ...";
    ``linear``: parameters that the forces are linear in; ``kind``: physics or sensor; ``conditions``: conditions that
    every run must state; ``micro``: whether it also acts on a Rubbing (effects located at the asperities act there
    only); ``small``: whether it enters the model linearised about steady sliding, and so the complex modes;
    ``elaborate``: whether it has so many values, or is so costly, that it is weighed only where simpler effects leave
    something; ``extends``: names of effects that are limits of it, beside which it counts by what it adds; ``family``:
    what such laws of a joint are called together, where it may be known and the form of the law not. ``weighed``:
    whether a diagnosis looks for it where it is not asked to: recordings do not find it before a value of it is known.
    """

    name: str
    summary: str
    location: str
    stage: str
    parameters: Callable
    apply: Callable
    source: str
    valid: str
    linear: tuple = ()
    kind: str = "physics"
    conditions: tuple = ()
    micro: bool = False
    small: bool = True
    elaborate: bool = False
    extends: tuple = ()
    family: str = ""
    weighed: bool = True

    def locations(self, model):
        """Names of the locations of a Bench or a Rubbing where the effect can act."""
        if isinstance(model, Rubbing):
            return (ASPERITIES,) if self.micro or self.location == ASPERITIES else ()
        return () if self.location == ASPERITIES else locations(self.location, model)

    def conditions_known(self, runs):
        """Whether all ``runs`` state the conditions that the effect depends on."""
        return all(name in run.conditions for name in self.conditions for run in runs)

    def at(self, bench, location, runs):
        """Parameters, with priors scaled by the typical quantities of nominal ``runs`` at ``location``."""
        return self.parameters(typical(self.kind_at(location), bench, location, runs))

    def kind_at(self, location):
        """Kind of a location of the effect."""
        return ASPERITIES if location == ASPERITIES else self.location

    def on(self, bench, location, values):
        """The model with this effect. ConfigError for an unknown location or parameter, or a value out of bounds."""
        if location not in self.locations(bench):
            raise self._nowhere(bench, location)
        known = {p.name: p for p in self.parameters(Typical())}
        if set(known) != set(values):
            raise ConfigError(f"effect {self.name}: parameters", ", ".join(known), ", ".join(values) or "none")
        for name, value in values.items():
            low, high = known[name].prior.support
            if not low <= value <= high:
                raise ConfigError(f"effect {self.name}: {name}", f"{low:g} to {high:g} {known[name].unit}",
                                  f"{value:g}")
        return self.apply(bench, location, values)

    def _nowhere(self, model, location):
        if ASPERITIES in (location, self.location) and not isinstance(model, Rubbing):
            return ConfigError(f"effect {self.name}: location", "a rough pair, as in stage micro_friction", "a bench",
                               "asperities need a rough surface; the contacts of a bench are points or faces")
        if not isinstance(model, Rubbing) and location in model.model.moved_ends.values():
            return ConfigError(f"effect {self.name}: location", "a joint whose far end stands still", repr(location),
                               "describe the motion relative to that end: a force of minus mass times its acceleration")
        return ConfigError(f"effect {self.name}: location", f"one of {', '.join(self.locations(model)) or 'none here'}",
                           repr(location))


@dataclass(frozen=True)
class Term:
    """An effect at a location with values {parameter: value}."""

    effect: Effect
    location: str
    values: dict


def compose(bench, terms):
    """The bench with all ``terms``, applied in the order of STAGES whatever the order given."""
    for term in sorted(terms, key=lambda t: STAGES.index(t.effect.stage)):
        bench = term.effect.on(bench, term.location, term.values)
    return bench


def null_values(parameters):
    """{name: value} at which the effect vanishes: nulls, and nominal values of parameters without a null."""
    return {p.name: p.nominal if p.null is None else p.null for p in parameters}


def shaped_values(parameters, probability=0.5):
    """{name: value}: quantile of each prior at ``probability``; the median is 0 for priors symmetric about 0."""
    return {p.name: float(p.prior.quantile(probability)) for p in parameters}
