"""The course of a diagnosis: recalibrate, screen, refit, weigh, verify, decide; pairs by greedy addition.

Where the nominal model does not reach the noise, its linearisation may rank nothing: there every candidate begins its
fit unless one of the first few explains enough, and the best few go on. What else could move as the best one does is
looked for at the nominal values that the best one asks for.
A null hypothesis that has not converged lets every candidate win: it is refitted from each candidate's optimum. A model
that lacks physics may have no smooth optimum at all: then a candidate counts only where it goes far below the null.
"""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from pipeline.contract.errors import ConvergenceError
from pipeline.inference.decision import decision_rules as rulebook
from pipeline.inference.decision.candidate_statistics import (
    EXCLUDED,
    contender,
    excluded,
    held_out_gains,
    reaches_noise,
    situation,
    unexplained,
    unfinished,
)
from pipeline.inference.decision.evidence import cautious_prior, evidence, family_wise, posterior, reached, screened
from pipeline.inference.fitting.calibration import calibrate
from pipeline.inference.fitting.effective_sample_size import doubt, tempering
from pipeline.inference.fitting.least_squares import of_features
from pipeline.inference.fitting.parameter_drift import drift
from pipeline.inference.fitting.refitting import Refits
from pipeline.inference.search.score_screen import directions, screen

