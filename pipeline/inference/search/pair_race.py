"""Which two simple laws explain together what neither does alone: a race of pairs, begun and not fitted to their ends.

Laws that explain much alone are often not the right ones: where two act, an elaborate one makes up for both. Beside
each of the simple laws that matter, taken as it was fitted, the catalogue is screened once more, and the few most
promising others begin their fits. Of the pairs that have come down furthest the best go on; one that may leave as
little as two laws may is worth a full fit.
"""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from pipeline.contract.errors import instead
from pipeline.inference.decision import several_laws
from pipeline.inference.fitting.begins import begun_beside
from pipeline.inference.fitting.calibration import Calibration
from pipeline.inference.fitting.fit_state import Fit, linearised
from pipeline.inference.fitting.refitted import advanced
from pipeline.inference.fitting.refitting import Refitter
from pipeline.inference.search.score_screen import screen_catalogue
from pipeline.inference.search.selection import Combination, Selection

#: laws beside which others are looked for, and others that begin beside each
_FIRSTS, _SECONDS = 4, 4
#: share of what explains most among the simple laws that a first one explains
_MATTERS = 0.3
#: share of what a law explains that a limit of it explains which takes its place
_LIMIT = 0.7
#: iterations of a pair that has begun; those that go on, and their iterations
_LAPS, _LAST, _FURTHER = 4, 3, 20


@dataclass(frozen=True)
class Pair:
    """The Hypotheses ``first`` and ``second`` and their Fit together, as far as the race went."""

    first: object
    second: object
    fit: Fit

    @property
    def names(self):
        return self.first.name, self.second.name

    def selected(self, null, catalogue):
        """Selection of both among a ``catalogue``; ``null``: Fit of the nominal model alone."""
        names = [c.name for c in catalogue]
        members, size = tuple(map(names.index, self.names)), len(null.latent)
        middle = size + len(self.first.parameters)
        values = {members[0]: self.fit.latent[size:middle], members[1]: self.fit.latent[middle:]}
        tried = Combination(self.names, float(self.fit.weights.max() * self.fit.betters(null) / 2))
        return Selection(members, (), (tried,), self.fit.latent[:size], values, frozenset(), 0.0)


def race(problem, budget, single, catalogue, settings, fan_out):
    """Yields the Pairs of the ``catalogue`` that come down furthest beside what the Diagnosis ``single`` has found and
    may leave as little as two laws may: at once where one reaches the noise, as no other comes lower, else in the end.

    The race goes on only where it is asked for another. A fault of a sensor or the solver beside a law is looked for
    where that is taken as known. Beside laws that tie a pair has to explain more than one of these alone, by the share
    that a second law has to.
    """
    simple = tuple(c for c in catalogue if c.kind == "physics" and not c.elaborate)
    enough, pairs, told, bound = several_laws.hoped(single.null, settings.rules), [], [], np.inf
    for tied in single.named:
        enough = min(enough, tied.fit.objective - settings.rules.decision.second_share * tied.fit.betters(single.null))
        bound = max(enough, several_laws.noise_reached(tied.fit, settings.rules))
    for first in firsts(single, settings.rules):
        found = [pair for pair in _beside(problem, budget, single.null, simple, settings, fan_out, first, bound)
                 if set(pair.names) not in told]
        best = min(found, key=lambda pair: pair.fit.objective, default=None)
        if best and best.fit.reaches_noise(settings.rules.decision.noise_uncertainty):
            told.append(set(best.names))
            yield best
        pairs += [pair for pair in found if set(pair.names) not in told]
    best = sorted(pairs, key=lambda pair: pair.fit.objective)[:_LAST]
    fits = fan_out(partial(advanced, problem, enough, iterations=_FURTHER), [pair.fit for pair in best])
    ended = [replace(pair, fit=fit) for pair, fit in zip(best, fits, strict=True) if fit.objective <= enough]
    for pair in sorted(ended, key=lambda pair: pair.fit.objective):
        if set(pair.names) not in told:
            told.append(set(pair.names))
            yield pair


def firsts(single, rules):
    """The simple Weighed of a Diagnosis beside which others are worth a look, what explains most first, each law at its
    best place before any at another; a limit of one in its place where that explains about as much."""
    gained = {w.candidate.name: w.fit.betters(single.null) for w in single.weighed}
    simple = sorted((w for w in single.weighed if w.candidate.kind == "physics" and not w.candidate.elaborate
                     and w.statistics.significant(rules.decision)), key=lambda w: -gained[w.candidate.name])
    chosen = []
    for each in simple:
        explained = gained[each.candidate.name]
        limits = [w for w in simple if w.candidate.name in each.candidate.extends
                  and gained[w.candidate.name] >= _LIMIT * explained]
        first = limits[0] if limits else each
        if explained >= _MATTERS * gained[simple[0].candidate.name] and first not in chosen:
            chosen.append(first)
    laws = [w.candidate.effects[0][0] for w in chosen]
    return [chosen[k] for k in sorted(range(len(chosen)), key=lambda k: laws[:k].count(laws[k]))[:_FIRSTS]]


@instead(lambda error, *_: [])
def _beside(problem, budget, null, catalogue, settings, fan_out, first, bound):
    """[Pair] of the Weighed ``first`` and those of a ``catalogue`` that promise most beside it, and may come down to an
    objective ``bound``."""
    known = first.refined
    given, others = problem.given(known), tuple(c for c in catalogue if not c.excludes(known))
    base = linearised(given, null.noises, given.nominal, first.fit.latent, null.runs)
    screening = screen_catalogue(Calibration(given, budget, base), others, settings, fan_out, True)
    refitter, start = Refitter.about(screening.calibration, others, settings, fan_out), screening.screen.start
    begin = partial(begun_beside, given, base, refitter.anchor, refitter.ahead, settings.starts, enough=bound)
    chosen = screening.hopeful(bound)[:_SECONDS]
    begun = {i: fit for i, (fit, _) in zip(chosen, fan_out(begin, [(others[i], start[i]) for i in chosen]), strict=True)
             if fit is not None}
    fits = fan_out(partial(advanced, given, bound, iterations=_LAPS), list(begun.values()))
    return [Pair(known, others[i], fit) for i, fit in zip(begun, fits, strict=True)]
