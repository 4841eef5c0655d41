"""Stage diagnosis: what differs between recordings and the model, where, and which physics is missing."""

from pipeline.benches import bench as benches
from pipeline.benches.effect_block import with_effects
from pipeline.benches.runs import recorded
from pipeline.contract import ConfigError, Context, restored, stage
from pipeline.diagnosis import forced, self_excited
from pipeline.diagnosis.answer import answer
from pipeline.diagnosis.document import companions
from pipeline.diagnosis.settings import Settings
from pipeline.inference import diagnose as course
from pipeline.products import Bench, Diagnosis, Effects, Recording, ReducedModel

#: forward model -> what asks by it
QUESTIONS = {"simulation": forced.question, "poles": self_excited.question}


def _check(sections):
    """Refuse a diagnosis in which nothing is asked."""
    settings = sections["diagnosis"]
    both = set(settings.effects) & set(settings.without)
    if both:
        raise ConfigError("diagnosis.without", "effects that are not in diagnosis.effects", ", ".join(sorted(both)))


@stage(companions=companions, check=_check)
def diagnosis(model: ReducedModel, effects: Effects | None, recording: Recording, bench: Bench, settings: Settings,
              context: Context) -> Diagnosis:
    """Compare recordings with the model, locate what differs and name what is missing.

    Method:
    Nominal values were refitted first (forward model: {forward}); only what they cannot explain counts as evidence of
    missing physics. Every effect of the catalogue at every place was screened, the best {kept} were refitted in the
    full model, and an effect is named only by the rules that the page states; held-out runs were never fitted.
    """
    laid_out = restored(benches.Settings, bench.settings.item())
    whole = with_effects(benches.built(model, laid_out), effects)
    asked = QUESTIONS[settings.forward](whole, recorded(recording, laid_out), settings, laid_out.poles)
    context.log(f"{len(asked.candidates)} hypotheses over {len(asked.problem.training)} runs,"
                f" {len(asked.problem.held_out)} held out")
    found = course.diagnose(asked.problem, asked.budget, asked.candidates, course.Settings(
        kept=settings.kept, draws=settings.draws, seed=settings.seed, rules=asked.rules), context.map)
    told = answer(asked, found)
    context.log(f"verdict: {told.verdict.item()}")
    return told
