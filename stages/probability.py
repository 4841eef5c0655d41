"""Stage probability: how likely unstable modes are over the declared scatter of a brake.

Draws are made before the fan-out, evenly over the space of the sources, and solved in rounds: the first of the least
number, each other of as many as the share that squeals asks for so far, so that the number of workers changes no bit.
Each is solved on bases that all draws of one pressure share; a few are solved in the whole reduced model as well, which
states the error, and for all roots on the common bases. All are solved at every operating point, of which each has a
statement of its own.
"""

from dataclasses import replace
from functools import partial

import numpy as np

from pipeline.case_models.operating_points import Speeds, StabilitySettings, selected_speeds
from pipeline.case_models.scatter import (
    ADDITIONS,
    DEFAULT,
    Source,
    check_sources,
    factors_of,
    family,
    fitting,
    friction_errors,
    law_in_words,
    scored_values,
    standard_deviation,
)
from pipeline.contract import Context, ConvergenceError, Quantity, Section, option, stage
from pipeline.physics.stability.draws.draw_statistics import (
    among_bands,
    draws_needed,
    even_scores,
    explained,
    first_order,
    rate_interval,
    squealing,
    third_octaves,
)
from pipeline.physics.stability.draws.sampled_roots import sampled
from pipeline.physics.stability.draws.scatter import NOMINAL
from pipeline.physics.stability.draws.whole_roots import accuracy, beside_whole
from pipeline.products import ComplexModes, Effects, FrictionMap, Probability, ReducedModel

TWO_PI = 2.0 * np.pi
#: fewest draws of the first round and of others, and of one task of the fan-out
_FIRST, _ROUND, _CHUNK = 20, 10, 20
#: lowest 1/3 octave band, Hz
_LOWEST_BAND = 200.0


class Settings(Section):
    """What scatters, and how many draws are made of it."""

    draws: int = option(500, "most draws; 0 = none, and no probability", ge=0)
    interval: float = option(
        0.05, "no more draws are made once half the width of the 95 % interval of the share that squeals at any"
        " operating point is no more than this; 0 = all are made", ge=0, lt=1)
    least_draws: int = option(100, "draws that are made in any case, for what the causes say", ge=0)
    seed: int = option(11, "seed of the draws", ge=0)
    sources: tuple[Source, ...] = option(DEFAULT, "what scatters, each source independent of the others")
    speeds: Speeds = option(
        "all", "operating points that are sampled: those of all speeds, or of the middle one alone")
    least_growth: Quantity("1/s", ge=0) = option("0 1/s", "growth rate above which a mode counts")
    training: int = option(5, "further draws that the common bases are made to serve", ge=1)
    checked: int = option(4, "draws that are also solved in the whole reduced model, each at one operating point; half"
                          " of them are those farthest from the nominal brake, in standard deviations", ge=0)
    smallest_correction: float = option(
        1e-2, "corrections of the common bases below this share of the modal amplitude are left out", gt=0)


def _check(sections):
    check_sources(sections["probability"].sources, "probability.sources")


