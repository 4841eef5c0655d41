"""What scatters in a brake: from the YAML to draws, and from its products to the Family of models that they vary.

    probability:
      sources:
        - {kind: joint_stiffness, part: finger, variation: 0.3}
        - {kind: damping_speed, range: [0.33, 3]}
        - {kind: friction}                        # standard error of the friction map
"""

from dataclasses import dataclass, field, replace
from functools import partial
from typing import Literal

import numpy as np
import scipy

from pipeline.case_models.effect_block import conditions, physics_terms
from pipeline.case_models.steady_sliding import mapped_friction, posed, refuse_twice, stated_friction
from pipeline.contract import ConfigError, Section, option
from pipeline.physics.contact.groups import alike, read
from pipeline.physics.sliding.model import at_state, lining_part, sliding_model
from pipeline.physics.stability.draws.added_physics import AddedPhysics, acting
from pipeline.physics.stability.draws.scatter import Factors, Family, Pivot

JOINTS, JOINT_LOSS, BODY_LOSS = "joint_stiffness", "joint_loss", "body_loss"
#: kinds that multiply one value of the whole brake, and those that add to friction, with their fields in Factors
FACTORS = {"lining_stiffness": "lining", "contact_stiffness": "contact_stiffness", "damping_speed": "damping_speed"}
ADDITIONS = {"friction": "friction", "friction_over_pressure": "pressure_slope", "friction_over_speed": "speed_slope"}
KINDS = (JOINTS, JOINT_LOSS, BODY_LOSS, *FACTORS, *ADDITIONS)
#: standard deviations to each side of 95 % of a normal distribution
_SIDES = 1.959963984540054


class Source(Section):
    """One value that scatters, or one group of values that scatter together."""

    kind: Literal[KINDS] = option(
        ..., "what scatters: stiffness or loss factor of joints, loss factor of bodies, stiffness of the linings, slope"
        " of the normal contact law, closing speed of the contact damping; level of friction, or its slope over the"
        " logarithm of pressure or speed")
    part: str | None = option(None, "joints whose name contains it, or bodies; none = all")
    variation: float | None = option(
        None, "coefficient of variation, the nominal value being the median; of friction and its slopes, which are"
        " normally distributed, the standard deviation itself: none = standard error of the friction map", gt=0)
    range: tuple[float, float] | None = option(
        None, "factors on the nominal value between which it lies: 95 % of the draws, or all of a uniform distribution")
    distribution: Literal["lognormal", "uniform"] = option("lognormal", "of factors")

    @property
    def name(self):
        """As the product calls it."""
        return f"{self.kind}:{self.part}" if self.part else self.kind


#: what scatters where a case does not say
DEFAULT = (*({"kind": JOINTS, "part": part, "variation": 0.3}
             for part in ("abutment", "finger", "piston", "guide_pin")),
           {"kind": "lining_stiffness", "variation": 0.15}, {"kind": "contact_stiffness", "variation": 0.2},
           {"kind": JOINT_LOSS, "variation": 0.5}, {"kind": BODY_LOSS, "variation": 0.5},
           {"kind": "damping_speed", "range": (1 / 3, 3.0)}, *({"kind": kind} for kind in ADDITIONS))


def check_sources(sources, where):
    """ConfigError at ``where`` for sources that are stated twice, or whose width is not."""
    names = [source.name for source in sources]
    for k, source in enumerate(sources):
        here = f"{where}.{k}"
        if names.index(source.name) != k:
            raise ConfigError(here, "each source once", source.name, "state its whole scatter at one place")
        if source.part and source.kind not in (JOINTS, JOINT_LOSS, BODY_LOSS):
            raise ConfigError(f"{here}.part", f"none for {source.kind}", repr(source.part), "leave it out")
        if source.kind in ADDITIONS:
            if source.range is not None or source.distribution != "lognormal":
                raise ConfigError(here, "variation, or nothing, for friction", "a range or distribution",
                                  "leave it out")
        elif (source.variation is None) == (source.range is None):
            raise ConfigError(here, "either variation or range", "both" if source.range else "neither", "state one")
        elif source.range is not None and not 0 < source.range[0] < source.range[1]:
            raise ConfigError(f"{here}.range", "two rising factors above 0", str(list(source.range)))
        elif source.distribution == "uniform" and source.range is None:
            raise ConfigError(f"{here}.range", "the ends of a uniform distribution", "none")


