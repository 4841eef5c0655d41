"""Evidence of all candidates, refitted or only screened, and the numbers that the rules see."""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.contract.errors import sentence_of
from pipeline.inference.decision.candidate_statistics import candidate_statistics, held_out_gains, run_statistics
from pipeline.inference.decision.decision_rules import CandidateStatistics, RunStatistics, decide
from pipeline.inference.decision.evidence import (
    Evidence,
    cautious_prior,
    evidence,
    family_wise,
    posterior,
    reached,
    screened,
)
from pipeline.inference.fitting.fit_state import Fit
from pipeline.inference.fitting.parameter_drift import Drift, drift
from pipeline.inference.problem import Hypothesis
from pipeline.inference.search.score_screen import Screen, screen


@dataclass(frozen=True)
class Evidences:
    """``null`` Evidence, that of the refitted candidates {index: Evidence}, and ``log_evidence`` (1 + candidates,).

    Of candidates that were only screened, log evidence is that of their ``screen``; all with ``weights`` (runs,), which
    are those of the best fit at hand.
    """

    null: Evidence
    refitted: dict
    log_evidence: np.ndarray
    screen: Screen
    weights: np.ndarray

    def overlooked(self, rules):
        """Indices of candidates that were not refitted, but promise about as much as the best of the others reached."""
        best = max(e.log_evidence for e in self.refitted.values())
        return [i for i in self.screen.order() if i not in self.refitted and self.screen.p_value[i] <= rules.p_value
                and self.log_evidence[1 + i] > best - rules.evidence_gain]


def evidence_of_all(null, directions, fits, settings, failed=()):
    """Evidences at the Fit ``null`` with Directions of all candidates and ``fits`` {index: Fit} of some.

    ``failed``: names of candidates that could not be judged.
    """
    weights = min([null, *fits.values()], key=lambda fit: fit.chi_square.sum()).weights
    scores = screen(null, directions, weights, settings.draws, settings.seed, settings.rules.screening)
    refitted = {i: (evidence if fit.converged else reached)(fit, weights) for i, fit in fits.items()}
    base = evidence(null, weights)
    unrefitted = np.where([d.candidate.name in failed for d in directions], -np.inf,
                          screened(base.log_evidence, scores.score, scores.power))
    logs = [refitted[i].log_evidence if i in fits else unrefitted[i] for i in range(len(directions))]
    return Evidences(base, refitted, np.array([base.log_evidence, *logs]), scores, weights)


@dataclass(frozen=True)
class Weighed:
    """A refitted candidate: its Fit, Evidence and the numbers that the rules see."""

    candidate: Hypothesis
    fit: Fit
    evidence: Evidence
    statistics: CandidateStatistics

    @property
    def refined(self):
        """The candidate, its time step halved as often as its Fit asked for."""
        return replace(self.candidate, halvings=self.fit.hypothesis.halvings or self.candidate.halvings)


@dataclass(frozen=True)
class Weighing:
    """Fourth step: the refitted candidates ``weighed`` (best first), what the runs say of the nominal model.

    ``posterior`` (1 + candidates,) of the nominal hypothesis, then of each screened candidate, 0 where one could not be
    judged; ``failures`` {candidate: why it was not judged, or not to the end}.
    """

    runs: RunStatistics
    weighed: tuple
    posterior: np.ndarray
    evidences: Evidences
    drift: Drift
    failures: dict

    def objected(self, reasons):
        """The same with ``reasons`` {name of a candidate: why its law is of another form} among what it breaks."""
        return replace(self, weighed=tuple(
            w if w.candidate.name not in reasons else replace(w, statistics=replace(
                w.statistics, varying=(*w.statistics.varying, reasons[w.candidate.name]))) for w in self.weighed))

    def decided(self, rules):
        """The Decision over these candidates by Rules."""
        return decide(self.runs, [w.statistics for w in self.weighed], rules.decision)


def weigh(refits, settings):
    """Weighing of the Refits of a screened catalogue; a candidate whose numbers cannot be computed is not judged."""
    problem, budget, null = refits.calibration.problem, refits.calibration.budget, refits.calibration.null
    fits = {i: r.fit for i, r in refits.results.items() if r.fit is not None}
    failures = {refits.directions[i].candidate.name: r.failure for i, r in refits.results.items() if r.failure}
    failures |= {d.candidate.name: d.failure for d in refits.directions if d.failure}
    evidences = evidence_of_all(null, refits.directions, fits, settings, failures)
    count, weights = len(refits.directions), evidences.weights
    counted = _without_mere_extensions(evidences.log_evidence, [d.candidate for d in refits.directions], fits,
                                       settings.rules.decision)
    probability = posterior(counted, cautious_prior(count))
    held_out = held_out_gains(problem, budget, null, fits, probability[1:], settings.rules)
    drifting = drift(null, weights, seed=settings.seed)

    def weighed(i, fit):
        candidate, own_evidence = refits.directions[i].candidate, evidences.refitted[i]
        p_value = family_wise(evidences.screen.p_value[i],
                              own_evidence.log_evidence - evidences.null.log_evidence, count)
        return Weighed(candidate, fit, own_evidence, candidate_statistics(
            null, evidences.null, candidate, fit, own_evidence, probability[1 + i], p_value, held_out[i], weights,
            settings.rules))

    judged, failed = [], {}
    for i, fit in fits.items():
        try:
            judged.append(weighed(i, fit))
        except Exception as error:
            failed[i] = refits.results[i]._replace(fit=None, failure=sentence_of(error))
    if failed:
        return weigh(replace(refits, results=refits.results | failed), settings)
    every = sorted(judged, key=lambda w: -w.evidence.log_evidence)
    runs = run_statistics(problem, budget, null, weights, drifting, settings.rules)
    return Weighing(runs, tuple(every), probability, evidences, drifting, failures)


def _without_mere_extensions(log_evidence, candidates, fits, rules):
    """Log evidence (1 + candidates,), -inf of those that extend a refitted one without a gain over it that matters.

    With another value or two a law fits as well as its limit does: that is no rival of it. What it adds must exceed
    chance, and, as a second law beside the limit, what numerics of that may be wrong by.
    """
    index, counted = {c.name: i for i, c in enumerate(candidates)}, log_evidence.copy()
    for i, candidate in enumerate(candidates):
        limits = [log_evidence[1 + index[name]] for name in candidate.extends if index.get(name) in fits]
        best = max(limits, default=-np.inf)
        if log_evidence[1 + i] < best + max(rules.evidence_gain, rules.second_at_noise * (best - log_evidence[0])):
            counted[1 + i] = -np.inf
    return counted
