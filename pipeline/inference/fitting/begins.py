"""Where fits of candidates begin: beside the null, at values of the screen, of tones, of choices, of a leader."""

import numpy as np

from pipeline.contract.errors import instead, sentence_of
from pipeline.inference.fitting import tone_starts
from pipeline.inference.fitting.calibration import begun
from pipeline.inference.fitting.fit_state import linearised, whitened
from pipeline.inference.fitting.run_parameters import with_own_parameters
from pipeline.inference.fitting.steps import within
from pipeline.inference.search.score_screen import (
    FINE_STEPS,
    alternatives,
    directions,
    faint,
    least,
    reshaped,
    shapes_like,
)

#: discrete values of a candidate at which fits begin
_ALTERNATIVES = 2
#: latent value of a large effect, without which no nominal values near those given predict anything like the data
_LARGE = 2.0
#: shapes from which on a candidate begins in others than the screen has found
_SEVERAL = 3


@instead(lambda error, *_: (None, sentence_of(error)))
def begun_beside(problem, null, anchor, ahead, offsets, item, enough=np.inf):
    """(Fit of a candidate after a few iterations or None, why there is none), beside the nominal values of ``anchor``.

    Where that is not the null, the candidate begins at the values of the null as well, unless these are as far out as
    any may be: then in a large size instead. One of few choices, as of a sign, without which the null is far off,
    begins at the stated values alone: those of the null, and of all its fits to less of the runs, answer to what the
    wrong choice asks for. It goes no further where it cannot come down to an objective ``enough``.
    """
    candidate, screened_start = item
    if anchor.far and not null.unordered and any(p.discrete for p in candidate.parameters):
        starts = _alternative_starts(problem, null, candidate, problem.nominal.nominal)
        begin = tried(problem, null, candidate, starts, [None] * len(starts))
        if begin[0] is not None and begin[0].objective < null.objective:
            return begin
    offsets = () if candidate.elaborate else offsets    # the screen has tried many values of these
    offsets = (*offsets, _LARGE) if null.at_limits else offsets
    starts = _starts(anchor.latent, [
        screened_start, least(candidate, screened_start),
        *(np.full(len(candidate.parameters), offset) for offset in offsets), *_other_shapes(candidate, screened_start)])
    if not (anchor.far or null.unordered):      # else what is nearest changes nothing, and leads nowhere
        starts.append(np.concatenate((anchor.latent, faint(candidate, screened_start))))
    discrete = _alternative_starts(problem, null, candidate, anchor.latent)
    at_null = [] if anchor is null or null.unordered or null.at_limits else [screened_start]
    at_null = _starts(null.latent, at_null) + tone_starts.starts(problem, null, candidate)
    return tried(problem, null, candidate, discrete + starts + at_null,
                  [None] * len(discrete) + [anchor] * len(starts) + [null] * len(at_null), ahead, enough)


def _other_shapes(candidate, start):
    """[(k,)] about the ``start`` (k,) of a candidate of several shapes, of which the linear screen tells little."""
    return [] if candidate.elaborate or len(candidate.shaping) < _SEVERAL else reshaped(candidate, start)


def _alternative_starts(problem, null, candidate, base):
    """Starts at the discrete values of a candidate that err least beside the nominal latent values ``base``, once what
    is of one run alone is fitted: a start that was read from a channel is as wrong as that."""
    if not any(p.discrete for p in candidate.parameters):
        return []
    hypothesis, ranked = problem.nominal.joined(candidate), []
    for start in _starts(base, alternatives(candidate)):
        start = with_own_parameters(problem, null.noises, hypothesis, start, null.runs)
        residuals, _ = whitened(problem, null.noises, hypothesis, start, null.runs)
        if residuals is not None:
            ranked.append((sum(r @ r for r in residuals), start))
    return [start for _, start in sorted(ranked, key=lambda pair: pair[0])[:_ALTERNATIVES]]


def directions_like(problem, anchor, values, item):
    """Directions of a candidate at the Fit ``anchor``, shaped as at its start and by ``values``."""
    candidate, start = item
    return directions(problem, anchor, candidate, shapes_like(candidate, start, values), FINE_STEPS)


@instead(lambda error, *_: (None, sentence_of(error)))
def begun_at(problem, anchor, item):
    """The same from the nominal values of the Fit ``anchor`` alone."""
    candidate, start = item
    starts = _starts(anchor.latent, [start]) + tone_starts.starts(problem, anchor, candidate)
    return tried(problem, anchor, candidate, starts, [anchor] * len(starts))


@instead(lambda error, *_: (None, sentence_of(error)))
def begun_as(problem, noises, fit):
    """(Fit linearised at the values of a Fit to parts of the fitted runs, "") or (None, what went wrong)."""
    return linearised(problem, noises, fit.hypothesis, fit.latent, problem.training), ""


def as_limit(limit, whole, latent):
    """Latent values (j,) of a candidate that is a ``limit`` of another, the ``whole`` at ``latent`` (k,): its sizes
    those of the same unit, the rest as nominal."""
    sizes = {whole.parameters[k].unit: whole.parameters[k].prior.value(latent[k]) for k in whole.sizes}
    alike = [p.prior.latent(sizes.get(p.unit, p.nominal) if p.null is not None else p.nominal)
             for p in limit.parameters]
    return within(np.array(alike, float))


def _starts(base, begins):
    """Latent values of a candidate beside nominal ones ``base``, from those of its own effect, none of them far out."""
    return [np.concatenate((base, np.clip(begin, -2, 2))) for begin in begins]


@instead(lambda error, *_: (None, sentence_of(error)))
def tried(problem, null, candidate, starts, anchors, ahead=(), enough=np.inf):
    """(Fit of a candidate after a few iterations from the best of ``starts``, see ``calibration.begun``, "") or (None,
    what went wrong)."""
    return begun(problem, null.noises, problem.nominal.joined(candidate), starts, null.runs, anchors, ahead, enough), ""
