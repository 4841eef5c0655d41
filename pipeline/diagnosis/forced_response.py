"""The question of forced recordings: a bench, its recorded runs, and the section ``diagnosis``."""

from pipeline.case_models import corrections
from pipeline.case_models.effect_block import parameters
from pipeline.contract import ConfigError
from pipeline.contract.units import to_si
from pipeline.diagnosis.experiment_design.next_run import feasible
from pipeline.diagnosis.question import Question, nominal, nothing
from pipeline.diagnosis.settings import parameter
from pipeline.diagnosis.signals.forward_model import Simulated, candidates, largest, observed, reach, solver_candidate
from pipeline.diagnosis.signals.latent_force import Describe
from pipeline.diagnosis.signals.localisation import Axes, ForcedAxes
from pipeline.effects import CATALOGUE
from pipeline.inference.fitting.noise import budget
from pipeline.inference.problem import Problem


def question(bench, recorded, settings):
    """Question over {name: Recorded} of a Bench. ConfigError for unknown runs, effects, places and parameters."""
    check_names("held_out", settings.held_out, recorded)
    runs = {name: one.run for name, one in recorded.items()}
    shown = {c: u for one in recorded.values() for c, u in zip(one.channels, one.unit, strict=True)}
    check_names("noise.std", settings.noise.std, shown)
    given = {c: to_si(v, shown[c], f"diagnosis.noise.std.{c}") for c, v in settings.noise.std.items()}
    seen = tuple(observed(one, given, name in settings.held_out) for name, one in recorded.items())
    trained = [recorded[o.name] for o in seen if not o.held_out]
    after = feasible(bench, settings.next, trained[0]) if trained else ()
    forward = Simulated(bench, runs | {f.run.name: f.run for f in after}, {f.run.name: f.altered for f in after})
    problem = Problem(seen, forward, nominal(nominal_parameters(bench, settings)))
    for one in after:       # what the model cannot do is refused before anything is fitted
        forward(problem.nominal, problem.nominal.values(problem.nominal.nominal), one.observed)
    found = candidates(bench, tuple(one.run for one in trained), chosen(settings), settings.places,
                       reach(bench, trained), settings.priors, largest(trained))
    noises = budget(problem, above=settings.noise.above)
    describe = Describe(bench, runs, problem, noises, seed=settings.seed)
    return Question(problem, noises | {f.run.name: noises[trained[0].run.name] for f in after},
                    (*found, *([solver_candidate()] if settings.solver else [])), shown,
                    axes=ForcedAxes(bench, runs, Axes(problem, noises, seed=settings.seed)),
                    describe=describe, use=describe.use if settings.latent_force.predict else nothing,
                    next_runs=tuple(f.observed for f in after))


def nominal_parameters(bench, settings):
    """Parameters that the case says may be wrong, about the values of the bench."""
    units = corrections.known(bench)
    check_names("parameters", settings.parameters, units)
    return [parameter(name, units[name], corrections.nominal(bench, name), prior, f"diagnosis.parameters.{name}")
            for name, prior in settings.parameters.items()]


def chosen(settings):
    """Effects that are weighed. ConfigError for names of effects, and of priors of their parameters, that none has."""
    names = [e.name for e in CATALOGUE]
    check_names("priors", settings.priors, [f"{e.name}.{p.name}" for e in CATALOGUE for p in parameters(e)])
    check_names("effects", settings.effects, names)
    check_names("without", settings.without, names)
    return tuple(e for e in CATALOGUE if (not settings.effects or e.name in settings.effects)
                 and e.name not in settings.without)


def check_names(key, wanted, known):
    """ConfigError at ``diagnosis.key`` for a wanted name that is not known."""
    unknown = [name for name in wanted if name not in known]
    if unknown:
        raise ConfigError(f"diagnosis.{key}", f"of {', '.join(known)}", ", ".join(unknown))
