"""A diagnosis in five steps: calibration, screening, refits, weighing, decision; pairs by greedy addition.

Where the nominal model does not reach the noise, its linearisation may rank nothing: there every candidate begins its
fit unless one of the first few explains enough, and the best few go on. What else could move as the best one does is
looked for at the nominal values that the best one asks for.
A null hypothesis that has not converged lets every candidate win: it is refitted from each candidate's optimum. A model
that lacks physics may have no smooth optimum at all: then a candidate counts only where it goes far below the null.
"""

from dataclasses import dataclass, replace
from typing import Optional

from pipeline.contract.errors import ConvergenceError
from pipeline.inference.decision import second_effect
from pipeline.inference.decision.decision_rules import Decision, decide
from pipeline.inference.decision.weighing import Weighing, weigh
from pipeline.inference.fitting.calibration import Calibration, recalibrate
from pipeline.inference.fitting.refitting import Refits, refit_catalogue
from pipeline.inference.rules import DEFAULTS, Rules
from pipeline.inference.search.score_screen import screen_catalogue


@dataclass(frozen=True)
class Settings:
    """``kept``: candidates refitted after the screen; ``starts``: latent values tried; ``draws``, ``seed`` of nulls.

    ``tied_seconds``: whether second effects that cannot be distinguished complete a first one all the same.
    """

    kept: int = 8
    starts: tuple = (-1.0, 1.0)
    draws: int = 20000
    seed: int = 0
    rules: Rules = DEFAULTS
    tied_seconds: bool = False


@dataclass(frozen=True)
class Diagnosis:
    """What the steps came to: the ``calibration``, the ``weighing`` of a screened and refitted catalogue, the decision.

    ``base``: the Diagnosis that came before a pair, whose nominal hypothesis takes the first effect as known;
    ``refits``: what was weighed. ``further``: what was tried beside the leading effect and did not matter, if anything.
    """

    calibration: Calibration
    weighing: Weighing
    decision: Decision
    base: Optional["Diagnosis"] = None
    refits: Refits | None = None
    further: Optional["Diagnosis"] = None

    @property
    def nominal(self):
        """The hypothesis that was taken as known."""
        return self.calibration.problem.nominal

    @property
    def null(self):
        """The Fit of the nominal hypothesis."""
        return self.calibration.null

    @property
    def recalibrated(self):
        """The Fit of the nominal model of the case, without what a pair takes as known."""
        return (self.base or self).null

    @property
    def weighed(self):
        """The refitted candidates, best first."""
        return self.weighing.weighed

    @property
    def screen(self):
        return self.weighing.evidences.screen

    @property
    def weights(self):
        """Weights (runs,) of the log-likelihoods."""
        return self.weighing.evidences.weights

    @property
    def posterior(self):
        return self.weighing.posterior

    @property
    def failures(self):
        return self.weighing.failures

    @property
    def named(self):
        """The refitted candidates that the decision names."""
        names = [c.name for c in self.decision.named]
        return tuple(w for w in self.weighed if w.candidate.name in names)

    @property
    def completed(self):
        """The Fit of the model that the decision completes: that of its first named hypothesis, else the nominal."""
        names = [c.name for c in self.decision.named]
        return next((w.fit for name in names for w in self.weighed if w.candidate.name == name), self.null)


def diagnose(problem, budget, catalogue, settings=None, fan_out=map):
    """Diagnosis of a Problem with {run: Noise} ``budget`` over a ``catalogue`` of Hypotheses (effects alone).

    ``fan_out(function, items)`` maps as the builtin does. Where one effect is not enough, pairs with each of the
    leading ones that can be fitted are tried by the same rules, the first taken as known; a second effect has to
    explain more than the law of the first can be wrong by (see ``second_effect``). Raises ConvergenceError where the
    nominal model has no fit.
    """
    settings = settings or Settings()
    _, single = _steps(problem, budget, catalogue, settings, fan_out)
    if len(problem.runs) > 1 and single.decision.verdict in ("unknown", "missing"):
        for first in second_effect.leading(single, settings.rules):
            pair, matters = _pair(problem, budget, catalogue, settings, fan_out, single, first)
            if matters:
                return pair
            if first in single.named:
                single = replace(single, further=pair)
    if settings.tied_seconds and single.decision.verdict == "unknown":
        return _tied_pair(problem, budget, catalogue, settings, fan_out, single)
    return single


def _steps(problem, budget, catalogue, settings, fan_out, start=None, base=None):
    """(Refits, Diagnosis) of the five steps; the nominal model is fitted from the Fit ``start``, if there is one."""
    calibration = recalibrate(problem, budget, settings.rules.calibration, start)
    screening = screen_catalogue(calibration, catalogue, settings, fan_out, base is not None)
    refits = refit_catalogue(screening, catalogue, settings, fan_out)
    return refits, _decided(refits, settings, base)


def _decided(refits, settings, base):
    """Diagnosis of Refits: weighing and decision. ConvergenceError where nothing is missing but nothing converged."""
    weighing = weigh(refits, settings)
    decision = decide(weighing.runs, [w.statistics for w in weighing.weighed], settings.rules.decision)
    null = refits.calibration.null
    if not null.converged and decision.verdict in ("consistent", "parameters"):
        raise ConvergenceError(f"calibration of {null.hypothesis.name}", "a fit that converges",
                               f"none after {null.evaluations} predictions", "check the nominal values and priors")
    return Diagnosis(refits.calibration, weighing, decision, base, refits)


@dataclass(frozen=True)
class VerdictAtNoise:
    """What the decision would be if noise were ``factor`` times what is stated: its ``verdict`` and whom it ``named``.
    """

    factor: float
    verdict: str
    named: tuple


def over_noise(diagnosis, settings, factors):
    """[VerdictAtNoise] of a Diagnosis, all fitted values as they are: how far the verdict hangs on the level of noise.
    """
    told = []
    for factor in factors:
        weighing = weigh(diagnosis.refits.at_noise(factor), settings)
        decision = decide(weighing.runs, [w.statistics for w in weighing.weighed], settings.rules.decision)
        told.append(VerdictAtNoise(float(factor), decision.verdict, tuple(c.name for c in decision.named)))
    return told


def _pair(problem, budget, catalogue, settings, fan_out, single, first):
    """(Diagnosis with the ``first`` Weighed taken as known or None, whether it names a second effect that matters)."""
    rules, explained = settings.rules, first.fit.betters(single.null)
    if not second_effect.has_room(first.fit, explained, rules):
        return None, False
    rest = [c for c in catalogue if c.name != first.candidate.name]
    try:
        refits, pair = _steps(problem.given(first.refined), budget, rest, settings, fan_out, first.fit, single)
    except ConvergenceError:
        return None, False
    if not second_effect.matters(pair, explained, rules):
        return pair, False
    alone = _decided(refits.begun_anew(second_effect.starts_without(first, pair, rest)), settings, single)
    return (alone if second_effect.better_alone(alone, pair) else pair), True


def _tied_pair(problem, budget, catalogue, settings, fan_out, single):
    """The first Diagnosis that names anything beside a significant effect taken as known; ``single`` where none does.
    """
    rules = settings.rules.decision
    for first in single.weighed:
        if first.statistics.p_value > rules.p_value or first.statistics.evidence_gain < rules.evidence_gain:
            continue
        rest = tuple(c for c in catalogue if c.name != first.candidate.name)
        pair = diagnose(problem.given(first.refined), budget, rest, replace(settings, tied_seconds=False), fan_out)
        if pair.decision.named:
            return replace(pair, base=single)
    return single
