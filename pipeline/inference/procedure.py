"""A diagnosis in five steps: calibration, screening, refits, weighing, decision; several laws at once, else in pairs.

Where the nominal model does not reach the noise, its linearisation may rank nothing: there every candidate begins its
fit unless one of the first few explains enough, and the best few go on. What else could move as the best one does is
looked for at the nominal values that the best one asks for.
Elaborate candidates are weighed beside the simple ones only where neither these nor the nominal model reach the noise.
A null hypothesis that has not converged lets every candidate win: it is refitted from each candidate's optimum. A model
that lacks physics may have no smooth optimum at all: then a candidate counts only where it goes far below the null.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from pipeline.contract.errors import BrakechainError, instead, sentence_of
from pipeline.inference import model_error, nuisances, pairs, several
from pipeline.inference.decision import between_runs, other_form, second_effect, several_laws, steady_tones
from pipeline.inference.diagnosis import Settings, decided, reaches_noise
from pipeline.inference.fitting import tone_starts
from pipeline.inference.fitting.calibration import Calibration, recalibrate
from pipeline.inference.fitting.fit_state import linearised
from pipeline.inference.fitting.least_squares import continued
from pipeline.inference.fitting.refitted import NOT_BEGUN
from pipeline.inference.fitting.refitting import Refitter, refit_catalogue, refit_from
from pipeline.inference.long_records import beginnings, on_the_whole
from pipeline.inference.problem import FanOut, Problem
from pipeline.inference.search.score_screen import screen_catalogue
from pipeline.inference.search.selection import Combination, merged, sets_and_parts, where_felt
from pipeline.inference.time_budget import TimeSpentError, spent, within


def diagnose(problem, budget, catalogue, settings=None, fan_out=map, motions=None, tell=None, declared=()):
    """Diagnosis of a Problem with {run: Noise} ``budget`` over a ``catalogue`` of Hypotheses (effects alone).

    ``fan_out(function, items)`` maps as the builtin does. Where one effect is not enough, the set of laws that the
    equation of motion asks for along ``motions`` (Motions, where all are measured) is fitted together; what these do
    not show is tried in pairs with each of the leading effects by the same rules, the first taken as known. A further
    effect has to explain more than the laws of the others can be wrong by (``several``, ``second_effect``). What a
    named law leaves must not move as other laws at its place do (``other_form``). Raises ConvergenceError where the
    nominal model has no fit. ``tell(Decision)`` hears what is decided first, to be sharpened. Where the time is spent
    (``time_budget``) before all was tried beside one law nothing is named; what else was not tried is told. Long
    records are diagnosed on their beginnings first (``long_records``). Where no law reaches the noise, one that holds
    in part may be named (``model_error``). ``declared``: ``nuisances`` of the case.
    """
    settings, problem = settings or Settings(), problem.for_all(catalogue)
    asked = Asked(problem, budget, tuple(sorted(catalogue, key=lambda c: c.elaborate)), settings, fan_out, tell)
    return model_error.beside_it(*nuisances.told_beside(asked, declared, motions))


@dataclass(frozen=True)
class Asked:
    """What ``diagnose`` was asked; elaborate candidates come last in the ``catalogue``. ``alone``: of one law only;
    ``bound``: the objective to which a candidate has to come down to matter."""

    problem: Problem
    budget: dict
    catalogue: tuple
    settings: Settings
    fan_out: FanOut
    tell: Callable | None = None
    alone: bool = False
    bound: float = np.inf

    def told(self, motions=None):
        """``diagnosed``, of long records on their beginnings first."""
        short = beginnings(self.problem, self.budget)
        told = on_the_whole(self, replace(self, problem=short[0], budget=short[1]), motions) if short else None
        return told or self.diagnosed(motions)

    def diagnosed(self, motions):
        """Diagnosis by one law, else several, along Motions where there are."""
        _, single = self.steps()
        try:
            open_ = single.decision.verdict in ("unknown", "tie", "missing") and len(self.problem.runs) > 1
            if open_ and not (single.cut_short or self.alone):
                single = self.of_several(single, motions)
            if self.settings.tied_seconds and single.decision.verdict == "unknown":
                return self._tied_pair(single)
        except TimeSpentError:
            pass
        except Exception as error:      # what one law alone came to stands
            single = single.remarked(f"whether several laws act together could not be weighed: {sentence_of(error)}")
        if spent() and single.base is None and not single.cut_short:
            single = single.remarked("whether several laws act together was not tried to the end, as the time was"
                                     " spent; allow more by diagnosis.time", first=True)
        with within(np.inf):        # what it names is examined in any case
            return self.of_its_form(single)

    def of_several(self, single, motions):
        """The Diagnosis of several laws: of two simple ones that leave nothing, of those along Motions, of pairs, else
        the ``single`` one by one law."""
        pair = pairs.raced(self, single)
        if single.decision.verdict == "tie" or (pair.base is not None and reaches_noise(pair, self.settings.rules)):
            return pair
        single = replace(single, combinations=pair.combinations)
        best = (self.along(single, motions) if motions else
                self.by_the_screen(pairs.beside(self, single, self.catalogue)))
        return pair if best.base is None and pair.base is not None else best

    def steps(self, start=None, base=None):
        """(Refits, Diagnosis) of the five steps; the nominal model is fitted from the Fit ``start``, if there is one.
        (None, None) where none of the catalogue can come down to the ``bound``."""
        return self._from(self._recalibrated(start), base)

    def _recalibrated(self, start):
        """Calibration of the nominal model; at its given values where the time does not suffice for any fit."""
        try:
            return recalibrate(self.problem, self.budget, self.settings.rules.calibration, start)
        except BrakechainError:
            if not spent():
                raise
        problem, nominal = self.problem, self.problem.nominal
        with within(np.inf):
            noises = tuple(self.budget[run.name] for run in problem.training)
            return Calibration(problem, self.budget,
                               linearised(problem, noises, nominal, nominal.nominal, problem.training))

    def _from(self, calibration, base):
        """The same from a Calibration; all anew from a far better one that the refits come upon."""
        settings, fan_out, second = self.settings, self.fan_out, base is not None
        simple = self.catalogue[:sum(not c.elaborate for c in self.catalogue)]
        screening = screen_catalogue(calibration, simple, settings, fan_out, second)
        if second and len(simple) == len(self.catalogue) and np.isfinite(self.bound) and not screening.hopeful(
                self.bound):
            return None, None
        refits = refit_catalogue(screening, simple, settings, fan_out, None, second, self.bound)
        if refits.overtake(calibration) and not spent():
            return self._from(refits.calibration, base)
        told = decided(refits, settings, base)
        if self.tell and not second:
            self.tell(told.decision)
        if len(simple) == len(self.catalogue) or reaches_noise(told, settings.rules):
            return refits, told
        if spent():
            return refits, told.ended()
        catalogue = (*refits.refitter.catalogue,
                     *where_felt(self.catalogue[len(simple):], simple, screening.screen, refits))
        screening = screen_catalogue(refits.calibration, catalogue, settings, fan_out, second, refits.directions)
        refits = refit_catalogue(screening, catalogue, settings, fan_out, refits, second, self.bound)
        if refits.overtake(calibration) and not spent():
            return self._from(refits.calibration, base)
        return refits, decided(refits, settings, base)

    def given(self, known):
        """The same with Hypotheses ``known`` taken as known."""
        problem, rest = self.problem, tuple(c for c in self.catalogue if not any(map(c.excludes, known)))
        for candidate in known:
            problem = problem.given(candidate)
        return replace(self, problem=problem, catalogue=rest)

    def along(self, single, motions):
        """The Diagnosis of several laws, selected along Motions, or ``single``; what motions do not show in pairs."""
        rules, best = self.settings.rules, next((w.fit for w in single.named), None)
        if best is not None and not second_effect.has_room(best, best.betters(single.null), rules):
            return single
        if best is not None and reaches_noise(single, rules):
            return pairs.beside(self, single, self.catalogue)
        along = several.along_motions(single.null, self.catalogue, motions, rules.decision, self.fan_out)
        if along is None:
            return pairs.beside(self, single, self.catalogue)
        selection = along.selected()
        badly, tried = selection.left > rules.decision.along_motions, None
        if badly:
            pair = pairs.beside(self, single, self.catalogue)
            if pair.base is not None and reaches_noise(pair, rules):
                return pair
            tried = pair.further if pair.base is None else None
        best = self._simple_first(single, along, selection)
        if best.base is not None:
            return best
        if tried is not None and tried.decision.verdict != "tie":       # fewer seconds name more only where these tied
            return replace(best, further=tried)
        unseen = tuple(c for i, c in enumerate(self.catalogue) if i not in selection.judged)
        seconds = unseen if badly or best.named else self.catalogue     # motions have misled, or not shown all
        return pairs.beside(self, best, seconds) if seconds else best

    def _simple_first(self, single, along, selection):
        """``together`` of a Selection along motions, unless candidates that are not elaborate reach the noise."""
        elaborate = {i for i, c in enumerate(self.catalogue) if c.elaborate}
        if elaborate.isdisjoint((*selection.members, *selection.wider)):
            return self.together(single, selection)
        simple = self.together(single, along.selected(elaborate))
        if simple.base is not None and reaches_noise(simple, self.settings.rules):
            return simple
        best = self.together(replace(single, combinations=simple.combinations), selection)
        return replace(simple, combinations=best.combinations) if best.base is None else best

    def by_the_screen(self, single):
        """The Diagnosis of several laws that explain only together by the screen of ``single``, else that."""
        if single.base is not None or single.decision.verdict != "unknown":
            return single
        every, catalogue = single.refits.directions, single.refits.refitter.catalogue
        selection = several.linearised_about(single.null, every, catalogue, self.settings.rules.decision)
        return replace(self, catalogue=catalogue).together(single, selection)

    def together(self, single, selection):
        """The Diagnosis of the largest set of a Selection all of whose members are named; else ``single``, which tells
        what was tried.

        Where nothing is named a law that gives little along motions may be what the others lack.
        """
        tried, wider = merged(single.combinations, selection.tried), single.decision.verdict == "unknown"
        begun = {frozenset(c.effects) for c in tried if c.outcome}
        lacking = []        # sets that leave too much: so do those that are parts of them
        for members in sets_and_parts(selection.members, *[selection.wider] * wider):
            if any(set(members) < larger for larger in lacking) or self._names(members) in begun:
                continue
            whole, combination, enough = self._set(single, selection, members)
            tried = merged((combination,), tried)
            if whole is not None:
                return replace(whole, combinations=tried)
            if not enough:
                lacking.append(set(members))
        return replace(single, combinations=tried)

    def _names(self, members):
        return frozenset(self.catalogue[i].name for i in members)

    def _set(self, single, selection, members):
        """(Diagnosis that names the last of ``members`` beside the others or None, Combination: what became of it,
        whether it explains enough)."""
        *known, last = (self.catalogue[i] for i in members)
        names = tuple(c.name for c in (*known, last))
        tried = next((c for c in selection.tried if set(c.effects) == set(names)), Combination(names, 0.0))
        asked = self.given(known)
        try:
            fit = asked.fitted_together(single.null, selection.start(members), last)
            if fit is None:
                return None, replace(tried, outcome=NOT_BEGUN.failure), True
            rules = self.settings.rules
            left, error, stays = several_laws.left_by(asked.problem, self.budget, single.null, fit, rules)
            tried = replace(tried, objective=fit.objective, held_out=error, left=left, held_out_left=stays,
                            excluded=bool(fit.excluded(rules.calibration.excluded)),
                            values=several_laws.values_of(fit, (*known, last)))
            if left > rules.decision.unexplained:
                return None, replace(tried, outcome=several_laws.too_much(left, rules)), False
            whole, why = asked.named_together(single, fit.latent, last, known)
            rivals = self if any(c.elaborate for c in (*known, last)) else replace(
                self, catalogue=tuple(c for c in self.catalogue if not c.elaborate))
            for law in tuple(known):        # each has rivals of its own
                if whole is not None:
                    others = [*(c for c in known if c is not law), whole.named[0].candidate]
                    again, why = rivals._named_beside(single, whole.named[0].fit, law, others)
                    if again is None or again.named[0].candidate.name != law.name:
                        whole, known = again, others
        except Exception as error:
            return None, replace(tried, outcome=sentence_of(error)), True
        if whole is None:
            return None, replace(tried, outcome=why), True
        named = (*(c.name for c in known), *(w.candidate.name for w in whole.named))
        return whole, replace(tried, effects=named, outcome="named"), True

    def _named_beside(self, single, fit, law, known):
        """``named_together`` of one ``law`` of those whose Fit is given, the others ``known``: it was taken as known
        beside what else explained less than beside them."""
        return self.given(known).named_together(single, pairs.start_of(fit, single, law, known), law, known)

    def fitted_together(self, null, start, last):
        """Fit of the laws that are taken as known and of a Hypothesis ``last``, from latent values ``start`` of all, or
        None; ``null``: Fit of the nominal model alone. Given up where it would leave too much. A tone needs what the
        others leave to begin."""
        enough = several_laws.hoped(null, self.settings.rules)
        if tone_starts.tone_of(last):
            return next((r.fit for r in self.begun_together(null, start, last, enough)[1].values()), None)
        begin = linearised(self.problem, null.noises, self.problem.nominal.joined(last), start, null.runs)
        return continued(self.problem, begin, enough=enough, patient=False)

    def begun_together(self, null, start, last, enough=np.inf):
        """(Calibration of the laws that are taken as known, {index: Refitted} of one more, the Hypothesis ``last``)
        from latent values ``start`` of all; ``null``: Fit of the nominal model alone. Given up where it cannot come
        down to an objective ``enough``."""
        problem, rules, size = self.problem, self.settings.rules, len(last.parameters)
        begin = linearised(problem, null.noises, problem.nominal, start[:-size], null.runs)
        calibration = recalibrate(problem, self.budget, rules.calibration, continued(problem, begin, patient=False))
        refitter = Refitter.about(calibration, self.catalogue, self.settings, self.fan_out)
        return calibration, refitter.best_begun({}, {self.catalogue.index(last): [
            start, *tone_starts.starts(problem, calibration.null, last)]}, enough)

    def weighed_together(self, single, start, last, known):
        """Diagnosis of one more law beside those ``known``; arguments as of ``named_together``."""
        calibration, results = self.begun_together(single.null, start, last)
        screening = screen_catalogue(calibration, self.catalogue, self.settings, self.fan_out, True)
        refits = refit_from(screening, self.catalogue, results, self.settings, self.fan_out)
        return decided(refits, self.settings, single, len(known) + 1)

    def named_together(self, single, start, last, known):
        """(Diagnosis that names one more law beside those ``known`` (Hypotheses) or None, why there is none).

        ``last``: the one that was selected, ``start``: latent values of all; what it imitates is weighed too.
        """
        rules, whole = self.settings.rules.decision, self.weighed_together(single, start, last, known)
        if whole.decision.verdict != "missing":
            return None, "; ".join(whole.decision.reasons[:2])
        if second_effect.better_alone(single, whole):
            return None, f"{single.named[0].candidate.name} alone has more evidence"
        first = whole.named[0]
        reasons = several_laws.unneeded(self.problem, self.budget, single.null, whole.null, first.fit,
                                        (*known, first.candidate), rules)
        return (None if reasons else whole), "; ".join(reasons)

    def _tied_pair(self, single):
        """The first Diagnosis that names anything beside a significant effect taken as known; ``single`` where none
        does."""
        rules = self.settings.rules.decision
        for first in single.weighed:
            if not first.statistics.significant(rules):
                continue
            rest = tuple(c for c in self.catalogue if c.name != first.candidate.name)
            pair = diagnose(self.problem.given(first.refined), self.budget, rest,
                            replace(self.settings, tied_seconds=False), self.fan_out)
            if pair.decision.named:
                return replace(pair, base=single)
        return single

    def of_its_form(self, told):
        """A Diagnosis ``told``, decided anew without laws that it names and that are of another form; where nothing can
        be said, whether noise may be what is left, and which tones stand out of it."""
        settings = self.settings
        rules = several_laws.allowing(settings, told.laws).rules.decision
        while told.decision.verdict == "missing":
            first = told.named[0]
            try:
                why = other_form.objection(told, first, self.catalogue, rules, self.fan_out, settings.seed)
            except Exception as error:      # what cannot be asked is not named
                why = f"whether what it leaves moves as other laws do could not be computed: {sentence_of(error)}"
            if not why:
                break
            told = self.objected(told, {first.candidate.name: why})
        if told.decision.verdict != "unknown" or told.decision.leading:
            return told
        differing = instead(_not_computed)(between_runs.told)(self.problem, self.budget, told.null,
                                                              rules.noise_uncertainty)
        told = replace(told, decision=replace(told.decision, runs_differ=differing))
        return told.remarked(*filter(None, (
            instead(_not_computed)(other_form.of_noise)(told, settings.seed), differing,
            instead(_not_computed)(steady_tones.told)(told.null))))

    def objected(self, told, objected):
        """A Diagnosis ``told``, decided anew without laws ``objected`` to {name: why}."""
        weighing = told.weighing.objected(objected)
        decision = weighing.decided(several_laws.allowing(self.settings, told.laws, bool(told.nominal.effects)).rules)
        return replace(told, weighing=weighing, decision=decision, objected=told.objected | objected)


def _not_computed(error, *_):
    return f"whether noise, a tone or runs that differ may be what is left could not be computed: {sentence_of(error)}"
