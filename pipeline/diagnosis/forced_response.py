"""The problem of forced recordings: a bench, its recorded runs, and the section ``diagnosis``."""

from dataclasses import replace
from difflib import get_close_matches
from functools import partial

from pipeline.case_models import corrections
from pipeline.case_models.effect_block import parameters
from pipeline.contract import ConfigError
from pipeline.contract.errors import first_of
from pipeline.contract.units import to_si
from pipeline.diagnosis import nuisances
from pipeline.diagnosis.experiment_design.next_run import feasible
from pipeline.diagnosis.problem import DiagnosisProblem, nominal, parameter_name
from pipeline.diagnosis.settings import parameter, procedure
from pipeline.diagnosis.signals.added_starts import with_added_starts
from pipeline.diagnosis.signals.forward_model import (
    Simulated,
    candidates,
    largest,
    observed,
    reach,
    remembers,
    solver_candidate,
)
from pipeline.diagnosis.signals.latent_force import Describe
from pipeline.diagnosis.signals.localisation import Axes, ForcedAxes
from pipeline.diagnosis.signals.measured_motions import MeasuredMotions, measured
from pipeline.diagnosis.signals.start_states import with_starts
from pipeline.diagnosis.signals.usable_runs import doubts
from pipeline.effects import CATALOGUE
from pipeline.inference.fitting.noise import budget
from pipeline.inference.fitting.step_error import longest
from pipeline.inference.priors import LogNormal, Normal, Parameter
from pipeline.inference.problem import Problem

#: names that an error lists
_LISTED = 20


def forced_problem(bench, recorded, settings, remarks=()):
    """DiagnosisProblem over {name: Recorded} of a Bench. ConfigError for unknown runs, effects, places and parameters.

    ``remarks``: sentences on runs that are left out.
    """
    check_names("held_out", settings.held_out, recorded)
    runs = {name: record.run for name, record in recorded.items()}
    units = {c: u for record in recorded.values() for c, u in zip(record.channels, record.unit, strict=True)}
    noise = stated_noise(settings, units)
    observations = tuple(observed(record, noise, name in settings.held_out) for name, record in recorded.items())
    training = [recorded[o.name] for o in observations if not o.held_out]
    planned = feasible(bench, settings.next, training[0]) if training else ()
    forward = Simulated(bench, runs | {f.run.name: f.run for f in planned}, {f.run.name: f.altered for f in planned})
    problem = Problem(observations, forward, nominal(nominal_parameters(bench, settings, recorded)))
    for run in planned:     # what the model cannot do is refused before anything is fitted
        forward(problem.nominal, problem.nominal.values(problem.nominal.nominal), run.observed)
    refused = []
    effects = candidates(bench, tuple(record.run for record in training), chosen(settings), settings.places,
                         reach(bench, training), settings.priors, largest(training), refused)
    effects = with_added_starts(bench, effects, recorded)
    problem = replace(problem, nominal=with_starts(problem.nominal, bench, recorded, remembers(bench, effects)))
    noises, solver = budget(problem, above=settings.noise.above), procedure(settings)
    doubled = longest(problem, tuple(noises[run.name] for run in problem.training), solver.rules.refit)
    problem = replace(problem, nominal=replace(problem.nominal, halvings=doubled))
    effects = tuple(replace(effect, halvings=doubled) for effect in effects)
    return DiagnosisProblem(
        problem, noises | {f.run.name: noises[training[0].run.name] for f in planned},
        (*effects, *([solver_candidate()] if settings.solver else [])), units, solver,
        ForcedAxes(bench, runs, Axes.under(problem, noises, solver)),
        Describe(bench, runs, problem, noises, solver.rules, seed=settings.seed), settings.latent_force.predict,
        next_runs=tuple(f.observed for f in planned), noise_levels=settings.noise.levels,
        step=min(run.step(bench.step) for run in runs.values()),
        remarks=(*remarks, *doubts(recorded, bench.model.input_name), *refused),
        nuisances=nuisances.declared(bench, [record.run for record in training], settings, training),
        motions=MeasuredMotions(bench, runs, noises) if all(
            measured(bench, o.channels) for o in observations) else None)


def stated_noise(settings, units):
    """{channel: standard deviation in SI} that the case states, of channels with ``units`` {channel: unit}."""
    check_names("noise.std", settings.noise.std, units)
    return {c: to_si(v, units[c], f"diagnosis.noise.std.{c}") for c, v in settings.noise.std.items()}


def nominal_parameters(bench, settings, runs=()):
    """``stated_parameters`` of a Bench."""
    return stated_parameters(settings, corrections.known(bench), partial(corrections.nominal, bench), runs)


def stated_parameters(settings, units, nominal_of, runs=()):
    """Parameters that the case says may be wrong, of {name: unit} about ``nominal_of(name)``, and how they differ
    between ``runs`` (name, ...). ConfigError for names that there are not, and for differences where samples of runs
    are not compared."""
    check_names("parameters", settings.parameters, units)
    shared = [parameter(name, units[name], nominal_of(name), prior, f"diagnosis.parameters.{name}")
              for name, prior in settings.parameters.items()]
    return shared + [_of_run(p, run, size) for p in shared
                     if (size := _between_runs(p, settings.parameters[p.name], runs)) for run in runs]


def _between_runs(shared, given, runs):
    """Standard deviation by which a Parameter differs between ``runs`` as the section ``given`` says, None or 0: not at
    all."""
    where, stated = f"diagnosis.parameters.{shared.name}.between_runs", given.between_runs
    if stated is None:
        return None
    if not runs:
        raise ConfigError(where, "none, as no samples of runs are compared here", str(stated), "leave it out")
    relative = isinstance(shared.prior, LogNormal)
    size = to_si(stated, "1" if relative else shared.unit, where)
    if size < 0 or (relative and size > 1):
        raise ConfigError(where, "a share from 0 to 1" if relative else "0 or more", str(stated))
    return size


def _of_run(shared, run, size):
    """Parameter of the value that a ``shared`` one has in a run, which differs by this ``size``."""
    name = parameter_name("between_runs", run, shared.name)
    if isinstance(shared.prior, LogNormal):
        return Parameter(name, "1", 1.0, LogNormal(1.0, size), run=run, of=shared.name)
    return Parameter(name, shared.unit, 0.0, Normal(0.0, size), run=run, of=shared.name)


def chosen(settings):
    """Effects that are weighed. ConfigError for names of effects, and of priors of their parameters, that none has."""
    names = [e.name for e in CATALOGUE]
    check_names("priors", settings.priors, [f"{e.name}.{p.name}" for e in CATALOGUE for p in parameters(e)])
    check_names("effects", settings.effects, names)
    check_names("without", settings.without, names)
    return tuple(e for e in CATALOGUE if (e.name in settings.effects if settings.effects else e.weighed)
                 and e.name not in settings.without)


def check_names(key, wanted, known):
    """ConfigError at ``diagnosis.key`` for a wanted name that is not known."""
    unknown = [name for name in wanted if name not in known]
    if unknown:
        near = list(dict.fromkeys(n for wrong in unknown for n in get_close_matches(wrong, known, 3, 0.5)))
        raise ConfigError(f"diagnosis.{key}", f"of {first_of([*near, *(n for n in known if n not in near)], _LISTED)}",
                          ", ".join(unknown), f"do you mean {' or '.join(near)}?" if near else None)