def fitting(sources, model):
    """The ``sources``; where these are those of the program, without joints that the brake of a product ReducedModel
    lacks, as fingers of a fixed caliper; the bolts of such a caliper scatter as guide pins do."""
    parts = [source.part for source in sources if source.kind == JOINTS]
    there = {part: any(part in str(name) for name in model.joint_name) for part in (*filter(None, parts), "bolt")}
    if tuple(sources) != tuple(Source(**each) for each in DEFAULT) or not any(there[part] for part in parts):
        return sources
    stands_for = {"guide_pin": "bolt"} if there["bolt"] else {}
    found = [source.model_copy(update={"part": stands_for.get(source.part, source.part)}) for source in sources]
    return tuple(source for source in found if source.kind != JOINTS or there[source.part])


@dataclass(frozen=True)
class FrictionErrors:
    """What a friction map says of its own errors: ``std`` {kind: standard error} of level and slopes, empty without a
    map, and their ``correlation`` (3, 3) in the order of ADDITIONS."""

    std: dict = field(default_factory=dict)
    correlation: np.ndarray = field(default_factory=lambda: np.eye(len(ADDITIONS)))

    def root(self, kinds):
        """Symmetric root (k, k) of the correlation of these ``kinds``."""
        of = [list(ADDITIONS).index(kind) for kind in kinds]
        size, basis = np.linalg.eigh(self.correlation[np.ix_(of, of)])
        return (basis * np.sqrt(np.maximum(size, 0.0))) @ basis.T


def draw_values(sources, errors, count, rng):
    """(count, s): values of the Sources, each draw independent of the others; as of ``scored_values``."""
    return scored_values(sources, errors, np.reshape([rng.standard_normal(count) for _ in sources], (-1, count)).T)


def scored_values(sources, errors, scores):
    """(n, s): factors of the Sources, or additions to friction, by their standard normal ``scores`` (n, s); those of
    the map go together as its FrictionErrors say."""
    values = np.array(scores, float).T
    for k, source in enumerate(sources):
        if source.kind in ADDITIONS:
            continue
        if source.distribution == "uniform":
            values[k] = source.range[0] + np.diff(source.range) * scipy.special.ndtr(values[k])
        else:
            middle, width = _lognormal(source)
            values[k] = np.exp(middle + width * values[k])
    mapped = [k for k, source in enumerate(sources) if source.kind in ADDITIONS and source.variation is None]
    values[mapped] = errors.root([sources[k].kind for k in mapped]) @ values[mapped]
    for k, source in enumerate(sources):
        if source.kind in ADDITIONS:
            values[k] *= _deviation(source, errors.std)
    return values.T


def law_in_words(source, errors):
    """Distribution and width of a Source."""
    if source.kind in ADDITIONS:
        given = "standard error of the friction map" if source.variation is None else "stated"
        return f"normal, standard deviation {_deviation(source, errors.std):.2g} ({given})"
    if source.range is not None:
        share = "" if source.distribution == "uniform" else ", 95 % of the draws"
        return f"{source.distribution}, {source.range[0]:.3g} to {source.range[1]:.3g} times{share}"
    return f"lognormal, coefficient of variation {source.variation:g}"


def standard_deviation(source, errors):
    """Standard deviation of what a Source adds to friction, or of its factor: of its logarithm if that is normal."""
    if source.kind in ADDITIONS:
        return _deviation(source, errors.std)
    return np.diff(source.range)[0] / np.sqrt(12) if source.distribution == "uniform" else _lognormal(source)[1]


def _deviation(source, deviations):
    if source.variation is None and source.kind not in deviations:
        raise ConfigError(f"sources: {source.name}.variation", "a standard deviation, as there is no friction map",
                          "none", "state it, or leave the source out")
    return deviations[source.kind] if source.variation is None else source.variation


def _lognormal(source):
    """(mean, standard deviation) of the logarithm of a factor."""
    if source.range is None:
        return 0.0, np.sqrt(np.log1p(source.variation**2))
    low, high = np.log(source.range)
    return (low + high) / 2, (high - low) / 2 / _SIDES


