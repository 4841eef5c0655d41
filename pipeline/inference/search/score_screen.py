"""Cheap screen of a catalogue: scores of candidate directions, linear in parameters, against one family-wise null.

A direction g is the change of the whitened prediction, per unit of an effect's parameter, away from its null at the
nominal fit. With C = I + J J' (noise and the prior of the nominal parameters),

    z = g'C^-1 r / sqrt(g'C^-1 g)  ~  N(0, 1)   where nothing is missing,

and the correlation of two scores is that of C^-1/2 g. The p-value of a score is how often the largest score of the
whole catalogue reaches it under that null: a parametric bootstrap of the refitted null, in its linearisation.
"""

from dataclasses import dataclass, replace
from functools import partial
from itertools import product

import numpy as np

from pipeline.contract.errors import instead, sentence_of
from pipeline.inference.fitting import tone_starts
from pipeline.inference.fitting.calibration import Calibration
from pipeline.inference.fitting.fit_state import from_prior_mean, orthogonal, whitened
from pipeline.inference.fitting.least_squares import HOPE
from pipeline.inference.rules import DEFAULTS

#: steps away from the null, in scales of the parameter's prior: its derivative, and a change one would notice
STEPS = (0.02, 1.0)
#: the same where candidates are told from what they imitate: at a sharp resonance two changes that the nominal values
#: make one differ by the square of a step times the periods of a run
FINE_STEPS = (1e-5, *STEPS)
#: parameters that only shape an effect are tried at these shares of their priors
SHAPES = (0.2, 0.8)
#: and angles in every quarter of theirs: no wave is at right angles to all of them
ANGLES = (0.125, 0.375, 0.625, 0.875)
#: variance of a score that draws of the null may lack
_NEGLIGIBLE = 1e-6
#: standard deviations below the median of its prior at which a size is faint
_FAINT = 3.0
#: relative difference of two scores below which they are of one direction
_SAME = 1e-6
#: at most this many combinations of shapes per effect parameter
_COMBINATIONS = 8
DRAWS = 20000


@dataclass(frozen=True)
class Directions:
    """Whitened directions of one candidate: ``vectors`` (q, m), per prior scale; ``sign`` (q,): +1, -1, 0 (either).

    ``tried`` (q,): the latent values (k,) of the effect's parameters; ``failure``: why there are none, or empty.
    """

    candidate: object
    vectors: np.ndarray
    sign: np.ndarray
    tried: tuple
    failure: str = ""

    def at_noise(self, factor):
        """The directions whitened by noise ``factor`` times as large."""
        return replace(self, vectors=self.vectors / factor)

    def with_those_of(self, other):
        """The directions beside those of ``other`` Directions of the same candidate."""
        return replace(self, vectors=np.concatenate((self.vectors, other.vectors)), tried=self.tried + other.tried,
                       sign=np.concatenate((self.sign, other.sign)), failure=self.failure and other.failure)


@dataclass(frozen=True)
class Screen:
    """Per candidate (n,): largest score, its family-wise p-value, and the power d (score expected at prior scale).

    ``start`` [(k,)]: latent values of the effect's parameters, as far along the best direction as it is linear.
    """

    candidates: tuple
    score: np.ndarray
    p_value: np.ndarray
    power: np.ndarray
    start: tuple
    failures: tuple

    def order(self):
        """Indices of the candidates, best first."""
        return np.argsort(-self.score, kind="stable")


@dataclass(frozen=True)
class Screening:
    """Second step: Directions (candidate,) at the null of a Calibration, their Screen, what is refitted.

    ``promising``: indices of the candidates whose scores are worth a fit, best first.
    """

    calibration: Calibration
    directions: tuple
    screen: Screen
    promising: tuple

    def hopeful(self, bound):
        """Those that may bring the objective down to ``bound``, by what their scores promise or by some times that, as
        a linearisation says little far off."""
        objective, score = self.calibration.null.objective, np.maximum(self.screen.score, 0.0)
        return tuple(i for i in self.promising if objective - HOPE * score[i]**2 <= bound)


