"""Where measured friction differs from a friction map, and what values of the micro scale that asks for.

With ln mu = ln map(p, v, k s) + a + b ln(p / p_m) + c ln(v / v_m) - d (T - T_m), about the means of the samples,
each term is a way in which the map may be off: its level a (the shear limit), how it changes with pressure b (the
surfaces), with speed c (the rate of the shear limit), with distance ln k (wear), with temperature d (softening). All
sets of terms that the samples can tell are fitted by weighted least squares, with a scatter between tests beside the
stated errors, and compared by BIC (Schwarz, Ann. Stat. 6 (1978) 461); a term counts where its own p-value, for as many
terms as were tried, is below a hundredth. What was found is tested on groups of samples that were not fitted.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache, partial
from itertools import combinations

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError

TERMS = ("level", "pressure", "speed", "distance", "temperature")
LEVEL, PRESSURE, SPEED, DISTANCE, TEMPERATURE = range(len(TERMS))
#: p-value of a term, over all that were tried; difference of BIC within which sets are not told apart
SIGNIFICANT, ALIKE = 0.01, 2.0
#: standard deviations, those of the map counted, within which a term may be chance of the computed surfaces
WITHIN = 2.0
#: ranges of a condition from which its term is tried (a narrower one would take up any drift): ratio of the 95 to the
#: 5 % quantile; of temperature K between them; relative change of the map over distance
_RANGE, _KELVIN, _GROWS = 1.5, 15.0, 0.01
#: largest factor on the distance, factors tried first, step of its derivative
_FACTOR, _COARSE, _STEP = 20.0, 13, 1e-3
#: stretches of the distance whose coefficients are kept: those of the coarse search, and of a fine one
_KEPT = 64


@dataclass(frozen=True)
class Fitted:
    """A set of ``terms`` (indices) with their ``values`` and ``covariance``, relative ``scatter`` between tests beside
    stated errors, ``bic``, and the ``predicted`` ln mu (n,)."""

    terms: tuple
    values: np.ndarray
    covariance: np.ndarray
    scatter: float
    bic: float
    predicted: np.ndarray

    @property
    def std(self):
        return np.sqrt(np.diag(self.covariance))


@dataclass(frozen=True)
class Update:
    """What the samples ask for: ``best`` Fitted, ``every`` Fitted by BIC, ``tested`` terms, their ``p_value``s and
    ``value``, ``std`` (5,) fitted all together; ``map_std`` (5,) what the map itself may be off by; logarithms of
    ``mapped``, ``updated`` and ``unseen`` coefficients (n,): of the map, with the best set, and of that fitted to other
    groups; ``outside`` (n,) beyond the map."""

    best: Fitted
    every: tuple
    tested: tuple
    value: np.ndarray
    std: np.ndarray
    p_value: np.ndarray
    map_std: np.ndarray
    mapped: np.ndarray
    updated: np.ndarray
    unseen: np.ndarray
    outside: np.ndarray

    @property
    def alike(self):
        """[terms] of sets that are not told apart from the best one and hold terms that it does not."""
        return [f.terms for f in self.every if f is not self.best and f.bic < self.best.bic + ALIKE
                and not set(f.terms) >= set(self.best.terms)]

    @property
    def sure(self):
        """Terms of the best set that are beyond what other patches of the computed surfaces may change."""
        return tuple(t for t, v, s in zip(self.best.terms, self.best.values, self.best.std, strict=True)
                     if abs(v) > WITHIN * np.hypot(s, self.map_std[t]))

    @property
    def verdict(self):
        """'consistent', 'chance' (what differs may be of the patches that were computed), 'values' or 'tie'."""
        if not self.best.terms:
            return "consistent"
        if not self.sure:
            return "chance"
        return "tie" if self.alike else "values"


def update(law, samples, map_std=(0.0, 0.0, 0.0, 0.0, 0.0)):
    """Update of a FrictionLaw by Samples; ``map_std`` (5,): standard errors of the map along the terms.

    Raises ConfigError where there are too few samples to tell anything.
    """
    if len(samples) < 3:
        raise ConfigError("friction_update", "three measured coefficients of friction at least", str(len(samples)),
                          "more of them, best over pressure, speed and distance")
    mapped, outside = law.evaluate(samples.pressure, samples.speed, samples.distance)
    tested, beside = _told(law, samples), _Beside(law, samples)
    every = sorted((_fit(beside, terms) for size in range(len(tested) + 1)
                    for terms in combinations(tested, size) if size < len(samples) - 1), key=lambda f: f.bic)
    best = next(f for f in every if (_p_values(f, len(samples)) * max(len(tested), 1) < SIGNIFICANT).all())
    whole = max(every, key=lambda f: len(f.terms))
    value, std, p_value = np.zeros(len(TERMS)), np.zeros(len(TERMS)), np.ones(len(TERMS))
    value[list(whole.terms)], std[list(whole.terms)] = whole.values, whole.std
    p_value[list(whole.terms)] = _p_values(whole, len(samples))
    return Update(best, tuple(every), tested, value, std, p_value, np.array(map_std, float), np.log(mapped),
                  best.predicted, _unseen(beside, best), outside)


def _told(law, samples):
    """Indices of the terms that the samples can tell."""
    def ends(values):
        return np.quantile(values, [0.05, 0.95])

    told = [LEVEL]
    told += [t for t, x in ((PRESSURE, samples.pressure), (SPEED, samples.speed))
             if np.divide(*ends(x)[::-1]) > _RANGE]
    less, same, more = (np.log(law.evaluate(samples.pressure, samples.speed, k * samples.distance)[0])
                        for k in (1 / 3, 1.0, 3.0))
    if max(np.ptp(less - same), np.ptp(more - same)) > _GROWS:
        told.append(DISTANCE)
    if np.ptp(ends(samples.temperature)) > _KELVIN:
        told.append(TEMPERATURE)
    return tuple(told)


class _Beside:
    """What all fits of a FrictionLaw to the same Samples share."""

    def __init__(self, law, samples):
        self.samples, self._law = samples, law
        self.measured, self.error = np.log(samples.friction), samples.friction_std / samples.friction
        self.mapped = lru_cache(_KEPT)(self._mapped)        # every fit begins with the same coarse search

    def _mapped(self, stretch):
        """ln mu (n,) of the law at distances times e^``stretch``."""
        samples = self.samples
        return np.log(self._law.evaluate(samples.pressure, samples.speed, np.exp(stretch) * samples.distance)[0])

    @cached_property
    def _linear(self):
        samples = self.samples
        return {LEVEL: np.ones(len(samples)), PRESSURE: np.log(samples.pressure / scipy.stats.gmean(samples.pressure)),
                SPEED: np.log(samples.speed / scipy.stats.gmean(samples.speed)),
                TEMPERATURE: samples.temperature.mean() - samples.temperature}

    def columns(self, terms):
        """Change of ln mu (n, k) by linear ``terms`` of one, about the means of the samples."""
        return np.array([self._linear[t] for t in terms]).reshape(-1, len(self.samples)).T


def _fit(beside, terms, chosen=None):
    """Fitted to the ``chosen`` (n,) samples of a _Beside, all by default, and predicted for all.

    The factor on the distance is searched; all other terms are linear. The scatter between tests weighs the samples,
    and is told by what they leave.
    """
    chosen = np.ones(len(beside.samples), bool) if chosen is None else chosen
    measured, error, mapped = beside.measured, beside.error, beside.mapped
    columns, scatter, farther = beside.columns([t for t in terms if t != DISTANCE]), 0.0, 0.0
    place = terms.index(DISTANCE) if DISTANCE in terms else None

    def solved(stretch, weight, weighed):
        base = mapped(stretch)
        values = np.linalg.lstsq(weighed, weight * (measured - base)[chosen], rcond=None)[0]
        return values, base + columns @ values

    def square(stretch, weight, weighed):
        return np.sum((weight * (measured - solved(stretch, weight, weighed)[1])[chosen]) ** 2)

    for _ in range(3):
        weight = 1 / np.sqrt(_variance(error, scatter**2))[chosen]
        weighed = weight[:, None] * columns[chosen]
        if place is not None:
            farther = _lowest(partial(square, weight=weight, weighed=weighed))
        values, predicted = solved(farther, weight, weighed)
        scatter = _scatter((measured - predicted)[chosen], error[chosen], len(terms))
    spread, left = _variance(error, scatter**2)[chosen], (measured - predicted)[chosen]
    if place is not None:
        values = np.insert(values, place, farther)
        columns = np.insert(columns, place, (mapped(farther + _STEP) - mapped(farther - _STEP)) / (2 * _STEP), axis=1)
    covariance = np.linalg.pinv((columns[chosen] / spread[:, None]).T @ columns[chosen])
    minus = np.sum(np.log(spread) + left**2 / spread)
    return Fitted(tuple(terms), values, covariance, scatter, float(minus + (len(terms) + 1) * np.log(chosen.sum())),
                  predicted)


def _lowest(square):
    """Logarithm of the factor on the distance that leaves least, of a coarse search and a fine one about its best."""
    coarse = np.linspace(-np.log(_FACTOR), np.log(_FACTOR), _COARSE)
    best = coarse[np.argmin([square(x) for x in coarse])]
    width = coarse[1] - coarse[0]
    return float(scipy.optimize.minimize_scalar(square, bounds=(best - width, best + width), method="bounded").x)


def _variance(error, square):
    """Of samples (n,) with a standard ``error`` each, and this ``square`` of a scatter; above that of samples that
    state no error and scatter not at all."""
    return np.maximum(error**2 + square, _least_variance(error))


def _least_variance(error):
    return max(1e-12, float(np.median(error)) ** 2 * 1e-6)


def _scatter(left, error, terms):
    """Standard deviation beside the stated errors at which what is left (n,) has the square that it should have.

    Paule & Mandel, J. Res. NBS 87 (1982) 377.
    """
    freedom, least, squares, errors = max(len(left) - terms, 1), _least_variance(error), left**2, error**2

    def excess(square):
        return np.sum(squares / np.maximum(errors + square, least)) - freedom

    high = 4 * np.sum(left**2) / freedom + 1e-12
    if excess(0.0) <= 0:
        return 0.0
    return float(np.sqrt(scipy.optimize.brentq(excess, 0.0, high, xtol=1e-15)))


def _p_values(fitted, count):
    """Two-sided p-values (k,) of the values of a Fitted, by Student's t."""
    ratio = abs(fitted.values) / np.maximum(fitted.std, 1e-300)
    return 2 * scipy.stats.t.sf(ratio, max(count - len(fitted.terms), 1))


def _unseen(beside, best):
    """ln mu (n,), each group of samples predicted by the terms of ``best`` fitted to the others alone."""
    unseen = np.array(best.predicted)
    for group in groups(beside.samples):
        rest = ~group
        if best.terms and rest.sum() > len(best.terms):
            unseen[group] = _fit(beside, best.terms, rest).predicted[group]
    return unseen


def groups(samples):
    """[(n,) mask]: runs where there are three or more, else samples of like conditions, else each sample by itself."""
    conditions = np.round(np.column_stack((np.log(samples.pressure), np.log(samples.speed),
                                           samples.temperature / 10)), 1)
    for labels in (np.unique(samples.run, return_inverse=True)[1],
                   np.unique(conditions, axis=0, return_inverse=True)[1].ravel()):
        if labels.max() >= 2:
            return [labels == k for k in range(labels.max() + 1)]
    return [np.arange(len(samples)) == k for k in range(len(samples))]
