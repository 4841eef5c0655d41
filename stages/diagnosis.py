"""Stage diagnosis: deviations between recordings and model, their location, and the missing physics."""

import logging
import sys
from functools import partial
from typing import NamedTuple

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.effect_block import with_effects
from pipeline.case_models.runs import recorded
from pipeline.contract import ConfigError, Context, restored, stage
from pipeline.contract.errors import sentence_of
from pipeline.diagnosis.output import files, squeal_case
from pipeline.diagnosis.output.product import product
from pipeline.diagnosis.output.unsolved import unsolved
from pipeline.diagnosis.published_lists import Models, published_problem
from pipeline.diagnosis.rough_pair import rough_pair_problem
from pipeline.diagnosis.self_excited import pole_problem
from pipeline.diagnosis.settings import Settings
from pipeline.diagnosis.signals.posed import posed
from pipeline.diagnosis.signals.substitution import substituted
from pipeline.products import (
    Bench,
    ComplexModes,
    Diagnosis,
    Effects,
    FrictionMap,
    MicroFriction,
    Recording,
    ReducedModel,
    Structure,
    Surface,
)


def _check(sections):
    """Refuse settings that contradict one another."""
    settings = sections["diagnosis"]
    both = set(settings.effects) & set(settings.without)
    if both:
        raise ConfigError("diagnosis.without", "effects that are not in diagnosis.effects", ", ".join(sorted(both)))
    if settings.saturated_squeal and settings.forward != "poles":
        raise ConfigError("diagnosis.saturated_squeal", "none, where no poles are compared",
                          f"forward {settings.forward}")
    if settings.latent_force.predict and not (settings.forward == "simulation" and settings.held_out):
        raise ConfigError("diagnosis.latent_force.predict", "runs over time that are held out",
                          f"forward {settings.forward}, held out: {', '.join(settings.held_out) or 'none'}")


def _companions(product, case):
    return files.companions(product, case) | squeal_case.companions(product, case)


@stage(companions=_companions, check=_check)
def diagnosis(model: ReducedModel | None, effects: Effects | None, recording: Recording, bench: Bench | None,
              structure: Structure | None, modes: ComplexModes | None, surface: Surface | None,
              micro: MicroFriction | None, friction_map: FrictionMap | None, settings: Settings,
              context: Context) -> Diagnosis:
    """Compare recordings with the model, locate the mismatch and identify missing effects.

    Method:
    Nominal values were recalibrated first; only the remaining mismatch counts as evidence of missing physics. Every
    effect of the catalogue that the case does not exclude was screened at every location that the case allows, and the
    best {kept} were refitted in the full model. An effect is identified only by the rules stated in the report.
    Held-out runs were never fitted.
    """
    inputs = Inputs(model, effects, recording, bench, structure, modes, surface, micro, friction_map)
    problem = _BUILDERS[settings.forward](inputs, settings, context)
    context.log(f"{len(problem.candidates)} hypotheses over {len(problem.problem.training)} runs,"
                f" {len(problem.problem.held_out)} held out")
    contacts = benches.contact_names(model) if model is not None else {}
    result = _answered(problem, contacts, context)
    context.log(f"verdict: {result.verdict.item()}")
    return result


def _answered(problem, contacts, context):
    """Product Diagnosis of a DiagnosisProblem; where it cannot be solved, unknown, with what went wrong."""
    try:
        return product(problem, problem.solved(context.map, context.log), contacts)
    except Exception as error:
        logging.getLogger(__name__).debug("the diagnosis", exc_info=error)
        result = product(*unsolved(problem, error), contacts)
        print(f"the diagnosis failed: {sentence_of(error)}", file=sys.stderr)
        return result


class Inputs(NamedTuple):
    """What the chain hands to the stage; None where it has no such product."""

    model: ReducedModel | None
    effects: Effects | None
    recording: Recording
    bench: Bench | None
    structure: Structure | None
    modes: ComplexModes | None
    surface: Surface | None
    micro: MicroFriction | None
    friction_map: FrictionMap | None


def _of_lists(inputs, settings, context):
    """Published lists against the models of the chain."""
    return published_problem(inputs.recording, Models(inputs.model, inputs.structure, inputs.modes), settings,
                             partial(context.map, label="mechanisms"))


def _of_friction(inputs, settings, context):
    """Measured friction against the rough pair of the case."""
    if inputs.surface is None or inputs.micro is None:
        raise ConfigError("diagnosis.forward", "another forward model, in a chain without micro_friction", "friction")
    return rough_pair_problem(inputs.recording, inputs.surface, inputs.micro, inputs.friction_map, inputs.effects,
                              settings, partial(context.map, label="spots of the rough pair"))


def _of_poles(inputs, settings, context):
    """Poles of recorded free vibrations against eigenvalues of the bench."""
    bench, rig = _bench(inputs, settings)
    return pole_problem(bench, recorded(inputs.recording, rig, inputs.model), settings, rig.poles)


def _of_signals(inputs, settings, context):
    """Recorded time signals against simulated ones, or measured motions in the equation of motion."""
    bench, rig = _bench(inputs, settings)
    runs = recorded(inputs.recording, rig, inputs.model)
    problem = posed(bench, runs, settings, rig)
    return problem if rig.forward == "equation" else substituted(problem, inputs.recording, settings)


def _bench(inputs, settings):
    """(Bench with the effects of the case, its settings). ConfigError where the chain has none, or another kind."""
    if inputs.model is None or inputs.bench is None:
        raise ConfigError("diagnosis.forward", "lines or friction, in a chain without a bench", settings.forward)
    rig = restored(benches.Settings, inputs.bench.settings.item())
    if (settings.forward == "poles") != (rig.poles is not None):
        raise ConfigError("diagnosis.forward", "poles where the section bench.poles is given, and only there",
                          settings.forward, "give both or neither")
    return with_effects(benches.built(inputs.model, rig), inputs.effects), rig


#: how the problem is posed, by the setting ``forward``
_BUILDERS = {"lines": _of_lists, "friction": _of_friction, "poles": _of_poles, "simulation": _of_signals}