def screen_catalogue(calibration, catalogue, settings, fan_out, beside_a_first=False, known=()):
    """Screening of a ``catalogue`` (Hypothesis, ...); ``beside_a_first``: for the second effect of a pair.

    ``known``: Directions of its first candidates, which were refitted before and are not promised again.

    Where the linearisation of the null may fail, all candidates are worth a fit. It holds where the null reaches
    the noise; of features, which are few and far from linear only where they are paired anew, wherever the null
    has an optimum.
    """
    problem, null, rules = calibration.problem, calibration.null, settings.rules
    every = (*known, *fan_out(partial(directions, problem, null), catalogue[len(known):]))
    rough = screen(null, every, None, settings.draws, settings.seed, rules.screening)
    linear = null.reaches_noise(rules.decision.noise_uncertainty) or (null.unordered and null.converged)
    likely = rules.decision.p_value if beside_a_first else rules.screening.p_value
    largest = likely if linear else 1.0
    promising = [int(i) for i in rough.order()
                 if i >= len(known) and np.isfinite(rough.score[i]) and rough.p_value[i] <= largest]
    return Screening(calibration, every, rough, _each_once(promising, rough, settings.kept))


def rescreened(screening, wider, settings, fan_out):
    """The Screening with other candidates ``wider`` {index: Hypothesis}, none of which is promised again."""
    calibration, rules = screening.calibration, settings.rules
    again = fan_out(partial(directions, calibration.problem, calibration.null), list(wider.values()))
    other = dict(zip(wider, again, strict=True))
    every = tuple(other.get(i, each) for i, each in enumerate(screening.directions))
    return replace(screening, directions=every, screen=screen(calibration.null, every, None, settings.draws,
                                                              settings.seed, rules.screening))


def _each_once(promising, screen, kept):
    """Indices (n,) in their order, but those of one score at one place, as of one direction, only once among the first
    ``kept``.

    A gain, a factor of units and a reversed sign are one change of a channel as long as it is small. What is the same
    at another place is a rival, and is weighed.
    """
    first, score = [], screen.score
    place = [tuple(where for _, where in c.effects) for c in screen.candidates]
    for i in promising:
        if len(first) < kept and not any(place[i] == place[k] and abs(score[i] - score[k]) <= _SAME * abs(score[i])
                                         for k in first):
            first.append(i)
    return (*first, *(i for i in promising if i not in first))


@instead(lambda error, problem, null, candidate, *_, **__: Directions(
    candidate, np.empty((0, int(null.counts.sum()))), np.array([], int), (), sentence_of(error)))
def directions(problem, null, candidate, shapes=None, steps=STEPS):
    """Directions of one candidate (Hypothesis of its effects alone) at the Fit ``null`` of the nominal hypothesis.

    ``shapes`` [(s,)]: latent values of the parameters that only shape it, at which alone it is tried; by default they
    are spread over their priors. ``steps``: from its null, in scales of its prior.
    """
    hypothesis, vectors, signs, tried = problem.nominal.joined(candidate), [], [], []
    base, failure = np.concatenate(null.residuals), ""
    for sides, sign, step in _trials(candidate, shapes, steps):
        for latent in sides:        # a gap that opens changes nothing where it is out of reach
            full = np.concatenate((null.latent, latent))
            moved, error = whitened(problem, null.noises, hypothesis, full, null.runs)
            change = None if moved is None else base - np.concatenate(moved)
            if change is None or change.any():
                break
        if change is None:
            failure = str(error)
            continue
        vectors.append(change / step)
        signs.append(sign)
        tried.append(latent)
    vectors = np.array(vectors).reshape(len(vectors), len(base))
    if len(vectors) and any(p.discrete for p in candidate.parameters):     # of discrete values the one that errs least
        best = [int(np.argmin(((base - vectors) ** 2).sum(axis=1)))]
        vectors, signs, tried = vectors[best], [signs[i] for i in best], [tried[i] for i in best]
    return Directions(candidate, vectors, np.array(signs, int), tuple(tried), "" if len(vectors) else failure)


def directions_with_tones(problem, null, candidate):
    """Directions of one candidate, those of a tone also at the frequencies and phases that stand out of what the Fit
    ``null`` leaves."""
    found, size = directions(problem, null, candidate), len(null.latent)
    shapes = [start[size:][candidate.shaping] for start in tone_starts.starts(problem, null, candidate)]
    return found.with_those_of(directions(problem, null, candidate, shapes)) if shapes else found


