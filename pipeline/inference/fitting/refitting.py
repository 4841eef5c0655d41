"""Refits of candidates: from where each begins, which ones go on, and when one is given up."""

from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any

import numpy as np

from pipeline.contract.errors import BrakechainError
from pipeline.inference.decision.candidate_statistics import unexplained
from pipeline.inference.decision.weighing import evidence_of_all
from pipeline.inference.fitting.begins import as_limit, begun_at, begun_beside, directions_like, tried
from pipeline.inference.fitting.calibration import ahead_of
from pipeline.inference.fitting.fit_state import Fit, linearised, nominal_p
from pipeline.inference.fitting.least_squares import again, beside
from pipeline.inference.fitting.refitted import (
    NOT_BEGUN,
    OVERTAKEN,
    Refits,
    Refitted,
    advanced,
    finished,
    leader,
    lowest,
)
from pipeline.inference.fitting.step_error import refined
from pipeline.inference.fitting.widening import TIMES, widened
from pipeline.inference.problem import FanOut, Problem
from pipeline.inference.rules import Rules
from pipeline.inference.search.score_screen import directions, least, rescreened, reshaped, screen, short_name
from pipeline.inference.time_budget import TimeSpentError, spent

#: times that a better candidate found beside the best one is taken for the best
_ROUNDS = 4
#: iterations of a fit that begins near its optimum
_NEARBY = 10
#: share of the noise power beyond it within which a nominal model nearly reaches the noise
_NEARLY = 1.0
#: standard deviations of its prior beyond which a value is one of those that are unlikely together
_FAR_OUT = 2.0
#: candidates beside a first effect that begin, over the number of those that go on
_LIKELY = 4


def refit_catalogue(screening, catalogue, settings, fan_out, earlier=None, beside_a_first=False, bound=np.inf):
    """Refits of the promising candidates of a Screening, of their imitators, and of what they overlook, beside those of
    ``earlier`` Refits of the first of the ``catalogue``; of those alone that can come down to an objective ``bound``.
    """
    calibration, starts = screening.calibration, screening.screen.start
    refitter, results = Refitter.about(calibration, catalogue, settings, fan_out, bound), earlier and earlier.results
    if results and refitter.explained(results):     # what may do as well begins at the values that the best asks for
        results = refitter.with_imitators(results, starts, len(earlier.directions))
    else:
        results = refitter.best_of(screening, results or {}, beside_a_first)
    if not refitter.overtaken(results):
        results = refitter.settled(refitter.with_overlooked(screening, results))
        refitter, screening, results = refitter.widened(screening, results)
    better = calibration.improved([r.null for r in results.values()], settings.rules.calibration)
    if better is calibration:
        return Refits(calibration, screening.directions, results, refitter)
    refitter = replace(refitter, null=better.null)
    again = tuple(fan_out(partial(directions, better.problem, better.null), refitter.catalogue))
    return Refits(better, again, results, refitter)


def brought_on(screening, catalogue, begins, settings, fan_out):
    """Refits of candidates whose fits ``begins`` {index: (Fit or None, why there is none)} begin near their ends, and
    of what outshines them."""
    refitter = Refitter.about(screening.calibration, catalogue, settings, fan_out)
    results = refitter.brought_on(begins)
    return Refits(screening.calibration, screening.directions, refitter.with_overlooked(screening, results), refitter)


def refit_from(screening, catalogue, results, settings, fan_out):
    """Refits of the candidates that have ``results`` {index: Refitted} alone, of what outshines them, and, where they
    explain enough, of what moves as they do."""
    refitter = Refitter.about(screening.calibration, catalogue, settings, fan_out)
    results = refitter.with_overlooked(screening, results)
    if refitter.explained(results):
        results = refitter.with_imitators(results, screening.screen.start)
    return Refits(screening.calibration, screening.directions, refitter.settled(results), refitter)


