"""What to measure or compute next where published lists are compared: the record whose outcome is expected most
differently by the hypotheses that they leave.

Beside a table of modes every alternative comes with a check that undoes it: shapes undo wrong pairs, a finer mesh what
grows with the frequency, another support that of the test. If an alternative holds, its check moves the lines by its
share of them, else by nothing. Beside harmonics the outcomes are the levels, shares of time and amplitudes of the
computed motions.
"""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.diagnosis.rules import DEFAULTS
from pipeline.inference.fitting.fit_state import linearised
from pipeline.inference.fitting.noise import budget
from pipeline.inference.planning.experiment_choice import Prediction, choose, predicted
from pipeline.inference.problem import Observed, Problem


@dataclass(frozen=True)
class Expected:
    """The record that separates best: its ``condition``, the hypotheses that it ``separates``, its ``value`` in nats.
    """

    condition: str
    separates: tuple
    value: float


@dataclass(frozen=True)
class Check:
    """What undoes alternatives of these ``effects``; whether it also ``tells_which`` of them holds, as shapes do."""

    effects: tuple
    tells_which: bool = False


@dataclass(frozen=True)
class Undone:
    """Picklable prediction of what a check moves (``checks`` {condition: Check} of a Blended), and which holds."""

    forward: object
    checks: dict

    def __call__(self, hypothesis, values, run):
        check = self.checks[run.name]
        undone = tuple(pair for pair in hypothesis.effects if pair[0] in check.effects)
        with_them, without = (np.hstack([self.forward(replace(hypothesis, effects=effects), values, _Named(name))
                                         for name in self.forward.shown]) for effects in (undone, ()))
        return np.hstack((with_them - without, [[float(pair in undone) for pair in self.distinguished(run.name)]]))

    def distinguished(self, name):
        """The alternatives ((effect, place), ...) of which a check tells whether they hold."""
        check = self.checks[name]
        return [pair for pair in self.forward.alternatives if check.tells_which and pair[0] in check.effects]


@dataclass(frozen=True)
class _Named:
    """As much of a run as a Blended asks for."""

    name: str


def best_check(given, rivals, checks, rules=DEFAULTS.lists):
    """Expected over ``checks`` {condition: Check} of the DiagnosisProblem ``given`` of lists, between Rivals.

    None where no check separates any of them.
    """
    undone = Undone(given.problem.predict, checks)
    lines = np.hstack([run.noise_std for run in given.problem.runs])
    std = {name: np.hstack((lines, np.full((1, len(undone.distinguished(name))), rules.half_std))) for name in checks}
    runs = tuple(Observed(name, {}, ("change",), np.zeros(deviation.shape), noise_std=deviation)
                 for name, deviation in std.items())
    problem = Problem(runs, undone, given.problem.nominal)
    noises = budget(problem)

    def prediction(fit, run):
        there = linearised(problem, [noises[run.name]], fit.hypothesis, fit.latent, [run])
        return predicted(-there.residuals[0], there.jacobians[0], fit.covariance())

    return _best(rivals, {run.name: [prediction(rival.fit, run) for rival in rivals] for run in runs}, rules)


def best_outcome(rivals, outcomes, rules=DEFAULTS.lists):
    """Expected over ``outcomes`` {condition: {hypothesis: (m,), over their standard deviation}} between Rivals; None
    where none tells any of them apart."""
    return _best(rivals, {name: [Prediction(outcome[r.name], np.zeros((len(outcome[r.name]), 0))) for r in rivals]
                          for name, outcome in outcomes.items()}, rules)


def _best(rivals, predictions, rules):
    share = np.array([rival.share for rival in rivals])
    choice = choose(share / share.sum(), list(predictions.values()))
    value = float(choice.value[choice.index])
    if value < rules.next_value:
        return None
    return Expected(list(predictions)[choice.index], tuple(rivals[k].name for k in choice.separates), value)
