"""Two laws, one found beside the other: the simple ones that explain most together, else each leading one as known."""

from dataclasses import replace
from itertools import islice

from pipeline.contract.errors import BrakechainError
from pipeline.inference.decision import second_effect
from pipeline.inference.diagnosis import decided
from pipeline.inference.search.pair_race import race
from pipeline.inference.time_budget import spent

#: pairs of a race that are weighed at most
_TRIED = 3


def raced(asked, single):
    """The Diagnosis of two simple laws that explain nearly all together, where ``single``, by one law of what was
    Asked, names none or a tie, else that."""
    if single.decision.verdict not in ("unknown", "tie"):
        return single
    asked = replace(asked, catalogue=single.refits.refitter.catalogue)
    pairs = race(asked.problem, asked.budget, single, asked.catalogue, asked.settings, asked.fan_out)
    for pair in islice(pairs, _TRIED):
        single = asked.together(single, pair.selected(single.null, asked.catalogue))
        if single.base is not None or spent():
            break
    return single


def beside(asked, single, seconds):
    """The Diagnosis of a pair of a leading effect, taken as known, and one of ``seconds`` (Hypotheses) that matters,
    else ``single``, by one law of what was Asked."""
    for first in second_effect.leading(single, asked.settings.rules):
        pair, matters = _pair(asked, single, first, seconds)
        why = matters and pair.decision.verdict == "missing" and (
            second_effect.unconfirmed(first, pair, asked.settings.rules) or _not_told(asked, single, first, pair))
        if matters and not why:
            return replace(pair, combinations=single.combinations)
        if first in single.named:
            single = _unless_mended(asked, replace(single, further=pair), first, why)
        elif why:
            single = single.remarked(why)
    return single


def start_of(fit, single, law, known):
    """Latent values of a Fit in the order of the nominal model of ``single``, the laws ``known`` and one ``law``."""
    names = [p.name for p in fit.hypothesis.parameters]
    return fit.latent[[names.index(p.name) for h in (single.null.hypothesis, *known, law) for p in h.parameters]]


def _pair(asked, single, first, seconds):
    """(Diagnosis with the ``first`` Weighed taken as known or None, whether it names one of ``seconds`` that matters).
    """
    rules, explained = asked.settings.rules, first.fit.betters(single.null)
    if not second_effect.has_room(first.fit, explained, rules):
        return None, False
    beside_it = replace(asked, catalogue=seconds).given([first.refined])
    if first in single.named:
        beside_it = replace(beside_it, bound=second_effect.bound(first, single.null, seconds, rules))
    try:
        _, pair = beside_it.steps(first.fit, single)
    except BrakechainError:
        return None, False
    if pair is None:
        return None, False
    if not second_effect.matters(pair, explained, rules):
        whole = _joined(beside_it, single, first, pair)
        return whole or pair, whole is not None
    starts = second_effect.starts_without(first, pair, single)
    alone = decided(single.refits.begun_anew(starts), asked.settings, single.base)
    dispensable = alone.decision.verdict in second_effect.NAMING and not second_effect.remains(first, pair, rules)
    return (alone if dispensable or second_effect.better_alone(alone, pair) else pair), True


def _joined(beside_it, single, first, pair):
    """The Diagnosis of the law ``first``, which these runs take as known, and the one that explains most beside it,
    fitted as one set where a ``pair`` names none though both leave little: judged by what they explain together. None
    where they are not named; ``beside_it``: what was Asked beside the first."""
    second = second_effect.unnamed(single, pair, beside_it.settings.rules)
    if second is None:
        return None
    beside_it = replace(beside_it, catalogue=pair.refits.refitter.catalogue)
    try:
        return beside_it.named_together(single, second.fit.latent, second.candidate, [first.refined])[0]
    except BrakechainError:
        return None


def _not_told(asked, single, first, pair):
    """Why the ``first`` law, which a ``pair`` takes as known, is not told from others beside what that names; else ''.
    """
    taken = {parameter.name for parameter in pair.nominal.parameters}
    if not taken.issuperset(parameter.name for parameter in first.candidate.parameters):
        return ""
    known, fit = [pair.named[0].candidate], pair.named[0].fit
    start = start_of(fit, single, first.candidate, known)
    try:
        told = asked.given(known).weighed_together(single, start, first.candidate, known)
    except BrakechainError as error:
        return f"{first.candidate.name} beside {known[0].name}: {error}"
    if first.candidate.name in [c.name for c in told.decision.named] and told.decision.verdict == "missing":
        return ""
    return f"{first.candidate.name} beside {known[0].name}: {'; '.join(told.decision.reasons[:2])}"


def _unless_mended(asked, single, first, why):
    """The Diagnosis ``single`` of a law ``first``, decided anew where there is a reason ``why`` it is not told, or
    where what was tried beside it says that it is of another form."""
    explained, rules = first.fit.betters(single.null), asked.settings.rules
    why = why or (single.further and second_effect.mends(single.further, explained, rules))
    return asked.objected(single, {first.candidate.name: why}) if why else single
