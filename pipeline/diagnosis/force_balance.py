"""The problem of measured motions: what forces they need, put into the equation of motion, against those applied.

Nothing is simulated, so that no solver can be wrong and no start state is needed; the motions must be measured at
every coordinate.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from pipeline.case_models.force_balance import balance, begun, channel_names, refuse_unforced
from pipeline.contract import ConfigError
from pipeline.diagnosis import nuisances
from pipeline.diagnosis.experiment_design.next_motion import planned_motions
from pipeline.diagnosis.experiment_design.next_run import altered
from pipeline.diagnosis.forced_response import check_names, chosen, nominal_parameters, stated_noise
from pipeline.diagnosis.problem import DiagnosisProblem, nominal
from pipeline.diagnosis.settings import procedure
from pipeline.diagnosis.signals.balance_residual import BalanceAxes, DescribeBalance
from pipeline.diagnosis.signals.forward_model import candidates, completed, observed, reach
from pipeline.diagnosis.signals.localisation import Axes
from pipeline.diagnosis.signals.measured_motions import shapes
from pipeline.diagnosis.signals.usable_runs import doubts, usable, without
from pipeline.effects.attached import scaled_channel
from pipeline.inference.fitting.fit_state import linearised
from pipeline.inference.fitting.noise import budget
from pipeline.inference.problem import Problem
from pipeline.physics.virtual_rig.sensor import DISPLACEMENT

#: effects that scale a channel
_SCALES = ("sensor_gain", "unit_factor")
#: a gain that is off by this much is looked for among the nominal values: they imitate it where less than ``_DIFFERS``
#: of its squared change is left and they move by less than ``_COSTS`` standard deviations of their priors together
_OFF, _DIFFERS, _COSTS = 0.1, 0.01, 2.0


@dataclass(frozen=True)
class Balanced:
    """Picklable prediction: the forces that measured motions need; ``balances`` {name: Balance}.

    ``altered`` {name: changes}: motions on another bench, see ``next_run``. ``masses_alike``: channels whose gain
    cannot be told from the nominal values.
    """

    bench: object
    balances: dict
    altered: dict = field(default_factory=dict)
    masses_alike: tuple = ()

    def __call__(self, hypothesis, values, run):
        for name, place in hypothesis.effects:
            if name in _SCALES and place in self.masses_alike:
                raise ConfigError(f"{name} at {place}", "a gain that is not one of masses, dampings and stiffnesses",
                                  "one that these imitate",
                                  f"a gain of {place} cannot be told from the masses in a balance of forces: weigh what"
                                  " moves, and state its masses closer")
        bench = altered(completed(self.bench, hypothesis, values), self.altered.get(run.name, {}))
        return self.balances[run.name].predicted(bench)[:, :run.samples.shape[1]]

    @property
    def plain(self):
        """The same without noise in place of what friction at rest takes off it, as stage bench shows it."""
        return replace(self, balances={name: replace(one, noise=0.0) for name, one in self.balances.items()})

    def along(self, null):
        """The Problem of the runs of a Fit ``null``: all its forces are along measured motions."""
        return Problem(null.runs, self, null.hypothesis)

    def law_errors(self, hypothesis, values, run, effects):
        """[(n, m)] ``shapes`` of the forces of ``effects`` ((name, place), ...) of a hypothesis."""
        others = tuple(pair for pair in hypothesis.effects if pair not in effects)
        with_them, without = (self(h, values, run) for h in (hypothesis, replace(hypothesis, effects=others)))
        return shapes(with_them - without, self.balances[run.name].left(self.bench)[1])


def force_balance_problem(bench, recorded, settings, equation):
    """DiagnosisProblem over {name: Recorded} of a Bench under the section ``equation`` of the bench.

    ConfigError for unknown runs, effects, places and parameters, motions that are not fully measured, and runs whose
    force does not rise above its noise.
    """
    check_names("held_out", settings.held_out, recorded)
    balances, left_out = usable(recorded, lambda record: balance(bench, record, equation))
    settings, recorded = without(settings, left_out), {name: recorded[name] for name in balances}
    units = {c: u for b in balances.values() for c, u in zip(b.seen.channels, b.seen.unit, strict=True)}
    noise = stated_noise(settings, units)
    observations = tuple(observed(b.seen, noise, name in settings.held_out) for name, b in balances.items())
    planned = planned_motions(bench, {o.name: recorded[o.name] for o in observations
                                      if not (o.held_out or o.repeat_of)}, equation, settings.next)
    forward = Balanced(bench, balances | {p.name: p.shown for p in planned}, {p.name: p.altered for p in planned})
    problem = Problem(observations, forward, nominal(nominal_parameters(bench, settings, balances)), stepped=False)
    noises, solver = budget(problem, above=settings.noise.above), procedure(settings)
    for name, one in balances.items():
        refuse_unforced(name, one.seen.samples, noises[name].std)
    balances = {name: replace(one, noise=noises[name].std) for name, one in balances.items()}
    forward = replace(forward, balances=forward.balances | balances)
    forward = replace(forward, masses_alike=_masses_alike(replace(problem, predict=forward), noises))
    problem = replace(problem, predict=forward)
    # begun as measured, so that nominal runs have the sizes of the measured ones
    training = [begun(bench, recorded[o.name]) for o in problem.training]
    refused = []
    effects = candidates(bench, tuple(record.run for record in training), chosen(settings), settings.places,
                         reach(bench, training), settings.priors, refused=refused)
    return DiagnosisProblem(
        problem, noises | {p.name: noises[p.like] for p in planned}, effects, units, solver,
        BalanceAxes(channel_names(bench), Axes.under(problem, noises, solver)),
        DescribeBalance(bench, balances, problem, noises, solver.rules, seed=settings.seed),
        settings.latent_force.predict, next_runs=tuple(observed(p.shown.seen) for p in planned),
        noise_levels=settings.noise.levels, motions=forward,
        nuisances=nuisances.declared(bench, [r.run for r in training], settings, training),
        remarks=(*left_out.values(), *doubts(recorded, bench.model.input_name), *refused))


def _masses_alike(problem, noises):
    """Names of the displacement channels whose gain the nominal values of a Problem imitate."""
    runs, hypothesis, bench, alike = problem.training, problem.nominal, problem.predict.bench, []
    if not hypothesis.parameters:
        return ()
    under = [noises[run.name] for run in runs]
    given = linearised(problem, under, hypothesis, hypothesis.nominal, runs)
    jacobian = np.concatenate(given.jacobians)
    for channel in (c for c in bench.channels if c.measurand == DISPLACEMENT):
        scaled = replace(problem.predict, bench=scaled_channel(bench, channel.name, 1 - _OFF))
        moved = linearised(replace(problem, predict=scaled), under, hypothesis, hypothesis.nominal, runs)
        change = np.concatenate(given.residuals) - np.concatenate(moved.residuals)
        values = np.linalg.lstsq(jacobian, change, rcond=None)[0]
        if (np.sum((change - jacobian @ values)**2) < _DIFFERS * np.sum(change**2)
                and np.linalg.norm(values) < _COSTS):
            alike.append(channel.name)
    return tuple(alike)
