"""Location of a mismatch on three axes: chain stage, place, regime; significance over each whole axis, and a 95 % set.

Items are whatever the axis holds. A score per item is compared with the largest score of the axis under a null that is
drawn (parametric bootstrap, or circular shifts, which keep the correlation of both series); the p-value of an item is
then right for all items at once (Westfall & Young, Resampling-Based Multiple Testing, 1993).
"""

from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.inference.fitting.fit_state import from_prior_mean, orthogonal
from pipeline.inference.search.score_screen import family_p

DRAWS = 4000
LEVEL = 0.95


@dataclass(frozen=True)
class Location:
    """Per item (n,): ``score``, family-wise ``p_value``; ``members`` (n,): whether it belongs to the 95 % set."""

    items: tuple
    score: np.ndarray
    p_value: np.ndarray
    members: np.ndarray

    def significant(self, level=0.05):
        """Names of the items whose p-value is at most ``level``."""
        return tuple(item for item, p in zip(self.items, self.p_value, strict=True) if p <= level)


def holm(p_value):
    """Holm's step-down p-values (n,) of single ones, for axes without a common null (Scand. J. Stat. 6 (1979) 65)."""
    p_value = np.asarray(p_value, float)
    order = np.argsort(p_value)
    adjusted = np.empty(len(p_value))
    adjusted[order] = np.minimum(np.maximum.accumulate(p_value[order] * np.arange(len(p_value), 0, -1)), 1.0)
    return adjusted


def credible_set(probability, level=LEVEL):
    """Smallest set (n,) of items whose probabilities sum to ``level``."""
    order = np.argsort(-np.asarray(probability), kind="stable")
    needed = np.searchsorted(np.cumsum(np.asarray(probability)[order]), level - 1e-12) + 1
    members = np.zeros(len(order), bool)
    members[order[:needed]] = True
    return members


def against_null(items, score, null, resampled=None):
    """Location from scores (n,), their null draws (draws, n) and, for the 95 % set, ``resampled`` scores (draws, n).

    The set holds the items that lead most of the resampled scores; without them, the items not below the leader by more
    than the null's 95 % range of such differences.
    """
    score, null = np.asarray(score, float), np.asarray(null, float)
    p_value = family_p(score, null.max(axis=1))
    if resampled is not None:
        lead = np.bincount(np.argmax(resampled, axis=1), minlength=len(score)) / len(resampled)
        return Location(tuple(items), score, p_value, credible_set(lead))
    spread = np.quantile(null[:, [int(np.argmax(score))]] - null, LEVEL, axis=0)
    return Location(tuple(items), score, p_value, score.max() - score <= np.maximum(spread, 0.0))


def stages(names, decrease, draws=DRAWS, seed=0):
    """Chain stages by what their substitution takes away: ``decrease`` {stage: (b,)} of the squared error, per block.

    A stage scores its decrease, summed over blocks, over the root of their squares, when the measured quantity stands
    in place of the modelled one; null by random signs of whole blocks, set by resampling blocks.
    """
    blocks = np.array([np.asarray(decrease[name], float) for name in names])
    generator, count = np.random.default_rng(seed), blocks.shape[1]
    if count < 4:
        raise ConfigError("location on the stage axis", "at least four blocks of data", str(count))
    sign = generator.choice((-1.0, 1.0), (draws, count))
    chosen = generator.integers(count, size=(draws, count))
    size = np.sqrt((blocks**2).sum(axis=1))
    size = np.where(size > 0, size, 1.0)
    return against_null(names, blocks.sum(axis=1) / size, sign @ (blocks / size[:, None]).T,
                        blocks[:, chosen].sum(axis=2).T)


def places(names, bases, null, weights=None, draws=DRAWS, seed=0):
    """Places by the response to forces there: ``bases`` {place: (m, q)} whitened, at the Fit ``null``.

    Each place scores the square of what its basis explains of the residual outside the nominal parameters, as a
    standard normal (Wilson-Hilferty, of chi^2 with q degrees); set by the probabilities of a latent force of prior 1.
    """
    root = np.sqrt(np.repeat(np.ones(len(null.runs)) if weights is None else weights, null.counts))
    jacobian = root[:, None] * np.concatenate(null.jacobians)
    residual = root * np.concatenate(from_prior_mean(null))
    frames = [_frame(root[:, None] * bases[name], jacobian) for name in names]
    vectors = np.hstack([frame for frame, _ in frames])
    normal = np.random.default_rng(seed).standard_normal((draws, vectors.shape[1]))
    values, basis = np.linalg.eigh(vectors.T @ orthogonal(vectors, jacobian))
    drawn = normal @ (basis * np.sqrt(np.maximum(values, 0.0))).T
    ends = np.cumsum([frame.shape[1] for frame, _ in frames])[:-1]
    score = [_normal_score(part) for part in np.split(vectors.T @ orthogonal(residual, jacobian), ends)]
    null_score = np.array([_normal_score(part) for part in np.split(drawn, ends, axis=1)]).T
    localised = against_null(names, score, null_score)
    logs = np.array([_log_gain(frame.T @ orthogonal(residual, jacobian), size) for frame, size in frames])
    share = np.exp(logs - logs.max())
    return Location(localised.items, localised.score, localised.p_value, credible_set(share / share.sum()))


