"""What is left of the equation of motion, as a force: where it acts and what it follows. Read off, not solved for.

Forces are balanced coordinate by coordinate, so that the place is the coordinate whose balance does not close.
"""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.case_models.force_balance import channel_names
from pipeline.diagnosis.signals.latent_force import Description, LatentRun, dependences, regimes, sentence
from pipeline.diagnosis.signals.latent_force_law import used
from pipeline.diagnosis.signals.localisation import Axes, channel_axis, fitted, leading_place, residuals

#: what channels of balanced forces are called before the name of their body
PREFIX = "force on "


@dataclass(frozen=True)
class BalanceAxes:
    """Axes of residuals, and the place: over the ``channels``, the forces on the coordinates."""

    channels: tuple
    residual: Axes

    def __call__(self, found):
        own = self.residual
        whites = residuals(own.problem, own.budget, (found.base or found).null)
        place = channel_axis(self.channels, whites, own.budget, own.level, own.draws, own.seed)
        place = replace(place, items=tuple(name.removeprefix(PREFIX) for name in place.items))
        return {**own(found), "place": (place, "", None)}


@dataclass(frozen=True)
class DescribeBalance:
    """The ``describe`` of a Question over ``balances`` {name: Balance} of a Bench: at the leading significant place."""

    bench: object
    balances: dict
    problem: object
    budget: dict
    draws: int = 2000
    seed: int = 0

    def __call__(self, found, axes):
        leader = leading_place(axes)
        if leader is None:
            return None
        bench = fitted(self.bench, (found.base or found).null)
        runs = {run.name: self._run(bench, run.name, leader) for run in self.problem.runs}
        learned = [runs[run.name] for run in self.problem.training]
        place, follows = axes["place"][0].items[leader], dependences(learned, self.seed)
        return Description(place, runs, follows, regimes(learned, self.draws, self.seed),
                           sentence(place, learned, follows))

    def use(self, found, description):
        """LatentUse of a Description on the held-out runs: forces that their motions need."""
        names = [name.removeprefix(PREFIX) for name in channel_names(self.bench)]
        return used(self.bench, np.eye(self.bench.model.size)[names.index(description.place)], description,
                    self.problem, self.budget, (found.base or found).null,
                    lambda whole, run: self.balances[run.name].predicted(whole))

    def _run(self, bench, name, coordinate):
        force, place, speed = (values[coordinate] for values in self.balances[name].left(bench))
        std = np.full(len(force), self.budget[name].std[coordinate])
        return LatentRun(self.balances[name].seen.run.time, force, std, place, speed, None)
