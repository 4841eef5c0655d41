"""What is left of the equation of motion, as a force: where it acts and what it follows. Read off, not solved for.

Forces are balanced coordinate by coordinate, so that the place is the coordinate whose balance does not close.
"""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.case_models.force_balance import channel_names
from pipeline.diagnosis.rules import DEFAULTS, DiagnosisRules
from pipeline.diagnosis.signals.latent_force import Description, LatentRun, dependences, regimes, sentence
from pipeline.diagnosis.signals.latent_force_law import used
from pipeline.diagnosis.signals.localisation import Axes, channel_axis, fitted, leading_place, residuals

#: what channels of balanced forces are called before the name of their body
PREFIX = "force on "


@dataclass(frozen=True)
class BalanceAxes:
    """Locator by residuals, and by place: over the ``channels``, the forces on the coordinates."""

    channels: tuple
    residual: Axes

    def located(self, diagnosis):
        axes = self.residual
        whites = residuals(axes.problem, axes.budget, diagnosis.recalibrated)
        location = channel_axis(self.channels, whites, axes.budget, axes.level, axes.draws, axes.seed)
        location = replace(location, items=tuple(name.removeprefix(PREFIX) for name in location.items))
        return {**axes.located(diagnosis), "place": (location, "", None)}


@dataclass(frozen=True)
class BalancedRuns:
    """Simulator: the forces that the motions of ``balances`` {name: Balance} need on a Bench."""

    balances: dict

    def simulated(self, bench, run):
        return self.balances[run.name].predicted(bench)


@dataclass(frozen=True)
class DescribeBalance:
    """LatentForces over ``balances`` {name: Balance} of a Bench: at the leading significant place."""

    bench: object
    balances: dict
    problem: object
    budget: dict
    rules: DiagnosisRules = DEFAULTS
    draws: int = 2000
    seed: int = 0

    def described(self, diagnosis, axes):
        leader = leading_place(axes, self.rules.latent_force.place_p)
        if leader is None:
            return None
        bench = fitted(self.bench, diagnosis.recalibrated)
        runs = {run.name: self._run(bench, run.name, leader) for run in self.problem.runs}
        learned = [runs[run.name] for run in self.problem.training]
        location, follows = axes["place"][0].items[leader], dependences(learned, self.seed)
        return Description(location, runs, follows, regimes(learned, self.draws, self.seed),
                           sentence(location, learned, follows, self.rules.latent_force.dependence_p))

    def predicted(self, diagnosis, description):
        """LatentUse of a Description on the held-out runs: forces that their motions need."""
        names = [name.removeprefix(PREFIX) for name in channel_names(self.bench)]
        return used(self.bench, np.eye(self.bench.model.size)[names.index(description.location)], description,
                    self.problem, self.budget, diagnosis.recalibrated, BalancedRuns(self.balances), self.rules)

    def _run(self, bench, name, coordinate):
        force, displacement, speed = (values[coordinate] for values in self.balances[name].left(bench))
        std = np.full(len(force), self.budget[name].std[coordinate])
        return LatentRun(self.balances[name].seen.run.time, force, std, displacement, speed, None)