@stage(check=_check)
def probability(model: ReducedModel, friction_map: FrictionMap | None, modes: ComplexModes,
                effects: Effects | None, settings: Settings, context: Context) -> Probability:
    """Estimate how likely unstable modes are over the scatter of the brake.

    Operating points, limits, terms and effects are those of complex_modes, loss factors always hysteretic. A draw
    counts at an operating point if a mode of squeal, from complex_modes.squeal_from on, grows faster than
    'least_growth' there; 'overall' counts draws with one at any point. Lower modes count in their 1/3 octaves only.

    Method:
    At most {draws} draws of the declared scatter (seed {seed}) were solved for their unstable modes at every operating
    point, each about its own steady sliding state, on bases common to all draws; {checked} of them, half
    of which the farthest from the nominal brake, were solved in the whole reduced model as well. From {least_draws}
    draws on, none were added once half the width of the interval of 'overall' was no more than {interval}.
    Draws are those of a scrambled Sobol sequence. Probabilities carry 95 % Wilson intervals of as many independent
    draws as have what the sources leave of the variance by a linear law; they speak of the number of draws only.
    Sensitivities are first-order Sobol indices of the largest growth rate.
    """
    settings = settings.model_copy(update={"sources": fitting(settings.sources, model)})
    points = StabilitySettings.of(modes)
    points = replace(points, speeds=tuple(selected_speeds(settings.speeds, points.speeds)))
    errors = friction_errors(friction_map, points.sliding_distance)
    scores = even_scores(settings.draws, len(settings.sources), settings.seed)
    values = scored_values(settings.sources, errors, scores)
    families = [family(model, state, friction_map, points, effects) for state in range(len(model.pressure))]
    drawn = [factors_of(settings.sources, row, model) for row in values]
    others = scored_values(
        settings.sources, errors, even_scores(settings.training, len(settings.sources), [settings.seed, 1]))
    training = [NOMINAL, *(factors_of(settings.sources, row, model) for row in others)]
    cases, modes = _solved(families, drawn, scores, training, points, settings, context) if drawn else ([], [])
    values, scores = values[:len(modes)], scores[:len(modes)]
    scatter = [standard_deviation(s, errors) for s in settings.sources]
    checks = _checks(cases, [drawn[k] for k in _chosen(values, scatter, settings)], points)
    checked = context.map(partial(_checked, points), checks, "whole model")
    return Probability(
        source=[s.name for s in settings.sources], origin=[law_in_words(s, errors) for s in settings.sources],
        scatter=scatter, value=values, most_draws=settings.draws,
        least_draws=settings.least_draws, within=settings.interval,
        pressure=np.repeat(model.pressure, len(points.speeds)), speed=np.tile(points.speeds, len(model.pressure)),
        **_results(modes, values, scores, points, len(model.pressure) * len(points.speeds), settings),
        **accuracy([whole for whole, _ in checked]), spectrum_differ=sum(differs for _, differs in checked),
        least_growth=settings.least_growth, squeal_from=points.squeal_from)


def _solved(families, drawn, scores, training, points, settings, context):
    """(Sampled of every pressure, Growing [draw][operating point]) of as many draws as the statement needs."""
    cases = context.map(partial(_sampled, points, training, settings.smallest_correction), families, "common bases")
    few, modes = [case.compact() for case in cases], []
    while len(modes) < (end := min(_wanted(modes, scores, points, settings), len(drawn))):
        numbers = range(len(modes), end)
        chunks = [numbers[k:k + _CHUNK] for k in range(0, len(numbers), _CHUNK)]
        tasks = [(case, points.speeds, [(k, drawn[k]) for k in chunk]) for case in few for chunk in chunks]
        parts = context.map(_modes, tasks, "draws")
        per_case = [sum(parts[k:k + len(chunks)], []) for k in range(0, len(parts), len(chunks))]
        modes += [[each for case in per_case for each in case[k]] for k in range(len(numbers))]
    return cases, modes


def _wanted(modes, scores, points, settings):
    """Number of draws that say how likely squeal is at any operating point, by the ``modes`` of those made; ``scores``
    of all."""
    made = len(modes)
    if not settings.interval or made < max(settings.least_draws, _FIRST):
        return max(settings.least_draws, _FIRST) if settings.interval else settings.draws
    hits = _hits(_unstable(modes, points, settings), (made, len(modes[0])), points).any(axis=1)
    needed = draws_needed(hits.sum(), made, settings.interval, explained(scores[:made], hits))
    return max(needed, made + _ROUND) if needed > made else made


def _sampled(points, training, smallest, case):
    return sampled(case, points.speeds, points.frequency_max, training, smallest)


def _modes(task):
    """[draw][speed]: Growing of some draws at one pressure, without shapes."""
    case, speeds, drawn = task
    modes = []
    for number, factors in drawn:
        try:
            modes.append([replace(case.modes(factors, speed), shape=np.empty((0, 0))) for speed in speeds])
        except ConvergenceError as error:
            raise ConvergenceError(f"draw {number}: {error.where}", error.expected, error.found,
                                   error.remedy) from error
    return modes


