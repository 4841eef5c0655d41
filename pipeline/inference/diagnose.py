"""The course of a diagnosis: recalibrate, screen, refit, weigh, verify, decide; pairs by greedy addition.

Where the nominal model is pulled to values at odds with their priors, its linearisation ranks nothing: there every
candidate begins its fit, and the best few go on.
A null hypothesis that has not converged lets every candidate win: it is refitted from each candidate's optimum. A model
that lacks physics may have no smooth optimum at all: then a candidate counts only where it goes far below the null.
"""

from dataclasses import dataclass
from functools import partial

import numpy as np

from pipeline.contract.errors import BrakechainError, ConvergenceError
from pipeline.inference import decide as rulebook
from pipeline.inference.calibrate import begun, calibrate
from pipeline.inference.drift import drift
from pipeline.inference.effective import tempering
from pipeline.inference.evidence import cautious_prior, evidence, posterior, reached, screened
from pipeline.inference.least_squares import continued, far, linearised, of_features
from pipeline.inference.screen import directions, screen
from pipeline.inference.weigh import EXCLUDED, contender, excluded, held_out_gains, situation

#: iterations of a nominal model from a candidate's optimum before it is given up where it is still worse than before
_GIVEN_UP = 16
#: units of log evidence of the best candidate within which others must be able to come, else they are given up
_NEAR = 50.0
#: where the linearisation of the null holds, scores that chance reaches more often than this are not looked into
_LIKELY = 0.5


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

    ``nominal`` is the hypothesis taken as known; ``posterior`` (1 + candidates,) of its sufficing, then of each
    screened candidate, 0 where one could not be judged; ``base`` the Diagnosis that came before a pair; ``failures``
    {candidate: why it was not judged, or not to the end}.
    """

    decision: rulebook.Decision
    nominal: object
    null: object
    null_evidence: object
    drift: object
    screen: object
    weighed: tuple
    weights: np.ndarray
    posterior: np.ndarray
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
    leading ones that can be fitted are tried by the same rules, the first taken as known. Raises ConvergenceError where
    the nominal model has no fit.
    """
    settings = settings or Settings()
    single = _one_step(problem, budget, catalogue, settings, fan_out)
    if single.decision.verdict not in ("unknown", "missing") or len(problem.runs) < 2:
        return single
    for first in _leading(single, settings.rules):
        rest = [c for c in catalogue if c.name != first.candidate.name]
        try:
            pair = _one_step(problem.given(first.candidate), budget, rest, settings, fan_out, first.fit, single)
        except ConvergenceError:
            continue
        if pair.decision.verdict in ("missing", "sensor", "numerics"):
            return pair
    return single


def _one_step(problem, budget, catalogue, settings, fan_out, start=None, base=None):
    runs, hypothesis = problem.training, problem.nominal
    noises = tuple(budget[run.name] for run in runs)
    null = start if start and start.converged else calibrate(
        problem, noises, hypothesis, [start.latent if start else hypothesis.nominal], runs, settled=False)
    found = list(fan_out(partial(directions, problem, null), catalogue))
    rough = screen(null, found, None, settings.draws, settings.seed)
    largest = _hopeful(null, settings.rules) if base is None else settings.rules.p_value
    hopeful = [i for i in rough.order() if np.isfinite(rough.score[i]) and rough.p_value[i] <= largest]

    def refit(chosen, before):
        begin = partial(_begun, problem, noises, null, settings.starts)
        first = dict(zip(chosen, fan_out(begin, [(catalogue[i], rough.start[i]) for i in chosen]), strict=True))
        ended = {i: (None, None, told) for i, (state, told) in first.items() if state is None}
        states = {i: state for i, (state, _) in first.items() if state is not None}
        best = sorted(states, key=lambda i: states[i].objective)[:settings.kept]
        for group in (best[:1], best[1:]):
            finish = partial(_finished, problem, null, _enough([*before, *ended.values()]))
            ended |= zip(group, fan_out(finish, [states[i] for i in group]), strict=True)
        return ended

    results = refit(hopeful if _at_odds(null) else hopeful[:settings.kept], ())
    results |= refit(_overlooked(null, found, results, settings), results.values())
    better = min([null, *(r[1] for r in results.values() if r[1] is not None)], key=lambda f: f.objective)
    if better.objective < null.objective - 0.1:
        null = better
        found = list(fan_out(partial(directions, problem, null), catalogue))
    fits = {i: r[0] for i, r in results.items() if r[0] is not None}
    failures = {catalogue[i].name: r[2] for i, r in results.items() if r[2]}
    failures |= {f.candidate.name: f.failure for f in found if f.failure}
    return _weighed(problem, budget, null, found, fits, failures, settings, base)


def _hopeful(null, rules):
    """Largest p-value of the screen at which a first effect is refitted: any, where the null's linearisation may fail.

    It holds where the null reaches the noise; of features, which are few and far from linear only where they are
    paired anew, wherever the null has an optimum.
    """
    reached = null.chi_square.sum() <= (1 + rules.noise_uncertainty) * null.counts.sum()
    return _LIKELY if reached or (of_features(null.noises) and null.converged) else 1.0