def factors_of(sources, values, model):
    """Factors of one draw ``values`` (s,) of the Sources in a product ReducedModel. ConfigError for unknown parts."""
    joints, bodies = [str(n) for n in model.joint_name], [str(n) for n in model.body_name]
    made = {JOINTS: np.ones(len(joints)), JOINT_LOSS: np.ones(len(joints)), BODY_LOSS: np.ones(len(bodies))}
    others = {}
    for source, value in zip(sources, values, strict=True):
        if source.kind in made:
            made[source.kind][_members(source, bodies if source.kind == BODY_LOSS else joints)] *= value
        else:
            others[{**FACTORS, **ADDITIONS}[source.kind]] = float(value)
    return Factors(made[JOINTS], made[JOINT_LOSS], made[BODY_LOSS], **others)


def _members(source, names):
    """True (n,) for the ``names`` that a Source means."""
    chosen = np.array([source.part is None or source.part in name for name in names], bool)
    if not chosen.any() and (source.part or not names):
        raise ConfigError(f"probability.sources: {source.name}", f"part of one of {', '.join(names) or 'no names'}",
                          repr(source.part), "name what the model has, or leave the source out")
    return chosen


def friction_errors(friction_map, distance):
    """FrictionErrors of a product FrictionMap, or None, at a sliding ``distance`` m: level and slopes at the pivot."""
    if friction_map is None:
        return FrictionErrors()
    at = int(np.argmin(abs(friction_map.distance - distance)))
    level = np.interp(friction_map.best_pressure[at], friction_map.pressure,
                      friction_map.friction_std[:, :, at].mean(axis=1))
    std = {"friction": float(level), "friction_over_pressure": float(friction_map.pressure_slope_std[at]),
           "friction_over_speed": float(friction_map.speed_slope_std[at])}
    return FrictionErrors(std, friction_map.error_correlation[at])


def family(model, state, friction_map, settings, effects=None):
    """Family of the products ReducedModel, at one row of its preload, FrictionMap, or None where friction is that of
    the ``settings``, a StabilitySettings, and Effects, or None.

    ConfigError for unknown locations of effects, and for friction that turns with the slip twice.
    """
    model = at_state(model, state)
    bare = replace(model, loss=0 * model.loss, joint_loss_factor=0 * model.joint_loss_factor)
    lining = lining_part(model) if len(model.lining_coordinate) else None
    at = settings.sliding_distance
    (given, law), pivot = ((stated_friction(settings), Pivot()) if friction_map is None      # slopes are about 1 m/s
                           else _mapped(friction_map, at))
    made = Family(
        sliding_model(bare, state, float(np.mean(settings.speeds))), law,
        model.pressure[state] * model.input_area, settings.damping_speed, model.loss, model.joint_loss_factor, lining,
        float(model.lining_loss_factor), model.law_closure, model.law_pressure, pivot, settings.friction_slopes,
        settings.friction_damping, settings.gyroscopic, settings.centrifugal)
    terms = physics_terms(effects)
    if not terms:
        return made
    return _acted_on(made, posed(bare, state, made.model.speed, settings.damping_speed, terms, conditions(effects)),
                     given)


def _acted_on(made, case, given):
    """A Family with the effects of a Posed, its friction, the Friction ``given``, with those on it."""
    refuse_twice(case.bench, made.friction_damping)
    friction, model, law = case.friction(given), case.bench.model, case.bench.law
    count, more = len(model.contacts.area), case.bench.model.size - made.model.size
    if alike(case.base.law, law, count) and (made.has_law or not case.moved):
        law = None
    else:
        model = replace(model, contacts=replace(model.contacts, gap=read(law, "gap", count)))
    of_effects = len(model.joints.name) - len(made.joint_loss_factor)
    return replace(
        made, model=model, loss=np.pad(made.loss, (0, more)),
        lining=None if made.lining is None else np.pad(made.lining, (0, more)),
        joint_loss_factor=np.append(made.joint_loss_factor, np.zeros(of_effects)), added=AddedPhysics(friction, law),
        friction=made.friction if friction is given else partial(acting, friction, model.direction(),
                                                                 model.contacts.area))


def _mapped(friction_map, at):
    """((Friction, function that gives a FrictionState), Pivot) of a product FrictionMap at a sliding distance, m."""
    best = float(np.interp(at, friction_map.distance, friction_map.best_pressure))
    pivot = Pivot(best, float(np.exp(np.log(friction_map.speed).mean())), tuple(friction_map.pressure[[0, -1]]),
                  tuple(friction_map.speed[[0, -1]]))
    return mapped_friction(friction_map, at), pivot
