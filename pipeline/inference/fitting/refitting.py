"""Refits of candidates: from where each begins, which ones go on, and when one is given up."""

from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np

from pipeline.contract.errors import BrakechainError
from pipeline.inference.decision.candidate_statistics import EXCLUDED, excluded
from pipeline.inference.fitting import tone_starts
from pipeline.inference.fitting.calibration import begun, paired_anew
from pipeline.inference.fitting.effective_sample_size import tempering
from pipeline.inference.fitting.least_squares import Fit, continued, far, linearised, of_features
from pipeline.inference.search.score_screen import directions, own_name, screen

#: iterations of a nominal model from a candidate's optimum before it is given up where it is still worse than before
_GIVEN_UP = 16
#: units of log evidence of the best candidate within which others must be able to come, else they are given up
_NEAR = 20.0
#: share of the best one's squared score, at the nominal values it asks for, from which another could be in its place
_RIVAL = 0.25
#: times that a better one found in this way is asked again
_ROUNDS = 2


class Refitted(NamedTuple):
    """``fit`` of a candidate or None, a better Fit of the ``null`` from its optimum or None, what went wrong."""

    fit: Fit | None
    null: Fit | None
    told: str


@dataclass(frozen=True)
class Refits:
    """Fits of the ``catalogue`` (candidate, ...) beside the Fit ``null`` of the nominal hypothesis of a problem."""

    problem: object
    null: object
    catalogue: tuple
    settings: object
    fan_out: object

    def of(self, chosen, starts, before=None):
        """{index: Refitted} of what was found ``before`` and of the candidates ``chosen``, begun at latent ``starts``.

        All begin; the best few go on, first the best of them, as the others have to come near it.
        """
        begin = partial(_begun, self.problem, self.null, self.settings.starts)
        items = [(self.catalogue[i], starts[i]) for i in chosen]
        return self._ended(chosen, self.fan_out(begin, items), before or {})

    def from_best(self, results):
        """{index: Refitted} once others have begun at the nominal values that the best of ``results`` asks for.

        A nominal model that has to make up for what is missing is off its true values, and what moves as the best
        candidate does may score little beside it.
        """
        for _ in range(_ROUNDS):
            top = _best(results)
            if top is None or not self._explains(results[top].fit):
                break
            results = self._beside(top, results)
            if _best(results) == top:
                break
        return results

    def better(self, results, starts):
        """{index: Refitted} with fits begun at the latent values ``starts`` {index: (k,)}, where they are better."""
        tried = [(i, *_tried(self.problem, self.null, self.catalogue[i], [start], ())) for i, start in starts.items()]
        finished = {i: _finished(self.problem, self.null, np.inf, state) for i, state, _ in tried if state is not None}
        return _lowest(results, finished)

    def _explains(self, fit):
        gained = tempering(fit.noises, fit.residuals).max() * fit.betters(self.null)
        return gained > 2 * self.settings.rules.evidence_gain

    def _beside(self, top, results):
        """Results with those of the rivals of candidate ``top``, where they are better."""
        size, fit = len(self.null.latent), results[top].fit
        anchor = linearised(self.problem, self.null.noises, self.problem.nominal, fit.latent[:size], self.null.runs)
        like = {own_name(p): fit.values[p.name] for p in fit.hypothesis.parameters[size:]}
        look = partial(directions, self.problem, anchor, like=like)
        seen = screen(anchor, list(self.fan_out(look, self.catalogue)), draws=0)
        rivals = [i for i in seen.order() if i != top and seen.score[i] > 0
                  and seen.score[i]**2 >= _RIVAL * seen.score[top]**2][:self.settings.kept]
        begin = partial(_begun_at, self.problem, anchor)
        ended = self._ended(rivals, self.fan_out(begin, [(self.catalogue[i], seen.start[i]) for i in rivals]),
                            {top: results[top]})
        return _lowest(results, ended)

    def _ended(self, chosen, begins, before):
        """{index: Refitted} of ``before`` and of candidates with their [(Fit or None, what went wrong)] of a begin."""
        first = dict(zip(chosen, begins, strict=True))
        failed = {i: Refitted(None, None, failure) for i, (state, failure) in first.items() if state is None}
        ended = {**before, **failed}
        states = {i: state for i, (state, _) in first.items() if state is not None}
        best = sorted(states, key=lambda i: states[i].objective)[:self.settings.kept]
        for group in (best[:1], best[1:]):
            finish = partial(_finished, self.problem, self.null, _enough(ended.values()))
            ended = {**ended, **dict(zip(group, self.fan_out(finish, [states[i] for i in group]), strict=True))}
        return ended


def at_odds(null):
    """Whether samples pull the null to values at odds with their priors: then its linearisation ranks nothing."""
    return bool(excluded(null, EXCLUDED)) and not of_features(null.noises)


def _misled(null):
    """Whether nothing near the null's optimum helps: values at odds with their priors, features paired wrongly."""
    return bool(excluded(null, EXCLUDED)) or (of_features(null.noises) and far(null))


def _best(results):
    """Index of the lowest objective, or None."""
    fits = {i: r.fit.objective for i, r in results.items() if r.fit is not None}
    return min(fits, key=fits.get, default=None)


def _lowest(results, indices):
    """{index: Refitted} of both, each of the lower objective."""
    def lower(fit, other):
        return fit is not None and (other is None or fit.objective < other.objective)

    return {**results, **{i: r for i, r in indices.items() if i not in results or lower(r.fit, results[i].fit)}}


def _begun(problem, null, offsets, item):
    """(Fit of a candidate after a few iterations or None, why there is none)."""
    candidate, screened_start = item
    misled = _misled(null)
    starts = _starts(problem.nominal.nominal if misled else null.latent, [
        screened_start, *(np.full(len(candidate.parameters), offset) for offset in offsets)])
    starts += _starts(null.latent, [screened_start] * at_odds(null) + tone_starts.starts(problem, null, candidate))
    return _tried(problem, null, candidate, starts, () if misled else null.jacobians)


def _begun_at(problem, anchor, item):
    """The same from the nominal values of the Fit ``anchor`` alone."""
    candidate, start = item
    starts = _starts(anchor.latent, [start, *tone_starts.starts(problem, anchor, candidate)])
    return _tried(problem, anchor, candidate, starts, anchor.jacobians)


def _starts(base, begins):
    """Latent values of a candidate beside nominal ones ``base``, from those of its own effect, none of them far out."""
    return [np.concatenate((base, np.clip(begin, -2, 2))) for begin in begins]


def _tried(problem, null, candidate, starts, known):
    try:
        return begun(problem, null.noises, problem.nominal.joined(candidate), starts, null.runs, known), ""
    except BrakechainError as error:
        return None, str(error)


def _enough(results):
    """The objective to which a candidate must be able to come down: near the best so far, as evidence is tempered."""
    best = min((r.fit for r in results if r.fit is not None), key=lambda f: f.objective, default=None)
    if best is None:
        return np.inf
    return best.objective + _NEAR / tempering(best.noises, best.residuals).max()


def _finished(problem, null, enough, state):
    """Refitted of a candidate that has begun; where its forward model fails on the way, of its begin."""
    try:
        best = state if state.converged else continued(problem, state, enough=enough, patient=False)
        best = paired_anew(problem, best)
    except BrakechainError as error:
        return Refitted(state, None, str(error))
    if not best.converged and best.objective > enough:
        return Refitted(best, None, "its fit was given up, far from what others reach")
    failure = "" if best.converged else f"its fit had not converged after {best.evaluations} predictions"
    return Refitted(best, _null_again(problem, null, best), failure)


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