def _begun(problem, noises, null, offsets, item):
    """(Fit of a candidate after a few iterations or None, why there is none)."""
    candidate, screened_start = item
    begins = [screened_start] + [np.full(len(candidate.parameters), offset) for offset in offsets]
    bases = [null.latent] * len(begins)
    if misled := _misled(null):
        bases = [problem.nominal.nominal] * len(begins)
    if _at_odds(null):
        bases.append(null.latent)
        begins.append(screened_start)
    starts = [np.concatenate((base, np.clip(begin, -2, 2))) for base, begin in zip(bases, begins, strict=True)]
    known = () if misled else null.jacobians
    try:
        return begun(problem, noises, problem.nominal.joined(candidate), starts, null.runs, known), ""
    except BrakechainError as error:
        return None, str(error)


def _misled(null):
    """Whether nothing near the null's optimum helps: values at odds with their priors, features paired wrongly."""
    return bool(excluded(null, EXCLUDED)) or (of_features(null.noises) and far(null))


def _at_odds(null):
    """Whether samples pull the null to values at odds with their priors: then its linearisation ranks nothing."""
    return bool(excluded(null, EXCLUDED)) and not of_features(null.noises)


def _enough(results):
    """The objective to which a candidate must be able to come down: near the best so far, as evidence is tempered."""
    fits = [fit for fit, _, _ in results if fit is not None]
    best = min(fits, key=lambda f: f.objective, default=None)
    if best is None:
        return np.inf
    return best.objective + _NEAR / tempering(best.noises, best.residuals).max()


def _finished(problem, null, enough, state):
    """(Fit of a candidate, a better Fit of the null from its optimum or None, what went wrong)."""
    best = state if state.converged else continued(problem, state, enough=enough, patient=False)
    if not best.converged and best.objective > enough:
        return best, None, "its fit was given up, far from what others reach"
    told = "" if best.converged else f"its fit had not converged after {best.evaluations} predictions"
    return best, _null_again(problem, null, best), told


def _null_again(problem, null, best):
    """A better Fit of the nominal model, found from the optimum of a candidate that fits better than it, or None."""
    if best.objective > null.objective - 1:
        return None
    size = len(null.latent)
    try:
        again = linearised(problem, null.noises, problem.nominal, best.latent[:size], null.runs,
                           [j[:, :size] for j in best.jacobians])
        again = continued(problem, again, _GIVEN_UP, null.objective, patient=False)
    except BrakechainError:
        return None
    if again.objective >= null.objective:
        return None
    return again if again.converged else continued(problem, again, patient=False)


def _overlooked(null, found, results, settings):
    """Indices of candidates that were not refitted, but promise about as much as the best of the others reached."""
    fits = {i: r[0] for i, r in results.items() if r[0] is not None}
    if not fits:
        return []
    logs, evidences, final, _ = _evidences(null, found, fits, settings)
    best = max(e.log_evidence for e in evidences.values())
    near = [i for i in final.order() if i not in results and final.p_value[i] <= settings.rules.p_value
            and logs[1 + i] > best - settings.rules.evidence_gain]
    return near[:settings.kept]


def _evidences(null, found, fits, settings, failed=()):
    """(ln Z of the null and every candidate, {index: Evidence} of the refitted ones, their Screen, runs' weights)."""
    closest = min([null, *fits.values()], key=lambda f: f.chi_square.sum())
    weights = tempering(closest.noises, closest.residuals)
    final = screen(null, found, weights, settings.draws, settings.seed)
    evidences = {i: (evidence if own.converged else reached)(own, weights) for i, own in fits.items()}
    base = evidence(null, weights).log_evidence
    rough = np.where([f.candidate.name in failed for f in found], -np.inf, screened(base, final.score, final.power))
    logs = [base] + [evidences[i].log_evidence if i in fits else rough[i] for i in range(len(found))]
    return np.array(logs), evidences, final, weights


def _weighed(problem, budget, null, found, fits, failures, settings, base):
    logs, evidences, final, weights = _evidences(null, found, fits, settings, failures)
    null_evidence = evidence(null, weights)
    share = posterior(logs, cautious_prior(len(found)))
    held_out = held_out_gains(problem, budget, null, fits, share[1:])
    drifting = drift(null, weights, seed=settings.seed)
    weighed = [Weighed(found[i].candidate, fit, evidences[i], contender(
        null, null_evidence, found[i].candidate, fit, evidences[i], share[1 + i], final.p_value[i],
        held_out[i], weights, settings.rules)) for i, fit in fits.items()]
    weighed.sort(key=lambda w: -w.evidence.log_evidence)
    known = situation(problem, null, weights, drifting, settings.rules)
    decision = rulebook.decide(known, [w.contender for w in weighed], settings.rules)
    if not null.converged and decision.verdict in ("consistent", "parameters"):
        raise ConvergenceError(f"calibration of {problem.nominal.name}", "a fit that converges",
                               f"none after {null.evaluations} predictions", "check the nominal values and priors")
    return Diagnosis(decision, problem.nominal, null, null_evidence, drifting, final, tuple(weighed), weights,
                     share, failures, base)


def _leading(single, rules, count=2):
    """Refitted candidates worth taking as known: significant ones, best first."""
    good = [w for w in single.weighed if w.contender.p_value <= rules.p_value
            and w.contender.evidence_gain >= rules.evidence_gain and w.contender.unexplained < 0.5
            and not w.contender.doubts]
    if single.decision.verdict == "missing":
        return single.named[:1]
    return good[:count]