def screen(null, every, weights=None, draws=DRAWS, seed=0, rules=DEFAULTS.screening):
    """Screen of ``every`` Directions at the Fit ``null``; ``weights`` (runs,) of the runs (see ``tempering``).

    Without ``draws`` of the null scores are not compared with it, and p-values say nothing.
    """
    root = np.sqrt(np.repeat(np.ones(len(null.runs)) if weights is None else weights, null.counts))
    jacobian = root[:, None] * np.concatenate(null.jacobians)
    residual = root * np.concatenate(from_prior_mean(null))
    vectors = np.concatenate([np.empty((0, len(residual))), *(d.vectors for d in every)]) * root
    sign = np.concatenate([np.empty(0, int), *(d.sign for d in every)])
    owner = np.repeat(np.arange(len(every)), np.array([len(d.sign) for d in every], int))
    cleaned = orthogonal(vectors.T, jacobian).T
    square = np.einsum("qm,qm->q", vectors, cleaned)
    visible = square > rules.visible * np.einsum("qm,qm->q", vectors, vectors)
    size = np.sqrt(np.where(visible, square, 1.0))
    normal = cleaned @ residual / size
    score = np.where(visible, _one_sided(normal, sign), -np.inf)
    largest = np.empty(0)
    if draws:
        correlation = np.where(visible[:, None] & visible, (cleaned @ vectors.T) / np.outer(size, size), 0.0)
        largest = largest_scores(correlation, np.where(visible, sign, 0), draws, seed)
    return _gathered(every, owner, score, np.where(visible, size, 0.0), normal / size, largest)


def largest_scores(correlation, sign, draws=DRAWS, seed=0):
    """Largest of q scores (draws,) under the null: N(0, correlation), taken one-sided where ``sign`` is not 0."""
    values, basis = np.linalg.eigh(0.5 * (correlation + correlation.T))
    few = values > _NEGLIGIBLE * len(sign)      # many directions are nearly the same: most of the rank is rounding
    root = basis[:, few] * np.sqrt(values[few])
    normal = np.random.default_rng(seed).standard_normal((draws, np.count_nonzero(few)))
    return _one_sided(normal @ root.T, sign).max(axis=1, initial=-np.inf)


def family_p(score, largest):
    """Share of the null's largest scores that reach ``score``, counting the data as one draw."""
    ordered = np.sort(largest)
    reached = len(ordered) - np.searchsorted(ordered, score, side="left")
    return (1 + reached) / (1 + len(ordered))


def _one_sided(score, sign):
    return np.where(sign == 0, np.abs(score), sign * score)


def short_name(parameter):
    """Name of a parameter without the effect and the place it belongs to."""
    return parameter.name.rpartition(".")[2]


def _trials(candidate, shapes, steps=STEPS):
    """([latent values on either side of the null], sign, step in prior scales) of every direction: one effect parameter
    moved, shapes varied."""
    parameters = candidate.parameters
    if any(p.discrete for p in parameters):
        for latent in alternatives(candidate):
            yield [latent], 1, 1.0
        return
    shapes = _spread([parameters[k] for k in candidate.shaping], candidate.elaborate) if shapes is None else shapes
    for k, parameter in enumerate(parameters):
        if parameter.null is None:
            continue
        for step, shape in product(steps[-1:] if candidate.elaborate else steps, shapes):
            sides = []
            for away in (step, -step)[:1 if parameter.sign else 2]:
                values = [p.nominal if p.null is None else p.null for p in parameters]
                values[k] = _away(parameter, away)
                sides.append(np.array([p.prior.latent(v) for p, v in zip(parameters, values, strict=True)]))
                sides[-1][candidate.shaping] = shape
            yield sides, int(parameter.sign != 0), step