#: where the linearisation of the null holds, scores that chance reaches more often than this are not looked into
_LIKELY = 0.1
#: share of what the best first effect explains from which another may be the first of a pair, too
_AS_MUCH = 0.9
#: verdicts that name something
_NAMED = ("missing", "sensor", "numerics")


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

    A second effect is refitted only where its score is significant beside the first, or the first leaves more than
    noise, and named only where it explains a share of what the first explains that the law of the first cannot be wrong
    by; less, where both reach the noise.

    ``fan_out(function, items)`` maps as the builtin does. Where one effect is not enough, pairs with each of the
    leading ones that can be fitted are tried by the same rules, the first taken as known. Raises ConvergenceError where
    the nominal model has no fit.
    """
    settings = settings or Settings()
    course = _course(problem, budget, catalogue, settings, fan_out)
    single = _weighed(course)
    if single.decision.verdict not in ("unknown", "missing") or len(problem.runs) < 2:
        return single
    for first in _leading(single, settings.rules):
        explained = first.fit.betters(single.null)
        if not _asks_for_more(first.fit, explained, settings.rules):
            continue
        rest = [c for c in catalogue if c.name != first.candidate.name]
        try:
            pair = _weighed(_course(problem.given(first.candidate), budget, rest, settings, fan_out, first.fit, single))
        except ConvergenceError:
            continue
        if pair.decision.verdict in _NAMED and _material(pair, explained, settings.rules):
            alone = _weighed(_dropping(course, first, pair))
            return alone if alone.decision.verdict in _NAMED and _evident(alone, pair) > _evident(pair, pair) else pair
    return single


@dataclass(frozen=True)
class _Course:
    """What one step of a diagnosis has found: the ``null`` Fit, Directions ``found`` and {index: Refitted}."""

    problem: object
    budget: dict
    refits: Refits
    found: list
    results: dict
    base: Diagnosis | None

    @property
    def null(self):
        return self.refits.null


def _course(problem, budget, catalogue, settings, fan_out, start=None, base=None):
    runs, hypothesis = problem.training, problem.nominal
    noises = tuple(budget[run.name] for run in runs)
    null = start if start and start.converged else calibrate(
        problem, noises, hypothesis, [start.latent if start else hypothesis.nominal], runs, settled=False)
    projections = list(fan_out(partial(directions, problem, null), catalogue))
    rough = screen(null, projections, None, settings.draws, settings.seed)
    largest = _hopeful(null, settings.rules, settings.rules.p_value if base else _LIKELY)
    hopeful = [i for i in rough.order() if np.isfinite(rough.score[i]) and rough.p_value[i] <= largest]
    refits = Refits(problem, null, tuple(catalogue), settings, fan_out)
    results = _best_refits(refits, hopeful, rough.start)
    results = refits.of(_overlooked(null, projections, results, settings), rough.start, results)
    better = min([null, *(r.null for r in results.values() if r.null is not None)], key=lambda f: f.objective)
    if better.objective < null.objective - 0.1:
        refits = replace(refits, null=better)
        projections = list(fan_out(partial(directions, problem, better), catalogue))
    return _Course(problem, budget, refits, projections, results, base)


def _material(pair, explained, rules):
    """Whether a ``pair`` names a second effect that is more than an error of the first, which ``explained`` so much.

    A wrong law of the first is seldom made good down to the noise, on runs that were not fitted too: what does that may
    be smaller, or give nominal values back to their priors.
    """
    odd = len(excluded(pair.null, EXCLUDED))

    def is_more(name):
        gained = name.fit.betters(pair.null)
        if reaches_noise(name.fit, rules) and not name.contender.held_out_left:
            return gained >= rules.second_at_noise * explained or len(excluded(name.fit, EXCLUDED)) < odd
        return gained >= rules.second_share * explained

    return any(is_more(name) for name in pair.named)


def _asks_for_more(fit, explained, rules):
    """Whether a second effect may be material beside a first, whose Fit ``explained`` so much of the objective.

    What the first leaves above the noise is as uncertain as the noise is; values at odds with their priors make up for
    something.
    """
    counts = fit.counts.sum()
    room = fit.objective - counts + doubt(counts, rules.noise_uncertainty)
    return room >= rules.second_at_noise * explained or bool(excluded(fit, EXCLUDED))


def _evident(diagnosis, weighing):
    """Log evidence of what a Diagnosis names, with the weights of the runs of another."""
    return max(evidence(w.fit, weighing.weights).log_evidence for w in diagnosis.named)


def _dropping(course, first, pair):
    """The course with fits of what ``pair`` names, begun at its values, but without the ``first`` effect.

    Greedy addition may begin with an effect that is not needed once the other one is there.
    """
    size, before = len(course.null.latent), len(first.fit.latent)
    starts = {i: np.concatenate((w.fit.latent[:size], w.fit.latent[before:])) for w in pair.named
              for i, c in enumerate(course.refits.catalogue) if c.name == w.candidate.name}
    return replace(course, results=course.refits.better(course.results, starts))


def _best_refits(refits, hopeful, starts):
    """{index: Refitted}: the best few of the screen and their rivals, else all of them."""
    kept, rules = refits.settings.kept, refits.settings.rules
    results = refits.from_best(refits.of(hopeful[:kept], starts))
    fits = [r.fit for r in results.values() if r.fit]
    enough = any(unexplained(refits.null, fit, rules) <= rules.unexplained for fit in fits)
    if enough or reaches_noise(refits.null, rules) or of_features(refits.null.noises):
        return results
    return refits.from_best(refits.of(hopeful[kept:], starts, results))


def _hopeful(null, rules, likely):
    """Largest p-value of the screen at which a candidate is refitted: any, where the null's linearisation may fail.

    It holds where the null reaches the noise; of features, which are few and far from linear only where they are
    paired anew, wherever the null has an optimum.
    """
    return likely if reaches_noise(null, rules) or (of_features(null.noises) and null.converged) else 1.0


def _overlooked(null, projections, results, settings):
    """Indices of candidates that were not refitted, but promise about as much as the best of the others reached."""
    fits = {i: r.fit for i, r in results.items() if r.fit is not None}
    if not fits:
        return []
    logs, evidences, final, _ = _evidences(null, projections, fits, settings)
    best = max(e.log_evidence for e in evidences.values())
    near = [i for i in final.order() if i not in results and final.p_value[i] <= settings.rules.p_value
            and logs[1 + i] > best - settings.rules.evidence_gain]
    return near[:settings.kept]


def _evidences(null, projections, fits, settings, failed=()):
    """(ln Z of the null and every candidate, {index: Evidence} of the refitted ones, their Screen, runs' weights)."""
    closest = min([null, *fits.values()], key=lambda f: f.chi_square.sum())
    weights = tempering(closest.noises, closest.residuals)
    final = screen(null, projections, weights, settings.draws, settings.seed)
    evidences = {i: (evidence if fit.converged else reached)(fit, weights) for i, fit in fits.items()}
    base = evidence(null, weights).log_evidence
    rough = np.where([p.candidate.name in failed for p in projections], -np.inf,
                     screened(base, final.score, final.power))
    logs = [base] + [evidences[i].log_evidence if i in fits else rough[i] for i in range(len(projections))]
    return np.array(logs), evidences, final, weights


def _weighed(course):
    """Diagnosis of a _Course by the rules."""
    null, projections, settings, problem = course.null, course.found, course.refits.settings, course.problem
    fits = {i: r.fit for i, r in course.results.items() if r.fit is not None}
    failures = {projections[i].candidate.name: r.told for i, r in course.results.items() if r.told}
    failures |= {f.candidate.name: f.failure for f in projections if f.failure}
    logs, evidences, final, weights = _evidences(null, projections, fits, settings, failures)
    null_evidence = evidence(null, weights)
    share = posterior(logs, cautious_prior(len(projections)))
    held_out = held_out_gains(problem, course.budget, null, fits, share[1:])
    drifting = drift(null, weights, seed=settings.seed)
    weighed = [Weighed(projections[i].candidate, fit, evidences[i], contender(
        null, null_evidence, projections[i].candidate, fit, evidences[i], share[1 + i],
        family_wise(final.p_value[i], evidences[i].log_evidence - null_evidence.log_evidence, len(projections)),
        held_out[i], weights, settings.rules)) for i, fit in fits.items()]
    weighed.sort(key=lambda w: -w.evidence.log_evidence)
    known = situation(problem, course.budget, null, weights, drifting, settings.rules)
    decision = rulebook.decide(known, [w.contender for w in weighed], settings.rules)
    if not null.converged and decision.verdict in ("consistent", "parameters"):
        raise ConvergenceError(f"calibration of {problem.nominal.name}", "a fit that converges",
                               f"none after {null.evaluations} predictions", "check the nominal values and priors")
    return Diagnosis(decision, problem.nominal, null, null_evidence, drifting, final, tuple(weighed), weights,
                     share, failures, course.base)


def _leading(single, rules, count=2):
    """Refitted candidates worth taking as known: significant ones, best first, another only if it explains as much."""
    if single.decision.verdict == "missing":
        return single.named[:1]
    good = [w for w in single.weighed if w.contender.p_value <= rules.p_value
            and w.contender.evidence_gain >= rules.evidence_gain and w.contender.unexplained < 0.5
            and not unfinished(w.fit, single.null)]
    explained = [w.fit.betters(single.null) for w in good]
    enough = _AS_MUCH * max(explained, default=0.0)
    return [w for w, explanation in zip(good[:count], explained, strict=False) if explanation >= enough]
