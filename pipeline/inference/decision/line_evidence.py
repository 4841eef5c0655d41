"""Evidence of models that predict tones, from a list of heard lines: an inhomogeneous Poisson process.

A model predicts sets of tones, one set per draw of its scatter. Tone j at f_j leaves a Poisson number of lines with
mean m_j, normally distributed about f_j with standard deviation s_j; unexplained lines, b in the band (l, h) on
average, are uniform there. Then lines y_1 ... y_n in the band, and no other, have the density

    p(y | tones) = exp(-M) prod_i L(y_i),   L(y) = sum_j m_j N(y; f_j, s_j) + b / (h - l),   M = int L dy,

and the evidence of the model is its mean over the draws (D. J. Daley and D. Vere-Jones, An Introduction to the Theory
of Point Processes, vol. I, 2nd ed., Springer 2003, section 7.1).
"""

from dataclasses import dataclass

import numpy as np
import scipy

#: resamples of the bootstrap
_RESAMPLES = 400


@dataclass(frozen=True)
class Band:
    """Where lines could be heard, ``low`` to ``high`` Hz, and how many ``unexplained`` ones there are on average."""

    low: float
    high: float
    unexplained: float


@dataclass(frozen=True)
class Tones:
    """Predicted tones of d draws, at most k each: ``frequency`` (d, k) Hz, ``std`` (d, k) Hz, ``mean`` (d, k) lines.

    Rows are filled with tones of mean 0. ``quiet`` (d,) is the mean number of lines that a test in which nothing was
    heard would have had.
    """

    frequency: np.ndarray
    std: np.ndarray
    mean: np.ndarray
    quiet: np.ndarray

    def __len__(self):
        return len(self.quiet)

    def __getitem__(self, rows):
        return Tones(self.frequency[rows], self.std[rows], self.mean[rows], self.quiet[rows])


@dataclass(frozen=True)
class Heard:
    """``lines`` (n,) Hz of one test, and whether the other one was ``silent``."""

    lines: np.ndarray
    silent: bool


def log_lines(lines, tones, band):
    """ln p (d,) of the ``lines`` (n,) Hz and no other, for each draw."""
    low, high = (scipy.special.ndtr((end - tones.frequency) / tones.std) for end in (band.low, band.high))
    expected = (tones.mean * (high - low)).sum(axis=1) + band.unexplained
    z = (np.reshape(lines, (-1, 1, 1)) - tones.frequency) / tones.std
    density = (tones.mean * np.exp(-0.5 * z**2) / (np.sqrt(2 * np.pi) * tones.std)).sum(axis=2)
    with np.errstate(divide="ignore"):
        return np.log(density + band.unexplained / (band.high - band.low)).sum(axis=0) - expected


def log_silence(silent, tones, band):
    """ln of the probability (d,) that the other test is ``silent``, or that it is not."""
    expected = tones.quiet + band.unexplained
    with np.errstate(divide="ignore"):
        return -expected if silent else np.log(-np.expm1(-expected))


def log_likelihood(heard, tones, band):
    """ln of the density (d,) of what was Heard."""
    return log_lines(heard.lines, tones, band) + log_silence(heard.silent, tones, band)


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
    heard = []
    for frequency, std, mean, quiet in zip(tones.frequency, tones.std, tones.mean, tones.quiet, strict=True):
        count = rng.poisson(mean)
        lines = rng.normal(np.repeat(frequency, count), np.repeat(std, count))
        lines = np.append(lines, rng.uniform(band.low, band.high, rng.poisson(band.unexplained)))
        silent = rng.poisson(quiet + band.unexplained) == 0
        heard.append(Heard(np.sort(lines[(lines >= band.low) & (lines <= band.high)]), bool(silent)))
    return heard


def calibration(models, band, seed):
    """ln evidence (h, t, h) of the lists that each of the models {name: Tones} (h) simulates, under each of them.

    The first half of the draws of each model, t, simulates; the second half weighs. All models have equally many draws.
    """
    rng = np.random.default_rng(seed)
    half = min(map(len, models.values())) // 2
    lists = [simulated(tones[:half], band, rng) for tones in models.values()]
    return np.array([[[log_mean(log_likelihood(heard, tones[half:], band)) for tones in models.values()]
                      for heard in made] for made in lists])


def named(evidence, factor=10.0):
    """Index (...,) of the model whose evidence is ``factor`` times that of every other, -1 without; ln in (..., h)."""
    ordered = np.sort(evidence, axis=-1)
    clear = ordered[..., -1] - ordered[..., -2] >= np.log(factor)
    return np.where(clear, np.argmax(evidence, axis=-1), -1)