def _spread(shaping, half):
    """[(latent values,)] of parameters that shape an effect, over their priors; ``half`` a factorial design of two
    levels (Box, Hunter & Hunter, Statistics for Experimenters, 2005): those with an even number of high levels."""
    shares = [ANGLES if p.unit == "rad" else SHAPES for p in shaping]
    every = list(product(*shares))
    if half and len(shaping) > 1:
        every = [each for each in every if sum(share == SHAPES[1] for share in each) % 2 == 0]
    return [[_latent_of(p, share) for p, share in zip(shaping, each, strict=True)] for each in every[:_COMBINATIONS]]


def reshaped(candidate, latent):
    """[(k,)]: latent values (k,) of a candidate with the parameters that only shape it spread over their priors."""
    shapes, starts = candidate.shaping, []
    for each in _spread([candidate.parameters[k] for k in shapes], False) if shapes else []:
        starts.append(np.array(latent, float))
        starts[-1][shapes] = each
    return starts


def shapes_like(candidate, start, values):
    """Shapes [(s,)] of a candidate: as at its latent values ``start`` (k,), and those of ``values`` {name without
    place: value}, where these hold all of its shapes."""
    own = [(k, candidate.parameters[k]) for k in candidate.shaping]
    shapes = [[start[k] for k, _ in own]]
    if own and all(short_name(p) in values for _, p in own):
        shapes.append([float(np.clip(p.prior.latent(values[short_name(p)]), -2, 2)) for _, p in own])
    return shapes


def alternatives(candidate):
    """Latent values [(k,)] of a candidate at each of the values of its discrete parameters, the others as nominal."""
    return [np.array(each) for each in product(*(p.prior.alternatives if p.discrete else [p.prior.latent(p.nominal)]
                                                 for p in candidate.parameters))]


def least(candidate, start):
    """Latent values (k,) of a candidate, shaped as at ``start`` (k,), that hardly changes anything."""
    return np.array([u if p.null is None or p.discrete else p.prior.latent(_away(p, STEPS[0]))
                     for p, u in zip(candidate.parameters, start, strict=True)])


def _away(parameter, step):
    """A value ``step`` prior scales from the null, towards where the prior lies."""
    low, high = parameter.prior.support
    direction = -1 if parameter.null == high else 1
    return float(np.clip(parameter.null + direction * step * parameter.prior.scale, low, high))


def _latent_of(parameter, share):
    return parameter.prior.latent(parameter.prior.quantile(share))


def scaled(parameters, tried, coefficient):
    """Latent values (k,) of an effect where what a direction ``tried`` moved lies ``coefficient`` scales from null."""
    latent = np.array(tried, float)
    for k, p in enumerate(parameters):
        if p.null is None or np.isclose(latent[k], p.prior.latent(p.null)):
            continue
        side = np.sign(p.prior.value(latent[k]) - p.null)
        low, high = p.prior.support
        latent[k] = p.prior.latent(float(np.clip(p.null + side * coefficient * p.prior.scale, low, high)))
    return np.clip(latent, -2, 2)


def faint(candidate, start):
    """Latent values (k,) of a candidate, shaped as at ``start`` (k,), of a size far below what its prior expects."""
    return np.array([-_FAINT if p.null is not None and p.null == p.prior.support[0] else u
                     for p, u in zip(candidate.parameters, start, strict=True)])


def _gathered(every, owner, score, power, coefficient, largest):
    best = [max(np.flatnonzero(owner == n), key=lambda q: score[q], default=None) for n in range(len(every))]
    top = np.array([-np.inf if q is None else score[q] for q in best])
    starts = tuple(np.zeros(len(d.candidate.parameters)) if q is None else
                   _start(d, q - np.flatnonzero(owner == n)[0], coefficient[q])
                   for n, (d, q) in enumerate(zip(every, best, strict=True)))
    return Screen(tuple(d.candidate for d in every), top, family_p(top, largest),
                  np.array([0.0 if q is None else power[q] for q in best]), starts, tuple(d.failure for d in every))


def _start(found, number, coefficient):
    """Latent values (k,) at a ``coefficient`` along direction ``number`` of a candidate, not at its null."""
    parameters, tried, sign = found.candidate.parameters, found.tried[number], found.sign[number]
    if any(p.discrete for p in parameters):
        return tried
    away = max(coefficient, STEPS[0]) if sign else np.copysign(max(abs(coefficient), STEPS[0]), coefficient)
    return scaled(parameters, tried, away)
