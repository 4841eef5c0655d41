"""The problem of self-excited recordings: poles and other features of a bench, by complex eigenvalues."""

from dataclasses import dataclass, field, replace

from pipeline.contract import BrakechainError, ConfigError
from pipeline.diagnosis.experiment_design.next_features import planned_records
from pipeline.diagnosis.experiment_design.next_run import altered
from pipeline.diagnosis.features.limit_cycle_check import Squeals
from pipeline.diagnosis.features.other_machine import OtherMachine, refuse
from pipeline.diagnosis.features.poles import features, observed, predicted
from pipeline.diagnosis.forced_response import check_names, chosen, nominal_parameters
from pipeline.diagnosis.problem import DiagnosisProblem, nominal
from pipeline.diagnosis.rules import DEFAULTS, PoleRules
from pipeline.diagnosis.settings import procedure
from pipeline.diagnosis.signals.forward_model import candidates, completed
from pipeline.inference.fitting.noise import budget
from pipeline.inference.problem import Problem

#: where fits of effects begin beside the screen's values: at the medians of their priors. What adds a mode has to be
#: near a peak that lacks one, and the screen tries shapes off the median alone
_STARTS = (0.0,)
#: how long runs are simulated for the sizes of priors
_GLIMPSE = 5e-3


@dataclass(frozen=True)
class Rooted:
    """Picklable prediction of Features ``recorded`` {run: Features}; ``last`` keeps the bench that all runs share.

    ``altered`` {name: changes}: records on another bench, see ``next_run``.
    """

    bench: object
    recorded: dict
    altered: dict = field(default_factory=dict)
    rules: PoleRules = DEFAULTS.poles
    last: dict = field(default_factory=dict, compare=False)

    def __call__(self, hypothesis, values, run):
        key = hypothesis.effects, tuple(values.items())
        if key not in self.last:
            self.last.clear()
            self.last[key] = completed(self.bench, hypothesis, values)
        bench = altered(self.last[key], self.altered.get(run.name, {}))
        return predicted(bench, self.recorded[run.name], run.channels, self.rules)


def pole_problem(bench, recorded, settings, band):
    """DiagnosisProblem over {name: Recorded} of a Bench whose section ``bench.poles`` is ``band``.

    ConfigError for unknown runs, effects and parameters, and for recordings that show no pole twice, or those of
    another machine.
    """
    solver = procedure(settings, few=True, starts=_STARTS)
    shown = features(bench, recorded, band, solver.rules.poles)
    check_names("held_out", settings.held_out, shown)
    observations, units = observed(shown, settings.held_out)
    refuse(bench, shown, solver.rules.poles)
    squeals = None
    if settings.saturated_squeal:
        check_names("saturated_squeal.runs", settings.saturated_squeal.runs, recorded)
        squeals = Squeals(bench, recorded, settings.saturated_squeal, settings.seed)
    if not units:
        raise ConfigError("diagnosis", "poles that two records show", "none", "widen bench.poles, or tap harder")
    planned = planned_records(bench, {o.name: shown[o.name] for o in observations if not o.held_out}, settings.next)
    forward = Rooted(bench, shown | {p.name: p.shown for p in planned}, {p.name: p.altered for p in planned},
                     solver.rules.poles)
    problem = Problem(observations, forward, nominal(nominal_parameters(bench, settings)))
    brief = tuple(replace(shown[o.name].run, duration=_GLIMPSE, sample_rate=max(1 / bench.step, 2 / _GLIMPSE),
                          inputs={}, drive=None) for o in problem.training)
    noises, by_name = budget(problem), {o.name: o for o in observations}
    blank = {p.name: replace(by_name[p.like], name=p.name, conditions=p.shown.run.conditions) for p in planned}
    effects = candidates(bench, brief, chosen(settings), settings.places, priors=settings.priors,
                         refused=(refused := []))
    return DiagnosisProblem(
        problem, noises | {p.name: noises[p.like] for p in planned}, effects, units, solver,
        squeals=squeals, revision=OtherMachine(solver.rules.poles),
        next_runs=_predictable(problem, blank.values(), must=bool(settings.next)), remarks=tuple(refused))


def _predictable(problem, runs, must):
    """Those ``runs`` (Observed) that the nominal model predicts; where all ``must`` be, its error is raised."""
    possible = []
    for run in runs:
        try:
            problem.predict(problem.nominal, problem.nominal.values(problem.nominal.nominal), run)
            possible.append(run)
        except BrakechainError:
            if must:
                raise
    return tuple(possible)