def regimes(power, coordinate, edges, draws=DRAWS, seed=0):
    """Bins of a coordinate (amplitude, sliding speed, time) by residual power.

    Both are series (n,), of one run or of several one after the other.
    A bin scores its mean power over the mean of all, in units of the spread under circular shifts of the power against
    the coordinate; ``edges`` (b + 1,). Empty bins score nothing. Set by resampling of sixteen stretches.
    """
    index = np.clip(np.searchsorted(edges, coordinate, side="right") - 1, 0, len(edges) - 2)
    member = (index == np.arange(len(edges) - 1)[:, None]).astype(float)
    count = np.maximum(member.sum(axis=1), 1)
    all_shifts = np.fft.irfft(np.conj(np.fft.rfft(member, axis=1)) * np.fft.rfft(power - power.mean()),
                              len(power), axis=1) / count[:, None]
    spread = np.where(member.sum(axis=1) > 0, all_shifts.std(axis=1), np.inf)
    generator = np.random.default_rng(seed)
    shift = generator.integers(1, len(power), draws)
    score = all_shifts[:, 0] / spread
    stretches = np.array_split(np.arange(len(power)), 16)
    sums = np.array([[member[:, s] @ power[s], member[:, s].sum(axis=1)] for s in stretches])
    picked = sums[generator.integers(16, size=(draws, 16))].sum(axis=1)
    mean = np.where(picked[:, 1] > 0, picked[:, 0] / np.maximum(picked[:, 1], 1), -np.inf)
    names = tuple((float(a), float(b)) for a, b in zip(edges[:-1], edges[1:], strict=True))
    return against_null(names, score, (all_shifts[:, shift] / spread[:, None]).T, mean)


def bands(white, rate, edges, draws=DRAWS, seed=0):
    """Frequency bands of a whitened residual (n,) by its power; ``edges`` [Hz] (b + 1,). Null: white, power 1."""
    power = np.abs(np.fft.rfft(white)) ** 2 / len(white)
    index = np.searchsorted(edges, np.fft.rfftfreq(len(white), 1 / rate), side="right") - 1
    count = np.array([(index == b).sum() for b in range(len(edges) - 1)])
    mean = np.array([power[index == b].mean() if c else 1.0 for b, c in enumerate(count)])
    generator, seen = np.random.default_rng(seed), np.maximum(count, 1)
    null = np.where(count > 0, generator.gamma(seen, 1 / seen, (draws, len(count))), 1.0)
    resampled = mean * np.where(count > 0, generator.gamma(seen, 1 / seen, (draws, len(count))), 0.0)
    names = tuple((float(a), float(b)) for a, b in zip(edges[:-1], edges[1:], strict=True))
    return against_null(names, (mean - 1) * np.sqrt(seen), (null - 1) * np.sqrt(seen), resampled)


def _frame(basis, jacobian):
    """Basis (m, q') with B'C^-1 B = I, less directions that the parameters hide; and its squared size (q',)."""
    gram = basis.T @ orthogonal(basis, jacobian)
    values, vectors = np.linalg.eigh(gram)
    kept = values > 1e-9 * max(values[-1], 1e-300)
    return basis @ (vectors[:, kept] / np.sqrt(values[kept])), values[kept]


def _normal_score(part):
    """Wilson and Hilferty's normal deviate of the sum of squares over the last axis."""
    size = part.shape[-1]
    return (((part**2).sum(axis=-1) / size) ** (1 / 3) - (1 - 2 / (9 * size))) / np.sqrt(2 / (9 * size))


def _log_gain(score, size):
    """ln Z over none, of amplitudes N(0, 1) on a basis of squared size (q,) with normal scores (q,)."""
    return float(0.5 * np.sum(score**2 * size / (1 + size)) - 0.5 * np.sum(np.log1p(size)))
