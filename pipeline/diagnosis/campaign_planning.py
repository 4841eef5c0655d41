"""Before the bench: which planned run can name which effect, and the cheapest set of runs that names all wanted.

Each effect stands at each of its places with the median of its prior, or one standard deviation where it has either
sign; d is the change that it makes in the channels of a run, in standard deviations of noise, less what the nominal
parameters can hide within their priors. About 4 names an effect against the nominal model; whether two effects can be
told apart is not asked here.
"""

from dataclasses import dataclass

import numpy as np

from pipeline.case_models.virtual_rig import only
from pipeline.contract import ConfigError
from pipeline.contract.units import to_si
from pipeline.diagnosis.forced_response import check_names, chosen, nominal_parameters
from pipeline.diagnosis.problem import nominal
from pipeline.diagnosis.signals.forward_model import Simulated, candidates
from pipeline.inference.fitting.fit_state import linearised, whitened
from pipeline.inference.fitting.noise import budget
from pipeline.inference.planning import campaign as mathematics
from pipeline.inference.problem import Observed, Problem
from pipeline.physics.virtual_rig.response import Run

#: quantile one standard deviation above the middle
_ONE_SIGMA = 0.8413


@dataclass(frozen=True)
class Planned:
    """``power`` d (run, effect), d of all runs together (effect,); ``chosen`` (runs) name ``reached`` of those wanted.

    ``effects``: "effect at place"; ``together``: d of the chosen runs; ``missed``: wanted ones out of reach.
    """

    runs: tuple
    effects: tuple
    power: np.ndarray
    whole: np.ndarray
    chosen: tuple
    together: np.ndarray
    cost: float
    missed: tuple


def plan(bench, units, settings):
    """Planned of a Bench whose channels have ``units`` {channel: SI unit}, under the filled section ``diagnosis``.

    ConfigError without planned runs or noise, for unknown inputs and effects.
    """
    runs, costs = planned_runs(bench, settings.plan), [run.cost for run in settings.plan.runs.values()]
    effects = candidates(bench, tuple(runs.values()), chosen(settings), settings.places,
                       priors=settings.priors)
    directions, jacobians = _seen(bench, runs, units, settings, effects)
    names = tuple(c.name for c in effects)
    needed, everything = settings.plan.needed, range(len(runs))
    whole = mathematics.combined_power(directions, jacobians, everything)
    wanted = _wanted(settings.plan.wanted, effects)
    in_reach = [k for k in wanted if whole[k] >= needed]
    selected = mathematics.cheapest(directions, jacobians, costs, in_reach, needed) if in_reach else ()
    return Planned(tuple(runs), names, mathematics.power_table(directions, jacobians), whole,
                   tuple(tuple(runs)[k] for k in selected), mathematics.combined_power(directions, jacobians, selected),
                   float(sum(costs[k] for k in selected)), tuple(names[k] for k in wanted if k not in in_reach))


def table(planned):
    """(head, rows) of text: one row an effect, one column a run, then all runs and the chosen ones together."""
    head = ("effect", *planned.runs, "all", "chosen")
    columns = np.column_stack((planned.power.T, planned.whole, planned.together))
    return head, [(name, *(f"{d:.1f}" for d in row)) for name, row in zip(planned.effects, columns, strict=True)]


def conclusion(planned):
    """The cheapest set in one sentence, and what is out of reach."""
    sentence = (f"cheapest set: {', '.join(planned.chosen)} (cost {planned.cost:g})" if planned.chosen else
            "no set of these runs names any of the wanted effects")
    lost = f"; out of reach: {', '.join(planned.missed)}" if planned.missed else ""
    return sentence + lost


def planned_runs(bench, settings):
    """{name: Run} of the section ``plan``: inputs are fed linear sweeps."""
    if not settings.runs:
        raise ConfigError("diagnosis.plan.runs", "at least one run that could be recorded", "none",
                          "name runs with their duration, sample_rate and inputs")
    planned = {}
    for name, stated in settings.runs.items():
        check_names(f"plan.runs.{name}.inputs", stated.inputs, bench.model.input_name)
        drive = {} if stated.speed is None else {"drive": stated.speed}
        run = Run(name, stated.duration, stated.sample_rate, **drive)
        planned[name] = Run(name, stated.duration, stated.sample_rate,
                          {key: _sweep(run.time, sweep) for key, sweep in stated.inputs.items()}, **drive)
    return planned


def channel_units(bench):
    """{channel: SI unit} of what the channels of a bench show, gain left out."""
    return {c.name: c.measurand.unit for c in bench.channels}


def _sweep(time, given):
    rise = (given.end - given.start) / time[-1]
    return given.amplitude * np.sin(2 * np.pi * (given.start + 0.5 * rise * time) * time)


def _seen(bench, runs, units, settings, effects):
    """([[(m,) whitened change by each effect] of each run], [(m, k) Jacobian of each run])."""
    names = tuple(c.name for c in bench.channels)
    lacking = [name for name in names if name not in settings.noise.std]
    if lacking:
        raise ConfigError("diagnosis.noise.std", "the noise that each channel will have",
                          f"none of {', '.join(lacking)}", "give the resolution of the sensor")
    std = np.array([to_si(settings.noise.std[n], units[n], f"diagnosis.noise.std.{n}") for n in names])
    blank = tuple(Observed(n, {}, names, np.zeros((len(names), run.samples)), run.sample_rate, noise_std=std)
                  for n, run in runs.items())
    problem = Problem(blank, Simulated(only(bench, names), runs), nominal(nominal_parameters(bench, settings)))
    noises, directions, jacobians = budget(problem), [], []
    for run in blank:
        null = linearised(problem, [noises[run.name]], problem.nominal, problem.nominal.nominal, [run])
        directions.append([change(problem, null, candidate) for candidate in effects])
        jacobians.append(null.jacobians[0])
    return directions, jacobians


def change(problem, null, candidate):
    """(m,) whitened change by one effect of the size that its prior expects; none where it cannot be simulated."""
    latent = np.array([p.prior.latent(p.prior.quantile(_ONE_SIGMA if p.null is not None and not p.sign else 0.5))
                       for p in candidate.parameters])
    moved, _ = whitened(problem, null.noises, problem.nominal.joined(candidate),
                        np.concatenate((null.latent, latent)), null.runs)
    return np.zeros(len(null.residuals[0])) if moved is None else null.residuals[0] - moved[0]


def _wanted(names, effects):
    """Indices of the effects that are wanted, by effect or by 'effect at place'; all where none is named."""
    known_names = {c.name for c in effects} | {c.effects[0][0] for c in effects}
    check_names("plan.wanted", names, known_names)
    return [k for k, c in enumerate(effects) if not names or c.name in names or c.effects[0][0] in names]