@dataclass(frozen=True)
class Refitter:
    """Fits candidates of a ``catalogue`` (Hypothesis, ...) beside the Fit ``null`` of the nominal hypothesis, by the
    ``settings`` of ``procedure``; fits are given up that cannot come down to the objective ``bound``."""

    problem: Problem
    null: Fit
    catalogue: tuple
    settings: Any
    fan_out: FanOut
    bound: float = np.inf

    @classmethod
    def about(cls, calibration, catalogue, settings, fan_out, bound=np.inf):
        """Refitter beside the null of a Calibration."""
        return cls(calibration.problem, calibration.null, tuple(catalogue), settings, fan_out, bound)

    @property
    def rules(self) -> Rules:
        return self.settings.rules

    def best_of(self, screening, results, beside_a_first=False):
        """{index: Refitted} of ``results``, the best few of those that a Screening promises and their imitators, else
        all of them.

        Where the first explains enough, others begin only if they may come near it. All begin only where the
        linearisation of the null may fail and none of the first few explains enough;
        ``beside_a_first`` effect, which has taken up what is far from linear, the likely ones.
        """
        kept, rules, starts = self.settings.kept, self.rules.decision, screening.screen.start
        promising = screening.hopeful(self.bound)
        results, others = self.of(promising[:1], starts, results), promising[1:kept]
        if self.explained(results):
            near = screening.hopeful(self._enough(results.values()))
            others = [i for i in others if i in near]
        results = self.of(others, starts, results)
        if self.overtaken(results):
            return results
        results = self._rivalled(results, starts, beside_a_first)
        if self.explained(results) or self.null.reaches_noise(rules.noise_uncertainty) or self.null.unordered:
            return results
        further = promising[kept:_LIKELY * kept] if beside_a_first else promising[kept:]
        best, found = leader(results), self.of(further, starts, results)
        if best is not None and leader(found) == best and found[best].fit is results[best].fit:
            return found        # its imitators have begun
        return self._rivalled(found, starts, beside_a_first)

    def overtaken(self, results):
        """Whether the null was at a wrong optimum: from that of a candidate in ``results`` it comes down far below."""
        return any(r.null is not None and r.null.objective < OVERTAKEN * self.null.objective
                   for r in results.values())

    def _rivalled(self, results, starts, beside_a_first):
        """{index: Refitted} with imitators; beside a first effect only where one may be named."""
        if beside_a_first and not self.explained(results):
            return results
        return self.with_imitators(results, starts)

    def explained(self, results):
        """Whether one of the ``results`` explains enough, without values at odds with their priors."""
        return any(not r.fit.excluded(self.rules.calibration.excluded)
                   and unexplained(self.null, r.fit, self.rules) <= self.rules.decision.unexplained
                   for r in results.values() if r.fit)

    def of(self, chosen, starts, results=None):
        """{index: Refitted} of ``results`` and of the candidates ``chosen``, begun at latent ``starts``.

        All begin; the best few go on, first the best of them, as the others have to come near it.
        """
        if not len(chosen):
            return results or {}
        begin = partial(begun_beside, self.problem, self.null, self.anchor, self.ahead, self.settings.starts,
                        enough=self.bound)
        items = [(self.catalogue[i], starts[i]) for i in chosen]
        return self._ended(chosen, self.fan_out(begin, items), results or {})

    @cached_property
    def anchor(self):
        """The Fit beside which candidates begin: the null, or, where that misleads, what it is with those values as
        they were that its priors exclude, or that are unlikely together."""
        null, nominal, unlikely = self.null, self.problem.nominal, self._unlikely_at_noise
        if not (unlikely or _misled(null, self.rules.calibration)):
            return null
        pulled = abs(null.latent) > (_FAR_OUT if unlikely else self.rules.calibration.excluded)
        try:
            state = linearised(self.problem, null.noises, nominal,
                               np.where(pulled | null.unordered, nominal.nominal, null.latent), null.runs)
            return beside(self.problem, state, pulled) if pulled.any() else state
        except BrakechainError:
            return null

    @cached_property
    def _unlikely_at_noise(self):
        """Whether the null nearly reaches the noise by values that are unlikely together."""
        unlikely = nominal_p(self.null, self.null.hypothesis) < self.rules.decision.nominal_p
        return unlikely and self.null.reaches_noise(_NEARLY)

    @cached_property
    def ahead(self):
        """Fits of the nominal hypothesis over rising horizons beside which candidates begin where the null is far off,
        or where its priors exclude it: motions that slipped past each other hold it there."""
        far = self.anchor.far or self.anchor is not self.null
        return ahead_of(self.problem, self.anchor) if far and not self.null.unordered else ()

    def with_overlooked(self, screening, results):
        """{index: Refitted} once those have begun that a Screening promised little of, and evidence may favour."""
        fits = {i: r.fit for i, r in results.items() if r.fit is not None}
        if not fits:
            return results
        evidences = evidence_of_all(self.null, screening.directions, fits, self.settings)
        return self.of(evidences.overlooked(self.rules.decision)[:self.settings.kept], screening.screen.start, results)

    def with_imitators(self, results, starts, looked_at=0):
        """{index: Refitted} once others have begun at the nominal values that the best of ``results`` asks for.

        A nominal model that has to make up for what is missing is off its true values, and what moves as the best
        candidate does may score little beside it. So many first ones of the catalogue were ``looked_at`` beside the
        best of them.
        """
        for _ in range(_ROUNDS):
            top = leader(results)
            if top is None or not self._explains(results[top].fit) or spent():
                break
            with suppress(TimeSpentError):
                seen = looked_at if top < looked_at else 0
                results = self._with_limits(top, self._beside(top, starts, results, seen))
            if leader(results) == top:
                break
            looked_at = 0
        return results

    def _with_limits(self, top, results):
        """Results with the limits of candidate ``top`` that come nowhere near it begun at its values: it may be one."""
        size, fit, whole = len(self.null.latent), results[top].fit, self.catalogue[top]
        far = [i for i, c in enumerate(self.catalogue)
               if c.name in whole.extends and self._short_of(fit, results.get(i, NOT_BEGUN))]
        return self.better(results, {i: np.concatenate((
            fit.latent[:size], as_limit(self.catalogue[i], whole, fit.latent[size:]))) for i in far})

    def better(self, results, starts, enough=np.inf):
        """{index: Refitted} with fits begun at the latent values ``starts`` {index: (k,)}, where they are better; those
        are given up that do not come down to ``enough``."""
        return self.best_begun(results, {i: [start] for i, start in starts.items()}, enough)

    def best_begun(self, results, starts, enough=np.inf):
        """The same from the best of several latent values each, ``starts`` {index: [(k,)]}."""
        begins = {i: tried(self.problem, self.null, self.catalogue[i], each, ())[0]
                  for i, each in starts.items() if each}
        return lowest(results, {i: finished(self.problem, self.null, enough, self.rules, begin)
                                 for i, begin in begins.items() if begin is not None})

    def settled(self, results):
        """{index: Refitted} once the best fit has come down to the noise or to a strict optimum, if it can, and the
        step errors of the leading ones do not matter.

        Those lead that come within reach of the best, which explains more than chance. Far above the noise residuals
        count for little evidence, and fits end early: nothing may be named beside the best one for that.
        """
        for _ in range(self.rules.refit.restarts):
            top = leader(results)
            if top is None or not self._explains(results[top].fit) or self._at_its_end(results[top].fit):
                break
            before = results[top].fit
            with suppress(TimeSpentError):
                results = lowest(results, {top: finished(self.problem, self.null, np.inf, self.rules,
                                                         again(self.problem, before))})
            if results[top].fit is before:
                results = self._reshaped(top, results)
            if results[top].fit is before:
                break
        return self._refined(results)

    def widened(self, screening, results):
        """(Refitter, Screening, {index: Refitted}) once sizes have been tried under wider priors that end far out of
        theirs."""
        for _ in range(TIMES):
            wider = widened(self.catalogue, results, self.null, self.rules)
            if not wider:
                break
            screening = rescreened(screening, wider, self.settings, self.fan_out)
            self = replace(self, catalogue=tuple(wider.get(i, c) for i, c in enumerate(self.catalogue)))
            results = {i: r for i, r in results.items() if i not in wider}
            results = self.of(list(wider), screening.screen.start, results)
            if self.explained(results):
                results = self.with_imitators(results, screening.screen.start)
            results = self.settled(results)
        return self, screening, results

    def _refined(self, results):
        """Results with the leading ones at steps that are fine enough: first the best; then those within reach of it,
        or that what its step was wrong by keeps from there."""
        look, top = partial(refined, self.problem, self.rules.refit), leader(results)
        enough = self._enough(results.values())
        if top is not None and self._may_lead(results[top].fit, enough):
            finer = look(results[top].fit)
            enough += max(results[top].fit.objective - finer.objective, 0.0)
            results = results | {top: results[top]._replace(fit=finer)}
        leading = [i for i, r in results.items() if i != top and self._may_lead(r.fit, enough)]
        finer = self.fan_out(look, [results[i].fit for i in leading])
        return results | {i: results[i]._replace(fit=fit) for i, fit in zip(leading, finer, strict=True)}

    def _may_lead(self, fit, enough):
        return (fit is not None and not fit.unordered and fit.objective <= enough
                and fit.hypothesis.kind != "numerics" and self._explains(fit))

    def _reshaped(self, top, results):
        """Results with the candidate ``top`` begun in other shapes, as where few sliders slip one after the other."""
        size, fit = len(self.null.latent), results[top].fit
        others = reshaped(self.catalogue[top], fit.latent[size:])
        return self.best_begun(results, {top: [np.concatenate((fit.latent[:size], own)) for own in others]})

    def _at_its_end(self, fit):
        return fit.converged and (fit.strict or fit.unordered
                                  or fit.reaches_noise(self.rules.decision.noise_uncertainty))

    def _explains(self, fit):
        return fit.weights.max() * fit.betters(self.null) > 2 * self.rules.decision.evidence_gain

    def _beside(self, top, starts, results, seen=0):
        """Results with those of the imitators of candidate ``top``, shaped as it or as at ``starts``, where better;
        so many first ones of the catalogue were ``seen`` beside it."""
        size, fit = len(self.null.latent), results[top].fit
        anchor = linearised(self.problem, self.null.noises, self.problem.nominal, fit.latent[:size], self.null.runs)
        like = {short_name(p): fit.values[p.name] for p in fit.hypothesis.parameters[size:]}
        look = partial(directions_like, self.problem, anchor, like)
        looked_at = [top] + [i for i in range(seen, len(self.catalogue)) if i != top]
        scores = screen(anchor, list(self.fan_out(look, [(self.catalogue[i], starts[i]) for i in looked_at])), draws=0,
                        rules=self.rules.screening)
        score, start = (dict(zip(looked_at, each, strict=True)) for each in (scores.score, scores.start))
        enough = self.rules.refit.imitates * score[top]**2
        alike = sum(not self._short_of(fit, r) for i, r in results.items() if i < seen and i != top)
        imitators = [looked_at[k] for k in scores.order() if k and scores.score[k] > 0
                     and scores.score[k]**2 >= enough][:max(self.settings.kept - alike, 1)]
        begin = partial(begun_at, self.problem, anchor)
        refitted = self._ended(imitators, self.fan_out(begin, [(self.catalogue[i], start[i]) for i in imitators]),
                               {top: results[top]})
        alike = [i for i in imitators if score[i]**2 >= self.rules.refit.moves_alike * score[top]**2]
        return self._led_over(top, start, alike, lowest(results, refitted))

    def _led_over(self, top, starts, alike, results):
        """Results with those of candidates that move ``alike``, at other places, begun where they change next to
        nothing beside the nominal values that ``top`` asks for.

        What is one change at other nominal values, as a gain and a stiffer spring of an oscillator whose mass and
        damping are not known, lies at the far end of a bent valley: its slope leads there from this end alone.
        """
        fit, place = results[top].fit, self.catalogue[top].effects[0][1:]
        nominal = fit.latent[:len(self.null.latent)]
        return self.better(results, {
            i: np.concatenate((nominal, least(self.catalogue[i], starts[i]))) for i in alike
            if self.catalogue[i].effects[0][1:] != place and self._short_of(fit, results.get(i, NOT_BEGUN))},
                           self._near(fit))

    def _ended(self, chosen, begins, results):
        """{index: Refitted} of ``results`` and of candidates with their [(Fit or None, what went wrong)] of a begin."""
        first = dict(zip(chosen, begins, strict=True))
        ended = {**results, **{i: Refitted(None, None, why) for i, (begin, why) in first.items() if begin is None}}
        begun_fits = self._raced({i: begin for i, (begin, _) in first.items() if begin is not None})
        best = list(begun_fits)
        for group in (best[:1], best[1:]):
            finish = partial(finished, self.problem, self.null, self._enough(ended.values()), self.rules)
            ended |= dict(zip(group, self.fan_out(finish, [begun_fits[i] for i in group]), strict=True))
            if self.overtaken(ended):
                break
        return ended

    def brought_on(self, begins):
        """{index: Refitted} of fits that began: the best goes to its end, others as far as they may come near it."""
        results = {i: Refitted(None, None, why) for i, (fit, why) in begins.items() if fit is None}
        begun = {i: fit for i, (fit, _) in begins.items() if fit is not None}
        if not begun:
            return results
        best, *others = sorted(begun, key=lambda i: begun[i].objective)
        results[best] = finished(self.problem, self.null, np.inf, self.rules, begun[best])
        go_on = partial(advanced, self.problem, self._enough(results.values()), iterations=_NEARBY)
        ended = self.fan_out(go_on, [begun[i] for i in others])
        return results | {i: Refitted(fit, None, "") for i, fit in zip(others, ended, strict=True)}

    def _raced(self, fits):
        """The best few {index: Fit} of those that have begun, best first: the better half goes on, again and again.

        Along a narrow valley what a few iterations reach says little of where it ends; where one is at the noise, no
        other needs to go far.
        """
        kept, uncertainty = self.settings.kept, self.rules.decision.noise_uncertainty
        while True:
            order = sorted(fits, key=lambda i: fits[i].objective)[:max(kept, (len(fits) + 1) // 2)]
            if len(order) <= kept or fits[order[0]].unordered or fits[order[0]].reaches_noise(uncertainty):
                return {i: fits[i] for i in order[:kept]}
            go_on = partial(advanced, self.problem, min(self.bound, self._near(fits[order[0]])))
            fits = dict(zip(order, self.fan_out(go_on, [fits[i] for i in order]), strict=True))

    def _enough(self, results):
        """The objective to which candidates must be able to come down: near the best, as evidence is tempered."""
        best = min((r.fit for r in results if r.fit is not None), key=lambda fit: fit.objective, default=None)
        return self.bound if best is None else min(self.bound, self._near(best))

    def _short_of(self, best, refitted):
        """Whether a Refitted has no fit that comes near the Fit ``best``."""
        return refitted.fit is None or refitted.fit.objective > self._near(best)

    def _near(self, best):
        """The objective to which others must come beside the Fit ``best``; the valley from a null of unlikely values at
        the noise to those of a candidate is bent, and its slope tells little: there that of the null will do."""
        near = best.objective + self.rules.refit.within_reach / best.weights.max()
        return max(near, self.null.objective) if self._unlikely_at_noise else near


def _misled(null, rules):
    """Whether nothing near the null's optimum helps: values at odds with their priors, features paired wrongly."""
    return bool(null.excluded(rules.excluded)) or (null.unordered and null.far)
