"""The block ``effects`` of a case: terms of the catalogue, from YAML to a product and from there onto a bench.

    effects:
      falling_friction: {contact: {rise: 0.2, decay_speed: 100 mm/s}}         # effect: {location: {parameter: value}}
      conditions: {humidity: 0.8}             # what some effects depend on, where no recorded run states it

A bench keeps its terms and what it was without them, so that it can be composed anew with other values: numbers of it
that may be wrong, EFFECT@LOCATION.PARAMETER.
"""

from dataclasses import dataclass, replace

from pipeline.contract import ConfigError, Quantity, option, section
from pipeline.effects import CATALOGUE, named
from pipeline.effects.effect import Term, compose
from pipeline.effects.typical import ASPERITIES, Typical
from pipeline.physics.friction.dry_friction import under
from pipeline.products import Effects

#: what stands between an effect and its location in a name
MARK = "@"


def parameters(effect):
    """Parameters of an effect: names, units and bounds, whatever the bench."""
    return effect.parameters(Typical())


def written(unit):
    """Unit in which a value of this unit is written; those of a channel are numbers in its SI unit."""
    return "1" if "unit of the channel" in unit else unit


def _values(effect):
    """Section of the values of one effect at one location."""
    fields = {p.name: (Quantity(written(p.unit)), option(..., f"{p.name.replace('_', ' ')} [{p.unit}]"))
              for p in parameters(effect)}
    return section(f"{effect.name}_values", effect.summary, fields)


#: conditions that effects depend on, each a number or not stated
Conditions = section("Conditions", "Conditions of a case, as runs have them.", {
    name: (float | None, option(None, f"{name} [1]"))
    for name in dict.fromkeys(name for effect in CATALOGUE for name in effect.conditions)})
#: the section: one key an effect, each a mapping from locations to values, and the conditions
Settings = section("Settings", "Physics added to the model: effect, location, values.", {
    **{effect.name: (dict[str, _values(effect)],
                     option({}, f"{effect.summary}; at: {effect.location}{' or asperities' if effect.micro else ''}"))
       for effect in CATALOGUE},
    "conditions": (Conditions, option(Conditions(), "conditions of motions that no recorded run states"))})

_REMEDY = {True: "asperities are locations of a rough pair, such as that of the disc brake",
           False: f"at the scale of the roughness the location is {ASPERITIES}"}
#: stages that put effects on their model: at the asperities of a rough pair, and at any other location
_ACTING = {True: ("micro_friction",), False: ("complex_modes", "multibody", "transient", "bench")}


def check_locations(sections):
    """Refuse effects at locations that no stage of {stage: settings} models; ConfigError."""
    for name, locations in _blocks(sections["effects"]).items():
        for location in locations:
            micro = location == ASPERITIES
            if not set(_ACTING[micro]) & set(sections):
                raise ConfigError(f"effects.{name}.{location}",
                                  f"a chain with {' or '.join(_ACTING[micro])}, where this location exists", "none",
                                  _REMEDY[micro])


def _blocks(settings):
    """{effect: {location: values}} of a filled section."""
    return {name: block for name, block in dict(settings).items() if name != "conditions"}


def product(settings):
    """The product Effects of a filled section."""
    stated = {name: value for name, value in dict(settings.conditions).items() if value is not None}
    rows = [(name, location, dict(values)) for name, locations in _blocks(settings).items()
            for location, values in locations.items()]
    units = {(e.name, p.name): p.unit for e in CATALOGUE for p in parameters(e)}
    flat = [(k, name, parameter, value) for k, (name, _, values) in enumerate(rows)
            for parameter, value in values.items()]
    return Effects(effect=[r[0] for r in rows], place=[r[1] for r in rows], term=[f[0] for f in flat],
                   parameter=[f[2] for f in flat], value=[f[3] for f in flat],
                   unit=[units[f[1], f[2]] for f in flat], condition=list(stated),
                   condition_value=list(stated.values()))