def _chosen(values, scatter, settings):
    """Draws (d,) that are checked: the first ones, and as many of those farthest from the nominal brake, by the
    standard deviations of their ``values`` (d, s)."""
    columns = [each if source.kind in ADDITIONS else each - 1 if source.distribution == "uniform" else np.log(each)
               for source, each in zip(settings.sources, values.T, strict=True)]
    first = min(len(values), (settings.checked + 1) // 2)
    far = first + np.argsort(-((np.array(columns).T[first:] / scatter) ** 2).sum(axis=-1), kind="stable")
    return [*range(first), *far[:settings.checked // 2]]


def _checks(cases, drawn, points):
    """[(Sampled, Factors, speed)] of draws, each at another operating point, from the highest load down."""
    places = [(case, speed) for case in cases[::-1] for speed in points.speeds]
    return [(*places[k * (len(points.speeds) + 1) % len(places)], factors)
            for k, factors in enumerate(drawn)]


def _checked(points, task):
    """(what ``beside_whole`` says, whether all roots on the common bases say otherwise) of a draw."""
    case, speed, factors = task
    return beside_whole(case, factors, speed, points.frequency_max), case.missed(factors, speed) > 0


def _unstable(modes, points, settings):
    """{root, root_residual (k,) 1/s, root_draw, root_operating (k,)} of all that count as unstable."""
    rows = [(draw, operating, root, residual) for draw, of_draw in enumerate(modes)
            for operating, each in enumerate(of_draw)
            for root, residual in zip(each.value, each.residual, strict=True)
            if root.real > max(points.neutral * abs(root), settings.least_growth)]
    names = ("root_draw", int), ("root_operating", int), ("root", complex), ("root_residual", float)
    return {name: np.array([row[k] for row in rows], kind) for k, (name, kind) in enumerate(names)}


def _hits(unstable, shape, points):
    """``shape`` (draw, operating point): whether a draw squeals; ``unstable`` as of ``_unstable``."""
    return squealing(unstable["root"], unstable["root_draw"], unstable["root_operating"], shape, points.squeal_from)


def _results(modes, values, scores, points, operating, settings):
    """Fields of growth, unstable roots, probabilities and sensitivities."""
    count = len(modes)
    growth = np.reshape([[each.value[0].real if len(each.value) else -np.inf for each in draw] for draw in modes],
                        (count, operating))
    growth = np.maximum(growth, -TWO_PI * points.frequency_max)
    unstable = _unstable(modes, points, settings)
    root, draw, place = (unstable[name] for name in ("root", "root_draw", "root_operating"))
    middles = third_octaves(_LOWEST_BAND, points.frequency_max)
    hits = _hits(unstable, (count, operating), points)
    bands = np.zeros((count, len(middles), operating), bool)
    bands[draw, among_bands(root, middles), place] = True
    squeals, anywhere = hits.any(axis=1)[:, None], bands.any(axis=2)
    index = first_order(values, growth.max(axis=1), settings.seed)
    return {
        **unstable, "growth": growth, "whole_spectra": sum(each.whole for draw in modes for each in draw),
        "probability": _share(hits), "interval": _intervals(hits, scores), "overall": _share(squeals)[0],
        "overall_interval": _intervals(squeals, scores)[0], "explained": explained(scores, squeals[:, 0]),
        "band": middles,
        "band_probability": _share(bands), "band_any": _share(anywhere), "band_interval": _intervals(anywhere),
        "sensitivity": index[0], "sensitivity_error": index[1], "trend": index[2]}


def _share(hits):
    """Mean over the draws; 0 without any."""
    return hits.mean(axis=0) if len(hits) else np.zeros(hits.shape[1:])


def _intervals(hits, scores=None):
    """(k, 2) of the columns of ``hits`` (d, k); with ``scores``, less wide by what these explain."""
    shares = [0.0 if scores is None else explained(scores, column) for column in hits.T]
    return np.array([rate_interval(n, len(hits), share) for n, share in zip(hits.sum(axis=0), shares, strict=True)])
