"""Stage diagnosis: deviations between recordings and model, their location, and the missing physics."""

from functools import partial

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.effect_block import with_effects
from pipeline.case_models.force_balance import started
from pipeline.case_models.runs import recorded
from pipeline.contract import ConfigError, Context, restored, stage
from pipeline.diagnosis import force_balance, forced_response, rough_pair, self_excited
from pipeline.diagnosis.output.files import companions
from pipeline.diagnosis.output.product import answer
from pipeline.diagnosis.published_lists import Models, published_diagnosis
from pipeline.diagnosis.settings import Settings
from pipeline.diagnosis.signals.substitution import substituted
from pipeline.inference import procedure as course
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


@stage(companions=companions, check=_check)
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
    if settings.forward == "lines":
        result = published_diagnosis(recording, Models(model, structure, modes), settings, context)
    elif settings.forward == "friction":
        result = _answered(_of_friction(recording, surface, micro, friction_map, effects, settings, context), settings,
                         context)
    else:
        result = _answered(_of_bench(model, effects, recording, bench, settings), settings, context)
    context.log(f"verdict: {result.verdict.item()}")
    return result


def _of_friction(recording, surface, micro, friction_map, effects, settings, context):
    """Question of measured friction against the rough pair of the case."""
    if surface is None or micro is None:
        raise ConfigError("diagnosis.forward", "another forward model, in a chain without micro_friction", "friction")
    return rough_pair.question(recording, surface, micro, friction_map, effects, settings,
                           partial(context.map, label="spots of the rough pair"))


def _of_bench(model, effects, recording, bench, settings):
    """Question of recorded runs against the bench of the case."""
    if model is None or bench is None:
        raise ConfigError("diagnosis.forward", "lines or friction, in a chain without a bench", settings.forward)
    laid_out = restored(benches.Settings, bench.settings.item())
    whole = with_effects(benches.built(model, laid_out), effects)
    return substituted(_question(whole, recorded(recording, laid_out), settings, laid_out), recording, settings)


def _answered(asked, settings, context):
    """Product Diagnosis of a Question."""
    context.log(f"{len(asked.candidates)} hypotheses over {len(asked.problem.training)} runs,"
                f" {len(asked.problem.held_out)} held out")
    result = course.diagnose(asked.problem, asked.budget, asked.candidates, course.Settings(
        settings.kept, asked.starts, settings.draws, settings.seed, asked.rules), context.map)
    return answer(asked, result)


def _question(whole, runs, settings, laid_out):
    """What the forward model of the case asks of a Bench and {name: Recorded}."""
    if (settings.forward == "poles") != (laid_out.poles is not None):
        raise ConfigError("diagnosis.forward", "poles where the section bench.poles is given, and only there",
                          settings.forward, "give both or neither")
    if laid_out.poles is not None:
        return self_excited.question(whole, runs, settings, laid_out.poles)
    if laid_out.forward == "equation":
        return force_balance.question(whole, runs, settings, laid_out.equation)
    return forced_response.question(whole, started(whole, runs, laid_out), settings)