def terms(effects):
    """Terms of a product Effects; none of None, and none of an effect at its null."""
    return tuple(term for term in _all_terms(effects) if not _vanishes(term))


def _all_terms(effects):
    if effects is None:
        return ()
    values = [{} for _ in effects.effect]
    for term, parameter, value in zip(effects.term, effects.parameter, effects.value, strict=True):
        values[term][str(parameter)] = float(value)
    return tuple(Term(named(str(name)), str(location), given)
                 for name, location, given in zip(effects.effect, effects.place, values, strict=True))


def conditions(effects):
    """{name: value} of a product Effects; none of None."""
    return {} if effects is None else dict(zip(map(str, effects.condition), map(float, effects.condition_value),
                                               strict=True))


def with_effects(bench, effects, channels=True):
    """The bench with a product Effects (or None) on it; what acts at asperities is left to ``rubbing_with_effects``.

    Without ``channels``, where nothing is compared with a recording, effects of sensors are refused, and conditions are
    those of the block.
    """
    if channels:
        return composed(bench, [t for t in _all_terms(effects) if t.location != ASPERITIES])
    acting = physics_terms(effects)
    whole = compose(bench, acting)
    return replace(whole, friction=under(whole.friction, conditions(effects), "effects")) if acting else whole


@dataclass(frozen=True)
class Stated:
    """``terms`` (Terms) that a case states of the Bench ``bare``."""

    bare: object
    terms: tuple

    @property
    def pairs(self):
        """((effect, location), ...)."""
        return tuple((term.effect.name, term.location) for term in self.terms)

    def numbers(self):
        """{name: (value, SI unit)} of all values."""
        return {f"{term.effect.name}{MARK}{term.location}.{p.name}": (term.values[p.name], p.unit)
                for term in self.terms for p in parameters(term.effect)}


def composed(bench, terms):
    """The Bench with ``terms`` on it, which it keeps; those at their null do nothing. The bench itself without any."""
    return replace(compose(bench, [t for t in terms if not _vanishes(t)]), stated=Stated(bench, tuple(terms))) if (
        terms) else bench


def restated(bench, values):
    """The Bench with ``values`` {name: SI value} of its stated effects in place of what it has; its channels stay."""
    def changed(term):
        key = f"{term.effect.name}{MARK}{term.location}."
        return Term(term.effect, term.location, {p: values.get(key + p, v) for p, v in term.values.items()})

    whole, names = composed(bench.stated.bare, [changed(term) for term in bench.stated.terms]), {
        channel.name for channel in bench.channels}
    return replace(whole, channels=tuple(channel for channel in whole.channels if channel.name in names))


def with_bare(bench, change):
    """``change(bench)``, also of what the bench is without its stated effects."""
    changed = change(bench)
    if bench.stated is None:
        return changed
    return replace(changed, stated=replace(bench.stated, bare=change(bench.stated.bare)))


def _vanishes(term):
    """Whether a Term is at its null."""
    return all(term.values[p.name] == p.null for p in parameters(term.effect) if p.null is not None)


def physics_terms(effects):
    """Terms of a product Effects (or None) on a bench where nothing is recorded; ConfigError for effects of sensors."""
    acting = _on_benches(effects)
    for term in acting:
        if term.effect.kind == "sensor":
            raise ConfigError(f"effects.{term.effect.name}", "physics", "an effect of a sensor",
                              "sensors are part of a bench: use it in a case with recordings")
    return acting


def _on_benches(effects):
    return tuple(t for t in terms(effects) if t.location != ASPERITIES)


def rubbing_with_effects(rubbing, effects):
    """The Rubbing with what a product Effects (or None) says of its asperities."""
    return compose(rubbing, at_asperities(effects))


def at_asperities(effects):
    """Terms of a product Effects (or None) that act on a rough pair."""
    return tuple(t for t in terms(effects) if t.location == ASPERITIES)
