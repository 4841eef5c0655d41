"""Height distributions: ranked onto a map, and the last of skewness and kurtosis corrected within its spectrum."""

from dataclasses import dataclass

import numpy as np
import scipy

#: standard normal quantiles at which the quantiles of a height distribution are stated
SCORES = np.linspace(-4.0, 4.0, 41)
#: Newton steps at most, deviation of Ssk and Sku that ends them, longest step in rms heights
STEPS, CLOSE, LONGEST = 200, 1e-4, 0.05


@dataclass(frozen=True)
class Heights:
    """Height distribution of unit rms: ``skewness`` Ssk, ``kurtosis`` Sku (3 = Gaussian), and its shape.

    ``quantiles`` (41,): heights over rms at the probabilities of ``SCORES``, rising; None leaves the shape to the
    two moments.
    """

    skewness: float = 0.0
    kurtosis: float = 3.0
    quantiles: np.ndarray | None = None


def mean_heights(maps):
    """Heights with the means of skewness, kurtosis and quantiles of each of ``maps``, each over its own rms."""
    skewness, kurtosis = np.mean([moments(heights) for heights in maps], axis=0)
    probability = scipy.special.ndtr(SCORES)
    quantiles = [np.quantile((heights - heights.mean()) / heights.std(), probability) for heights in maps]
    return Heights(skewness, kurtosis, np.mean(quantiles, axis=0))


def moments(values):
    """(skewness, kurtosis) of values about their mean."""
    centred = values - values.mean()
    variance = (centred ** 2).mean()
    return (centred ** 3).mean() / variance ** 1.5, (centred ** 4).mean() / variance ** 2


def ranked(values, quantiles):
    """``values`` (ny, nx) replaced rank by rank by those of the distribution of ``quantiles`` (41,)."""
    probability = (np.arange(values.size) + 0.5) / values.size
    result = np.empty(values.size)
    order = np.argsort(values, axis=None, kind="stable")
    result[order] = np.interp(scipy.special.ndtri(probability), SCORES, quantiles)
    return result.reshape(values.shape)


def with_moments(values, heights, restore, within):
    """A map of unit rms (ny, nx) with Ssk and Sku of Heights, as close as its spectrum allows.

    Newton steps along the square and the cube of the heights, of which ``within(map)`` keeps the waves of the spectrum;
    ``restore(map)`` scales them back to it. A spectrum that cannot have these moments ends short of them.
    """
    for _ in range(STEPS):
        missing = np.array([heights.skewness, heights.kurtosis]) - moments(values)
        if np.abs(missing).max() < CLOSE:
            break
        square = values ** 2
        ways = [within(square), within(square * values)]
        ways = [way - (way * values).mean() * values for way in ways]
        gain = np.array([[3.0 * (square * way).mean() for way in ways],
                         [4.0 * (square * values * way).mean() for way in ways]])
        step = np.tensordot(np.linalg.lstsq(gain, missing, rcond=1e-6)[0], ways, 1)
        values = restore(values + step * min(1.0, LONGEST / max(step.std(), 1e-300)))
    return values
