"""What an effect is: a piece of physics that a model may lack, where it can be, and how it changes the model.

    changed = compose(bench, (Term(effect, "joint_0", {"coefficient": 1e9}),))

A model is a Bench, or on the scale of the roughness a Rubbing, whose one place are its asperities. An effect never
changes what it is given. Where every parameter that has a null stands at it, the changed model answers bit for bit as
before. Effects are put on in the order of STAGES, within a stage in that of the terms.
"""

from collections.abc import Callable
from dataclasses import dataclass

from pipeline.contract.errors import ConfigError
from pipeline.effects.typical import ASPERITIES, Typical, places, typical
from pipeline.physics.rough.sliding_pair import Rubbing

#: order in which effects are put on: what others refer to (joints, masses) first, sensors last
STAGES = ("structure", "contact", "friction", "excitation", "measurement")


@dataclass(frozen=True)
class Effect:
    """One effect.

    ``summary``: its sentence in a report; ``place``: kind of place (``typical``); ``stage``: one of STAGES;
    ``parameters(typical)``: its Parameters, with priors of these sizes, whose supports are the bounds of sign and
    passivity; ``apply(bench, place, values)``: the equation; ``source``; ``valid``: "Valid while ..."; ``linear``:
    parameters that the forces are linear in; ``kind``: physics or sensor; ``conditions``: those that runs must tell;
    ``micro``: whether it acts on a Rubbing too, where every effect whose place are the asperities acts alone;
    ``small``: whether small motions about steady sliding see it, and complex modes with them.
    """

    name: str
    summary: str
    place: str
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

    def places(self, model):
        """Names of the places of a Bench or a Rubbing where the effect can be."""
        if isinstance(model, Rubbing):
            return (ASPERITIES,) if self.micro or self.place == ASPERITIES else ()
        return () if self.place == ASPERITIES else places(self.place, model)

    def told_by(self, runs):
        """Whether all ``runs`` tell the conditions that the effect depends on."""
        return all(name in run.conditions for name in self.conditions for run in runs)

    def at(self, bench, place, runs):
        """Parameters with priors of the sizes that nominal ``runs`` have at ``place``."""
        return self.parameters(typical(self.kind_at(place), bench, place, runs))

    def kind_at(self, place):
        """Kind of a place of the effect."""
        return ASPERITIES if place == ASPERITIES else self.place

    def on(self, bench, place, values):
        """The model with this effect. ConfigError for unknown places, other names, values beyond the bounds."""
        if place not in self.places(bench):
            raise self._nowhere(bench, place)
        known = {p.name: p for p in self.parameters(Typical())}
        if set(known) != set(values):
            raise ConfigError(f"effect {self.name}: parameters", ", ".join(known), ", ".join(values) or "none")
        for name, value in values.items():
            low, high = known[name].prior.support
            if not low <= value <= high:
                raise ConfigError(f"effect {self.name}: {name}", f"{low:g} to {high:g} {known[name].unit}",
                                  f"{value:g}")
        return self.apply(bench, place, values)

    def _nowhere(self, model, place):
        if ASPERITIES in (place, self.place) and not isinstance(model, Rubbing):
            return ConfigError(f"effect {self.name}: place", "a rough pair, as stage micro_friction has it", "a bench",
                               "asperities and what acts on them mean nothing where contacts are points or faces")
        return ConfigError(f"effect {self.name}: place", f"one of {', '.join(self.places(model)) or 'none here'}",
                           repr(place))


@dataclass(frozen=True)
class Term:
    """An effect at a place with values {parameter: value}."""

    effect: Effect
    place: str
    values: dict


def compose(bench, terms):
    """The bench with all ``terms`` on it, in the declared order, whatever theirs is between stages."""
    for term in sorted(terms, key=lambda t: STAGES.index(t.effect.stage)):
        bench = term.effect.on(bench, term.place, term.values)
    return bench


def null_values(parameters):
    """{name: value} at which the effect vanishes: nulls, and nominal values of what only shapes it."""
    return {p.name: p.nominal if p.null is None else p.null for p in parameters}


def shaped_values(parameters, share=0.5):
    """{name: value} at the quantile ``share`` of each prior; 0 lies in the middle of those of either sign."""
    return {p.name: float(p.prior.quantile(share)) for p in parameters}
