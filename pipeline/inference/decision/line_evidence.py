"""Evidence of models that predict tones, from the lines heard in some tests: a marked inhomogeneous Poisson process.

A model predicts sets of tones, one set per draw of its scatter. Tone j at f_j grows in n_j of t tests and is heard in
each of these with the probability a, in each of the others with e. Over all tests it leaves a Poisson number of lines
with mean m_j = -n_j ln(1 - a), normally distributed about f_j with standard deviation s_j. The mark of a line is the
set x of tests in which it is heard, at least one of them:

    q_j(x) = prod_k p_jk^x_k (1 - p_jk)^(1 - x_k) / (1 - prod_k (1 - p_jk)),   p_jk = a or e.

Unexplained lines, b in the band (l, h) on average, are uniform over it and over the 2^t - 1 marks. Then lines
y_1 ... y_n in the band with marks x_1 ... x_n, and no other, have the density

    p(y, x | tones) = exp(-M) prod_i L(y_i, x_i),   M = int sum_x L dy,
    L(y, x) = sum_j m_j q_j(x) N(y; f_j, s_j) + b / ((h - l) (2^t - 1)),

and the evidence of the model is its mean over the draws (D. J. Daley and D. Vere-Jones, An Introduction to the Theory
of Point Processes, vol. I, 2nd ed., Springer 2003, sections 6.4 and 7.1). A frequency counts once, in however many
tests it is heard, because the error of its prediction is the same in all of them.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy

#: resamples of the bootstrap
_RESAMPLES = 400
#: standard deviations from a line beyond which a tone has no part in its density
_FAR = 7.0


@dataclass(frozen=True)
class Band:
    """Where lines could be heard, ``low`` to ``high`` Hz, and how many ``unexplained`` ones there are on average.

    ``elsewhere``: probability that a tone is heard in a test in which it does not grow.
    """

    low: float
    high: float
    unexplained: float
    elsewhere: float = 0.05


@dataclass(frozen=True)
class Tones:
    """Predicted tones of d draws, at most k each, in t tests: ``frequency`` (d, k) Hz, ``std`` (d, k) Hz.

    ``grows`` (d, k, t): 1 in tests in which they grow; rows are filled with tones that grow in none. ``heard`` (d,):
    probability that a growing tone is heard.
    """

    frequency: np.ndarray
    std: np.ndarray
    grows: np.ndarray
    heard: np.ndarray

    def __len__(self):
        return len(self.heard)

    def __getitem__(self, rows):
        return Tones(self.frequency[rows], self.std[rows], self.grows[rows], self.heard[rows])

    def within(self, tests):
        """The same in some of the tests, True in ``tests`` (t,)."""
        return replace(self, grows=self.grows[:, :, tests])

    @property
    def mean(self):
        """(d, k): mean number of lines of each tone."""
        return -self.grows.sum(axis=2) * np.log1p(-self.heard)[:, None]

    def probability(self, elsewhere):
        """(d, k, t): probability that each tone is heard in each test."""
        return np.where(self.grows > 0, self.heard[:, None, None], elsewhere)


@dataclass(frozen=True)
class Heard:
    """``lines`` (n,) Hz, each at its mean over the tests that heard it, and these tests, 1 in ``tests`` (n, t)."""

    lines: np.ndarray
    tests: np.ndarray

    def within(self, tests):
        """What was heard in some of the tests, True in ``tests`` (t,)."""
        there = self.tests[:, tests].any(axis=1)
        return Heard(self.lines[there], self.tests[there][:, tests])


class Density:
    """Density of what was heard under the ``tones`` of some draws in a ``band``; growing tones in one sorted list."""

    def __init__(self, tones, band):
        low, high = (scipy.special.ndtr((end - tones.frequency) / tones.std) for end in (band.low, band.high))
        self.draws, self.expected = len(tones), (tones.mean * (high - low)).sum(axis=1) + band.unexplained
        self.background = band.unexplained / (band.high - band.low) / (2.0 ** tones.grows.shape[2] - 1)
        draw, column = np.nonzero(tones.grows.any(axis=2))
        order = np.argsort(tones.frequency[draw, column], kind="stable")
        self.draw, listed = draw[order], (draw[order], column[order])
        self.frequency, self.std = tones.frequency[listed], tones.std[listed]
        self.reach = _FAR * float((self.std / self.frequency).max(initial=0.0))
        probability = tones.probability(band.elsewhere)[listed]
        missed = np.log1p(-probability)
        none = missed.sum(axis=1)
        self.odds = np.log(probability) - missed
        self.base = np.log(tones.mean[listed] / (np.sqrt(2 * np.pi) * self.std)) + none - np.log(-np.expm1(none))

    def log(self, heard):
        """ln p (d,) of what was Heard and of no other line, for each draw."""
        total = -self.expected
        for line, tests in zip(heard.lines, heard.tests, strict=True):
            ends = line / (1 + self.reach), line / max(1 - self.reach, 1e-9)
            near = slice(*np.searchsorted(self.frequency, ends))
            z = (line - self.frequency[near]) / self.std[near]
            density = np.exp(self.base[near] + self.odds[near] @ tests - 0.5 * z**2)
            with np.errstate(divide="ignore"):
                total = total + np.log(np.bincount(self.draw[near], density, self.draws) + self.background)
        return total


def log_density(heard, tones, band):
    """ln p (d,) of what was Heard and of no other line, for each draw of the Tones."""
    return Density(tones, band).log(heard)


def log_mean(values, axis=-1):
    """ln of the mean of exp(values)."""
    return scipy.special.logsumexp(values, axis=axis) - np.log(np.shape(values)[axis])


def log_evidence(values, seed):
    """(ln of the mean of exp(values) (d,), its standard error by bootstrap over draws, draws that carry it).

    The last is (sum w)^2 / sum w^2 with w = exp(values).
    """
    values = np.asarray(values, float)
    if not np.isfinite(values).any():
        return -np.inf, 0.0, 0.0
    picks = np.random.default_rng(seed).integers(0, len(values), (_RESAMPLES, len(values)))
    again = log_mean(values[picks])
    carried = np.exp(2 * scipy.special.logsumexp(values) - scipy.special.logsumexp(2 * values))
    finite = again[np.isfinite(again)]
    return float(log_mean(values)), float(np.std(finite)), float(carried)


def simulated(tones, band, rng):
    """[Heard] of each draw: what its tones and unexplained lines would let one hear."""
    lists, probability, count = [], tones.probability(band.elsewhere), tones.grows.shape[2]
    for k, number in enumerate(rng.poisson(tones.mean)):
        which = np.repeat(np.arange(len(number)), number)
        stray = rng.poisson(band.unexplained)
        lines = np.append(rng.normal(tones.frequency[k, which], tones.std[k, which]),
                          rng.uniform(band.low, band.high, stray))
        marks = _marks(np.vstack((probability[k, which], np.full((stray, count), 0.5))), rng)
        inside = (lines > band.low) & (lines < band.high)
        lists.append(Heard(lines[inside], marks[inside]))
    return lists


def _marks(probability, rng):
    """Tests (n, t) in which lines are heard with the ``probability`` (n, t) of each, at least one of them."""
    marks = np.zeros(probability.shape, int)
    while (none := ~marks.any(axis=1)).any():
        marks[none] = rng.uniform(size=(none.sum(), marks.shape[1])) < probability[none]
    return marks


def calibration(models, band, seed, most=200):
    """ln evidence (h, s, h) of each of the ``models`` {name: Tones} for s lists that each of them simulates.

    Up to ``most`` rows of the first half of the draws of each model simulate; the second half weighs. All models have
    equally many draws.
    """
    rng = np.random.default_rng(seed)
    half = min(map(len, models.values())) // 2
    rows = np.unique(np.linspace(0, half - 1, min(half, most)).astype(int))
    lists = [simulated(tones[rows], band, rng) for tones in models.values()]
    weighing = [Density(tones[half:], band) for tones in models.values()]
    return np.array([[[log_mean(w.log(heard)) for w in weighing] for heard in made] for made in lists])


def named(evidence, factor=10.0):
    """Index (...,) of the model whose evidence is ``factor`` times that of every other, -1 without; ln in (..., h)."""
    ordered = np.sort(evidence, axis=-1)
    clear = ordered[..., -1] - ordered[..., -2] >= np.log(factor)
    return np.where(clear, np.argmax(evidence, axis=-1), -1)
