"""The course of a diagnosis: recalibrate, screen, refit, weigh, verify, decide; pairs by greedy addition.

A null hypothesis that has not converged lets every candidate win: it is refitted from each candidate's optimum.
"""

from dataclasses import dataclass
from functools import partial

import numpy as np

from pipeline.contract.errors import BrakechainError, ConvergenceError
from pipeline.inference import decide as rulebook
from pipeline.inference.calibrate import calibrate
from pipeline.inference.drift import drift
from pipeline.inference.effective import tempering
from pipeline.inference.evidence import cautious_prior, evidence, posterior, screened
from pipeline.inference.screen import directions, screen
from pipeline.inference.weigh import contender, held_out_gains, situation


@dataclass(frozen=True)
class Settings:
    """``kept``: candidates refitted after the screen; ``starts``: latent values tried; ``draws``, ``seed`` of nulls."""

    kept: int = 8
    starts: tuple = (-1.0, 1.0)
    draws: int = 20000
    seed: int = 0
    rules: rulebook.Rules = rulebook.Rules()


@dataclass(frozen=True)
class Weighed:
    """A refitted candidate: its Fit, Evidence, posterior and the numbers the rules saw."""

    candidate: object
    fit: object
    evidence: object
    contender: rulebook.Contender


@dataclass(frozen=True)
class Diagnosis:
    """``decision``, with the null Fit, its drift, the screen, the refitted candidates (best first), runs' weights.

    ``nominal`` is the hypothesis taken as known; ``posterior_of_null`` of its sufficing; ``base`` the Diagnosis that
    came before a pair; ``failures`` {candidate: why it was not judged}.
    """

    decision: rulebook.Decision
    nominal: object
    null: object
    null_evidence: object
    drift: object
    screen: object
    weighed: tuple
    weights: np.ndarray
    posterior_of_null: float
    failures: dict
    base: object = None

    @property
    def named(self):
        """The refitted candidates that the decision names."""
        names = [c.name for c in self.decision.named]
        return tuple(w for w in self.weighed if w.candidate.name in names)


def diagnose(problem, budget, catalogue, settings=None, fan_out=map):
    """Diagnosis of a Problem with {run: Noise} ``budget`` over a ``catalogue`` of Hypotheses (effects alone).

    A second effect is refitted only where its score is significant beside the first.

    ``fan_out(function, items)`` maps as the builtin does. Where one effect is not enough, pairs with each of the
    leading ones are tried by the same rules, the first taken as known. Raises ConvergenceError where the nominal model
    has no fit.
    """
    settings = settings or Settings()
    single = _one_step(problem, budget, catalogue, settings, fan_out)
    if single.decision.verdict not in ("unknown", "missing") or len(problem.runs) < 2:
        return single
    for first in _leading(single, settings.rules):
        rest = [c for c in catalogue if c.name != first.candidate.name]
        pair = _one_step(problem.given(first.candidate), budget, rest, settings, fan_out, first.fit, single)
        if pair.decision.verdict in ("missing", "sensor", "numerics"):
            return pair
    return single


def _one_step(problem, budget, catalogue, settings, fan_out, start=None, base=None):
    runs, hypothesis = problem.training, problem.nominal
    noises = tuple(budget[run.name] for run in runs)
    first = start.latent if start else hypothesis.nominal
    null = calibrate(problem, noises, hypothesis, [first], runs)
    found = list(fan_out(partial(directions, problem, null), catalogue))
    rough = screen(null, found, None, settings.draws, settings.seed)
    kept = [i for i in rough.order()[:settings.kept] if np.isfinite(rough.score[i])
            and (base is None or rough.p_value[i] <= settings.rules.p_value)]
    work = partial(_refitted, problem, noises, null, settings.starts)
    results = list(fan_out(work, [(catalogue[i], rough.start[i]) for i in kept]))
    better = min([null, *(r[1] for r in results if r[1] is not None)], key=lambda f: f.objective)
    if better.objective < null.objective - 0.1:
        null = better
        found = list(fan_out(partial(directions, problem, null), catalogue))
    fits = {i: r[0] for i, r in zip(kept, results, strict=True) if r[0] is not None}
    failures = {catalogue[i].name: r[2] for i, r in zip(kept, results, strict=True) if r[0] is None}
    failures |= {f.candidate.name: f.failure for f in found if f.failure}
    return _weighed(problem, budget, null, found, fits, failures, settings, base)


def _refitted(problem, noises, null, offsets, item):
    """(best Fit of a candidate or None, Fit of the null from its optimum or None, reason)."""
    candidate, screened_start = item
    hypothesis, size = problem.nominal.joined(candidate), len(null.latent)
    begins = [screened_start] + [np.full(len(candidate.parameters), offset) for offset in offsets]
    starts = [np.concatenate((null.latent, np.clip(begin, -2, 2))) for begin in begins]
    try:
        best = calibrate(problem, noises, hypothesis, starts, null.runs)
    except BrakechainError as error:
        return None, None, str(error)
    try:
        again = calibrate(problem, noises, problem.nominal, [best.latent[:size]], null.runs)
    except ConvergenceError:
        again = None
    return best, again, ""


def _weighed(problem, budget, null, found, fits, failures, settings, base):
    closest = min([null, *fits.values()], key=lambda f: f.chi_square.sum())
    weights = tempering(closest.noises, closest.residuals)
    final = screen(null, found, weights, settings.draws, settings.seed)
    null_evidence = evidence(null, weights)
    evidences = {i: evidence(fit, weights) for i, fit in fits.items()}
    rough = screened(null_evidence.log_evidence, final.score, final.power)
    logs = [null_evidence.log_evidence] + [evidences[i].log_evidence if i in fits else rough[i]
                                           for i in range(len(found))]
    share = posterior(logs, cautious_prior(len(found)))
    held_out = held_out_gains(problem, budget, null, fits, share[1:])
    drifting = drift(null, weights, seed=settings.seed)
    weighed = [Weighed(found[i].candidate, fit, evidences[i], contender(
        null, null_evidence, found[i].candidate, fit, evidences[i], share[1 + i], final.p_value[i],
        held_out[i], weights, settings.rules)) for i, fit in fits.items()]
    weighed.sort(key=lambda w: -w.evidence.log_evidence)
    known = situation(problem, null, weights, drifting, settings.rules)
    decision = rulebook.decide(known, [w.contender for w in weighed], settings.rules)
    return Diagnosis(decision, problem.nominal, null, null_evidence, drifting, final, tuple(weighed), weights,
                     float(share[0]), failures, base)


def _leading(single, rules, count=2):
    """Refitted candidates worth taking as known: significant ones, best first."""
    good = [w for w in single.weighed if w.contender.p_value <= rules.p_value
            and w.contender.evidence_gain >= rules.evidence_gain and w.contender.unexplained < 0.5]
    if single.decision.verdict == "missing":
        return single.named[:1]
    return good[:count]
