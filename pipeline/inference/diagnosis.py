"""What a diagnosis comes to: how its refits are weighed and decided, and how far that hangs on the level of noise."""

from dataclasses import dataclass, field, replace
from typing import Optional

import numpy as np

from pipeline.inference.decision import several_laws
from pipeline.inference.decision.decision_rules import Decision
from pipeline.inference.decision.weighing import Weighing, weigh
from pipeline.inference.fitting.calibration import Calibration
from pipeline.inference.fitting.refitted import Refits
from pipeline.inference.rules import DEFAULTS, Rules
from pipeline.inference.time_budget import spent, within


@dataclass(frozen=True)
class Settings:
    """``kept``: candidates refitted after the screen; ``starts``: latent values tried; ``draws``, ``seed`` of nulls.

    ``tied_seconds``: whether second effects that cannot be distinguished complete a first one all the same;
    ``seconds``: CPU time of a core.
    """

    kept: int = 8
    starts: tuple = (-1.0, 0.0, 1.0)
    draws: int = 20000
    seed: int = 0
    rules: Rules = DEFAULTS
    tied_seconds: bool = False
    seconds: float = np.inf


@dataclass(frozen=True)
class Diagnosis:
    """What the steps came to: the ``calibration``, the ``weighing`` of a screened and refitted catalogue, the decision.

    ``base``: the Diagnosis that came before a pair, whose nominal hypothesis takes the first effect as known, or before
    a set of several, which takes all but one as known; ``refits``: what was weighed. ``further``: what was tried beside
    the leading effect and did not matter, if anything. ``combinations``: the several Combinations that were tried;
    ``laws``: how many were fitted as one set; ``objected`` {law: why it is of another form}. ``cut_short``: whether the
    time was spent before all was tried, so that nothing may be named. ``model_error``: of a law that holds in part, in
    noise floors; 1 of noise alone.
    """

    calibration: Calibration
    weighing: Weighing
    decision: Decision
    base: Optional["Diagnosis"] = None
    refits: Refits | None = None
    further: Optional["Diagnosis"] = None
    combinations: tuple = ()
    laws: int = 1
    objected: dict = field(default_factory=dict)
    cut_short: bool = False
    model_error: float = 1.0

    def remarked(self, *sentences, first=False):
        """The same with further ``sentences`` among the reasons of its decision, at their end or ``first``."""
        reasons = (*sentences, *self.decision.reasons) if first else (*self.decision.reasons, *sentences)
        return replace(self, decision=replace(self.decision, reasons=reasons))

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

    def ended(self):
        """This Diagnosis where its time was spent: what it would name leads, as what was not tried may do as well."""
        if self.cut_short:
            return self
        left = tuple(name for name, why in self.failures.items() if why)
        return replace(self, cut_short=True, decision=_not_yet(self.decision, left))


#: hypotheses not tried to the end that are told by name
_TOLD = 5


def _not_yet(decision, left):
    """A Decision that names nothing, as hypotheses of the names ``left`` were not tried to the end."""
    which = f" ({', '.join(left[:_TOLD])}{' and others' * (len(left) > _TOLD)})" * bool(left)
    why = (f"the time was spent before all was tried: {len(left)} hypotheses were not fitted to the end{which}; allow"
           " more by diagnosis.time",)
    if decision.named:
        why += (f"so far: {decision.verdict}, {' or '.join(c.name for c in decision.named)}",)
    return replace(decision, verdict="unknown", named=(), reasons=why + decision.reasons,
                   leading=decision.leading or next(iter(decision.named), None))


def decided(refits, settings, base, laws=1):
    """Diagnosis of Refits, the last of so many ``laws``; unknown where nothing is missing but nothing converged,
    however often the null begins again."""
    late = spent()
    with within(np.inf):        # what has been fitted is weighed in any case
        refits = refits.as_stated()
        weighing, decision = _weighed(refits, settings, base and base.null, laws)
        if not late and _rests_on_unfinished(refits, decision):
            refits = replace(refits, calibration=refits.calibration.gone_on(settings.rules.refit.restarts))
            weighing, decision = _weighed(refits, settings, base and base.null, laws)
    if not late and _rests_on_unfinished(refits, decision):
        null = refits.calibration.null
        decision = replace(decision, verdict="unknown", named=(), reasons=(
            f"the fit of {null.hypothesis.name} did not converge after {null.evaluations} predictions, although it"
            " leaves no more than noise: check the nominal values and priors", *decision.reasons))
    told = Diagnosis(refits.calibration, weighing, decision, base, refits, laws=laws)
    return told.ended() if late else told


def _rests_on_unfinished(refits, decision):
    """Whether a Decision says that nothing is missing, of a null that has not converged."""
    return not refits.calibration.null.converged and decision.verdict in ("consistent", "parameters")


def _weighed(refits, settings, null, laws, objected=None):
    """(Weighing, Decision) of Refits, laws ``objected`` to {name: why}; of a set of ``laws``, beside a Fit ``null``."""
    calibration = refits.calibration
    settings = several_laws.allowing(settings, laws, bool(calibration.problem.nominal.effects))
    weighing = weigh(refits, settings)
    if laws > 1:
        weighing = several_laws.against(null, calibration.problem, calibration.budget, weighing, settings.rules)
    weighing = weighing.objected(objected or {})
    return weighing, weighing.decided(settings.rules)


@dataclass(frozen=True)
class VerdictAtNoise:
    """What the decision would be if noise, or the error of the model beside which something is named, were ``factor``
    times as large: its ``verdict`` and whom it ``named``."""

    factor: float
    verdict: str
    named: tuple


def over_noise(diagnosis, settings, factors):
    """[VerdictAtNoise] of a Diagnosis, all fitted values as they are: how far the verdict hangs on the noise."""
    if diagnosis.cut_short:
        return [VerdictAtNoise(float(factor), "unknown", ()) for factor in factors]
    told = []
    for factor in factors:
        noise = factor * diagnosis.model_error
        _, decision = _weighed(diagnosis.refits.at_noise(noise), settings, diagnosis.recalibrated.at_noise(noise),
                               diagnosis.laws, diagnosis.objected)
        told.append(VerdictAtNoise(float(factor), decision.verdict, tuple(c.name for c in decision.named)))
    return told


def reaches_noise(diagnosis, rules):
    """Whether a Diagnosis leaves nothing to explain: nominal model or a candidate reach the noise on all runs."""
    def reaches(weighed):
        statistics = weighed.statistics
        return (weighed.fit.reaches_noise(rules.decision.noise_uncertainty) and not statistics.unexplained
                and (statistics.held_out_left or 0.0) <= rules.decision.held_out_left)

    return diagnosis.decision.verdict in ("consistent", "parameters") or any(map(reaches, diagnosis.weighed))
