"""Whether a second effect beside a first one is more than an error of the law of the first."""

import numpy as np

from pipeline.inference.decision.candidate_statistics import unexplained, unfinished
from pipeline.inference.decision.evidence import evidence
from pipeline.inference.decision.several_laws import noise_reached
from pipeline.inference.fitting.effective_sample_size import doubt

#: verdicts that name something
NAMING = ("missing", "sensor", "numerics")


def leading(single, rules, count=2):
    """Refitted candidates worth taking as known: significant ones, best first, another only if it explains as much.

    What beside it reaches the noise proves a first; where none has come to its end those are taken that have not, as
    beside an unfinished nominal model.
    """
    decision = rules.decision
    if single.decision.verdict == "missing":
        return single.named[:1]
    good = [w for w in single.weighed if w.statistics.significant(decision)
            and w.statistics.unexplained < decision.first_unexplained]
    good = [w for w in good if not unfinished(w.fit, single.null, rules.evidence)] or good
    explained = [w.fit.betters(single.null) for w in good]
    return [w for w, gained in zip(good[:count], explained, strict=False)
            if gained >= decision.first_share * max(explained)]


def has_room(fit, explained, rules):
    """Whether a second effect may matter beside a first, whose Fit ``explained`` so much of the objective.

    What the first leaves above the noise is as uncertain as the noise is; values at odds with their priors make up for
    something.
    """
    counts = fit.counts.sum()
    room = fit.objective - counts + doubt(counts, rules.decision.noise_uncertainty)
    return room >= rules.decision.second_at_noise * explained or bool(fit.excluded(rules.calibration.excluded))


def matters(pair, explained, rules):
    """Whether a ``pair`` names a second effect that is more than an error of the first, which ``explained`` so much.

    A wrong law of the first is seldom made good down to the noise, on runs that were not fitted too: what does that may
    be smaller, or give nominal values back to their priors; at the place of the first it must still exceed the error
    that any law has.
    """
    decision, excluded = rules.decision, rules.calibration.excluded
    odd = len(pair.null.excluded(excluded))

    def is_more(second):
        gained = second.fit.betters(pair.null)
        if second.fit.reaches_noise(decision.noise_uncertainty) and not second.statistics.held_out_left:
            beside = pair.null.hypothesis.places & second.candidate.places
            least = decision.law_error**2 if beside else decision.second_at_noise
            return gained >= least * explained or len(second.fit.excluded(excluded)) < odd
        return gained >= decision.second_share * explained

    return pair.decision.verdict in NAMING and any(is_more(second) for second in pair.named)


def bound(first, null, seconds, rules):
    """The objective without which none of ``seconds`` (Hypotheses) ``matters`` or ``mends`` beside the Weighed
    ``first``, which is named; ``null``: Fit of the nominal model alone."""
    decision, fit, explained = rules.decision, first.fit, first.fit.betters(null)
    beside = any(first.candidate.places & second.places for second in seconds)
    least = min(decision.second_share, decision.law_error**2) if beside else decision.second_share
    return max(fit.objective - least * explained, min(noise_reached(fit, rules), fit.objective))


def unconfirmed(first, pair, rules):
    """Why what a ``pair`` names at the place of the Weighed ``first``, which it takes as known, may as well be another
    form of that, in words; else ''.

    On the runs that were fitted a second law makes up for the shape of a wrong first one. What tells them apart are
    other runs, where the first alone does not predict them to the noise, or nominal values at odds with their priors.
    """
    law, told = first.candidate, ", ".join(pair.weighing.runs.powerless)
    odd = len(pair.null.excluded(rules.calibration.excluded))
    for each in pair.named:
        if (each.candidate.places & law.places and not each.statistics.powered
                and len(each.fit.excluded(rules.calibration.excluded)) >= odd):
            return (f"{each.candidate.name} beside it may as well make up for another form of {law.name}, which "
                    + (f"alone predicts {told} to the noise" if told else "no run is held out to tell"))
    return ""


def unnamed(single, pair, rules):
    """What explains most beside the law that a ``pair`` takes as known, a Weighed, where neither it nor the Diagnosis
    ``single`` names anything, though both laws leave no more than one may; else None."""
    if {single.decision.verdict, pair.decision.verdict} != {"unknown"}:
        return None
    best = next((w for w in pair.weighed if w.candidate.kind == "physics"), None)
    enough = best and unexplained(single.null, best.fit, rules) <= rules.decision.unexplained
    return best if enough else None


def mends(pair, explained, rules):
    """Why the law that a ``pair`` takes as known, which ``explained`` so much, is of another form, in words; else ''.

    It is where a second law at its place takes more off than any law errs by, with values of none at all.
    """
    decision = rules.decision
    for each in pair.weighed:
        statistics, gained = each.statistics, each.fit.betters(pair.null)
        if (pair.null.hypothesis.places & each.candidate.places and statistics.significant(decision)
                and statistics.from_null < decision.from_null and gained >= decision.law_error**2 * explained):
            return (f"{each.candidate.name} beside it takes {gained / explained:.1%} of what it explains off again, at"
                    f" values {statistics.from_null:.1f} standard deviations from none: a law of another form")
    return ""


def starts_without(first, pair, single):
    """{index among the candidates of the Diagnosis ``single``: latent values} of what ``pair`` names, at its values,
    but without the ``first`` effect.

    Greedy addition may begin with an effect that is not needed once the other one is there.
    """
    names = [c.name for c in single.refits.refitter.catalogue]
    size, skip = len(single.null.latent), len(first.fit.latent)
    return {names.index(w.candidate.name): np.concatenate((w.fit.latent[:size], w.fit.latent[skip:]))
            for w in pair.named if w.candidate.name in names}


def remains(first, pair, rules):
    """Whether the ``first`` effect is still one beside what a ``pair`` names: one of its sizes is as far from none at
    all as that of any effect must be."""
    sizes = [first.candidate.parameters[k] for k in first.candidate.sizes]
    return max(pair.completed.from_none(sizes, pair.weights), default=np.inf) >= rules.decision.from_null


def better_alone(alone, pair):
    """Whether what a Diagnosis ``alone`` names has more evidence than what ``pair`` names, by the weights of the pair.
    """
    def most(diagnosis):
        return max(evidence(w.fit, pair.weights).log_evidence for w in diagnosis.named)

    return alone.decision.verdict in NAMING and most(alone) > most(pair)
