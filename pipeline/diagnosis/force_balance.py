"""The question of measured motions: what forces they need, put into the equation of motion, against those applied.

Nothing is simulated, so that no solver can be wrong and no start state is needed; the motions must be measured at
every coordinate.
"""

from dataclasses import dataclass, field

from pipeline.case_models.force_balance import balance, begun, channel_names
from pipeline.contract.units import to_si
from pipeline.diagnosis.experiment_design.next_motion import planned_motions
from pipeline.diagnosis.experiment_design.next_run import altered
from pipeline.diagnosis.forced_response import check_names, chosen, nominal_parameters
from pipeline.diagnosis.question import Question, nominal, nothing
from pipeline.diagnosis.signals.balance_residual import BalanceAxes, DescribeBalance
from pipeline.diagnosis.signals.forward_model import candidates, completed, observed, reach
from pipeline.diagnosis.signals.localisation import Axes
from pipeline.inference.fitting.noise import budget
from pipeline.inference.problem import Problem


@dataclass(frozen=True)
class Balanced:
    """Picklable prediction: the forces that measured motions need; ``balances`` {name: Balance}.

    ``altered`` {name: changes}: motions on another bench, see ``next_run``.
    """

    bench: object
    balances: dict
    altered: dict = field(default_factory=dict)

    def __call__(self, hypothesis, values, run):
        bench = altered(completed(self.bench, hypothesis, values), self.altered.get(run.name, {}))
        return self.balances[run.name].predicted(bench)


def question(bench, recorded, settings, equation):
    """Question over {name: Recorded} of a Bench under the sections ``settings`` and ``equation`` of the bench.

    ConfigError for unknown runs, effects, places and parameters, and for motions that are not fully measured.
    """
    check_names("held_out", settings.held_out, recorded)
    balances = {name: balance(bench, one, equation) for name, one in recorded.items()}
    units = {c: u for one in balances.values() for c, u in zip(one.seen.channels, one.seen.unit, strict=True)}
    check_names("noise.std", settings.noise.std, units)
    noise = {c: to_si(v, units[c], f"diagnosis.noise.std.{c}") for c, v in settings.noise.std.items()}
    seen = tuple(observed(one.seen, noise, name in settings.held_out) for name, one in balances.items())
    after = planned_motions(bench, {o.name: recorded[o.name] for o in seen if not (o.held_out or o.repeat_of)},
                            equation, settings.next)
    forward = Balanced(bench, balances | {p.name: p.shown for p in after}, {p.name: p.altered for p in after})
    problem = Problem(seen, forward, nominal(nominal_parameters(bench, settings)))
    # begun as measured, so that nominal runs have the sizes of the measured ones
    trained = [begun(bench, recorded[o.name]) for o in problem.training]
    found = candidates(bench, tuple(one.run for one in trained), chosen(settings), settings.places,
                       reach(bench, trained), settings.priors)
    noises = budget(problem, above=settings.noise.above)
    describe = DescribeBalance(bench, balances, problem, noises, seed=settings.seed)
    axes = BalanceAxes(channel_names(bench), Axes(problem, noises, seed=settings.seed))
    return Question(problem, noises | {p.name: noises[p.like] for p in after}, found, units, axes=axes,
                    describe=describe, use=describe.use if settings.latent_force.predict else nothing,
                    next_runs=tuple(observed(p.shown.seen) for p in after))
