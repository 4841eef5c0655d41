"""The problem of measured friction and worn faces: a rough pair, drags over pressure, speed and way.

The contact is solved in a few runs only, from the lowest to the highest pressure that the recordings and the priors
reach; every prediction is read between them (``physics.spot_table``), by scalings that the tests compare with full
runs. What acts on asperities belongs to the stage micro_friction; that the map of the chain is read between its points
is a hypothesis of its own, of the stage friction_map.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from pipeline.case_models.effect_block import at_asperities, parameters
from pipeline.case_models.rough.pair import Settings, offsets, rubbing, shifted
from pipeline.contract import ConfigError, restored
from pipeline.contract.units import to_si
from pipeline.diagnosis.features.worn_faces import FRICTION, UNITS, WEAR, observed, rubbed, shown
from pipeline.diagnosis.forced_response import check_names, chosen, stated_parameters
from pipeline.diagnosis.problem import DiagnosisProblem, label, nominal, parameter_name
from pipeline.diagnosis.settings import procedure
from pipeline.diagnosis.signals.forward_model import candidates, terms
from pipeline.diagnosis.signals.localisation import INTERPOLATION, MAP, Axes
from pipeline.effects import CATALOGUE
from pipeline.effects.effect import compose
from pipeline.inference.fitting.noise import budget
from pipeline.inference.priors import Normal, Parameter
from pipeline.inference.problem import Hypothesis, Problem
from pipeline.physics.friction.friction_table import FrictionLaw
from pipeline.physics.rough.spot_table import friction, mean_wear, spot_table

#: numbers of the section micro_friction that may be wrong, with their units
UNIT_OF = {"pad.youngs_modulus": "Pa", "disc_strength": "Pa", "pad.wear_coefficient": "m^2/N",
           "disc.wear_coefficient": "m^2/N", "rate_coefficient": "1", "softening": "1/K"}
#: name of the parameter of the hypothesis about the map: 1 where its reading makes the whole difference
SHARE = "share"
#: stages of the chain that a mismatch of friction can lie in
_CHAIN = ("micro_friction", MAP)


@dataclass(frozen=True)
class Predicted:
    """Picklable prediction of the drags {run: Drag} of a Rubbing by its SpotTable.

    ``given`` {name: value} of UNIT_OF as the case has them, ``stated`` Terms that it adds; ``change`` {run: (n,)}:
    friction as the map of the chain tells it, less that computed at the points.
    """

    rubbing: object
    table: object
    drags: dict
    given: dict
    stated: tuple = ()
    change: dict = field(default_factory=dict)

    def __call__(self, hypothesis, values, run):
        drag, numbers = self.drags[run.name], {**self.given, **{k: v for k, v in values.items() if k in UNIT_OF}}
        added = (*self.stated, *terms(hypothesis, values))
        pair = compose(corrected(self.rubbing, numbers, self.given), added)
        softer = self.given["pad.youngs_modulus"] / numbers["pad.youngs_modulus"]
        predicted = friction(self.table, pair, drag, softer)
        by_map = values.get(parameter_name(INTERPOLATION, MAP, SHARE), 0.0)
        predicted = predicted + by_map * self.change.get(run.name, 0.0)
        return shown(predicted, dict(zip(WEAR, mean_wear(pair, drag), strict=True)), run.channels)


def corrected(rubbing, numbers, given):
    """The Rubbing with other ``numbers`` {name: value} than those ``given``; the modulus is left to the table."""
    ratio = {name: value / given[name] if given[name] else 1.0 for name, value in numbers.items()}
    wearing, shearing = rubbing.wearing, rubbing.shearing
    return replace(
        rubbing, wearing=replace(wearing, pad_coefficient=ratio["pad.wear_coefficient"] * wearing.pad_coefficient,
                                 disc_coefficient=ratio["disc.wear_coefficient"] * wearing.disc_coefficient),
        shearing=replace(shearing, limit=ratio["disc_strength"] * shearing.limit, rate=numbers["rate_coefficient"],
                         softening=numbers["softening"]))


def rough_pair_problem(recording, surface, micro, friction_map, effects, settings, fan_out):
    """DiagnosisProblem of a product Recording against products of the chain and the ``effects`` of the case (or None).

    ``fan_out(function, tasks)`` maps as the builtin does. ConfigError for recordings without friction, unknown runs,
    effects and numbers.
    """
    section = restored(Settings, micro.settings.item())
    std = settings.noise.std.get(FRICTION)
    stated_std = None if std is None else to_si(std, "1", f"diagnosis.noise.std.{FRICTION}")
    runs = rubbed(recording, section.stroke, stated_std)
    check_names("held_out", settings.held_out, runs)
    bare, stated = rubbing(surface, section), at_asperities(effects)
    drags = {name: run.drag for name, run in runs.items()}
    pairs = [shifted(bare, offset) for offset in offsets(surface, section)]
    table = spot_table(pairs, *_grid(bare, drags, settings.rubbing), fan_out)
    forward = Predicted(bare, table, drags, _given(section), stated)
    error = float(np.hypot(settings.rubbing.model_error, table.scatter))
    observations = tuple(observed(run, name in settings.held_out, error) for name, run in runs.items())
    problem = Problem(observations, forward, nominal(stated_parameters(settings, UNIT_OF, _given(section).__getitem__)))
    forward = replace(forward, change=_read_off(problem, friction_map))
    problem = replace(problem, predict=forward)
    check_names("priors", settings.priors, [f"{e.name}.{p.name}" for e in CATALOGUE for p in parameters(e)])
    in_case = {term.effect.name for term in stated}
    weighed = [e for e in chosen(settings) if e.locations(bare) and e.name not in in_case]
    hypotheses = candidates(bare, tuple(drags[o.name] for o in problem.training), weighed, settings.places,
                            priors=settings.priors, refused=(refused := []))
    channels = [c for run in observations for c in run.channels]
    noises, solver = budget(problem), procedure(settings, few=True)
    return DiagnosisProblem(problem, noises, (*hypotheses, *_map_candidate(forward)),
                            {c: UNITS[c] for c in dict.fromkeys(channels)}, solver,
                            Axes.under(problem, noises, solver, _CHAIN), remarks=tuple(refused))


def _given(section):
    """{name: value} of UNIT_OF in the section micro_friction."""
    def number(name):
        value = section
        for step in name.split("."):
            value = getattr(value, step)
        return float(value)

    return {name: number(name) for name in UNIT_OF}


def _grid(rubbing, drags, spot_runs):
    """(pressures, wear cycles, speeds) of the runs: those recorded, and beyond them by the factor ``reach``."""
    pressure = [d.pressure for d in drags.values()]
    speed = np.concatenate([d.speed for d in drags.values()])
    last = max(d.distance.max() for d in drags.values()) / rubbing.wearing.distance * spot_runs.reach
    if not last >= spot_runs.distances:
        raise ConfigError("micro_friction.cycles", f"more than {spot_runs.distances} wear cycles within the recorded"
                          " sliding distance", f"{last:.0f}", "raise cycles")
    cycles = np.unique(np.round(last * np.linspace(0, 1, spot_runs.distances) ** 1.5).astype(int))
    pressures = np.geomspace(min(pressure) / spot_runs.reach, max(pressure) * spot_runs.reach, spot_runs.pressures)
    return (pressures, cycles.tolist(), np.unique(np.geomspace(speed.min(), speed.max(), 3)).tolist())


def _read_off(problem, friction_map):
    """{run: (n,)} what the map of the chain says less what is computed at the points, both as given."""
    if friction_map is None:
        return {}
    law = FrictionLaw.of(friction_map)
    values = problem.nominal.values(problem.nominal.nominal)
    return {run.name: law.evaluate(drag.pressure, drag.speed, drag.distance)[0]
            - problem.predict(problem.nominal, values, run)[0]
            for run in problem.runs for drag in (problem.predict.drags[run.name],)}


def _map_candidate(forward):
    """The hypothesis that reading the map makes the difference, where it makes any."""
    if not any(np.any(change) for change in forward.change.values()):
        return ()
    fraction = Parameter(parameter_name(INTERPOLATION, MAP, SHARE), "1", 0.0, Normal(0.0, 1.0), 0.0)
    return (Hypothesis(label(((INTERPOLATION, MAP),)), ((INTERPOLATION, MAP),), (fraction,), "numerics"),)
