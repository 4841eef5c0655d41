"""Seeded surfaces whose spectrum and height distribution are prescribed independently of each other.

Heights are ranked onto the distribution and the spectrum is restored, in turns (F. Pérez-Ràfols, A. Almqvist, Tribology
International 131 (2019) 591-604, doi 10.1016/j.triboint.2018.11.020). Every turn ends with the spectrum, which holds
exactly in each band; what is then left of skewness and kurtosis is corrected within it. Without a distribution, only
that is done. Both make peaks the sharper, the further the moments are from those of the random start: the nearest of
a few starts is taken.
"""

import numpy as np
import scipy

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.rough.generator import construction_size, resample
from pipeline.physics.rough.prescribed.bands import Cells
from pipeline.physics.rough.prescribed.heights import moments, ranked, with_moments

#: turns of ranking and restoring; what further ones change is less than what the correction of the moments does
TURNS = 30
#: random starts, of which the one nearest in Ssk and Sku is taken
STARTS = 12


def prescribed_surface(nodes, length, shortest, rms_height, *, seed, bands, heights, tolerance):
    """Periodic surface (nodes, nodes) in m on a square of ``length`` m with the spectrum of Bands and with Heights.

    The variance of every band, and so Sq, is exact; Sdq is as exact as the bands are narrow; Ssk and Sku are within
    ``tolerance`` (see ``deviations``) on the construction grid. Waves below ``shortest`` (m) are left out. Raises
    ConvergenceError for moments that a surface of this spectrum and seed does not reach.
    """
    size = construction_size(length, shortest)
    sectors = 1 if bands.directions is None else np.shape(bands.directions)[1]
    cells = Cells(size, length, bands.wavelength, sectors, shortest)
    target = cells.target(bands)

    def restore(values):
        return scipy.fft.irfft2(cells.project(scipy.fft.rfft2(values), target), s=values.shape)

    def within(values):
        return scipy.fft.irfft2(cells.within(scipy.fft.rfft2(values)), s=values.shape)

    values = _nearest_start(np.random.default_rng(seed), size, cells, bands, target, heights)
    for _ in range(TURNS if heights.quantiles is not None else 0):
        values = restore(ranked(values, heights.quantiles))
    values = with_moments(values, heights, restore, within)
    _refuse_far(values, heights, tolerance)
    result = resample(values, (nodes, nodes))
    return rms_height * (result - result.mean()) / result.std()


def deviations(skewness, kurtosis, heights):
    """Deviations of Ssk and Sku from Heights: relative, that of an Ssk between -1 and 1 absolute."""
    return abs(skewness - heights.skewness) / max(1.0, abs(heights.skewness)), abs(kurtosis / heights.kurtosis - 1.0)


def _nearest_start(random, size, cells, bands, target, heights):
    """Of ``STARTS`` Gaussian surfaces (size, size) of the spectrum the one with the moments nearest to Heights."""
    slope, nearest = cells.slope(bands), (np.inf, None)
    for _ in range(STARTS):
        noise = scipy.fft.rfft2(random.standard_normal((size, size)))
        values = scipy.fft.irfft2(cells.project(noise * slope, target), s=(size, size))
        distance = sum(deviations(*moments(values), heights))
        if distance < nearest[0]:
            nearest = distance, values
    return nearest[1]


def _refuse_far(values, heights, tolerance):
    skewness, kurtosis = moments(values)
    if max(deviations(skewness, kurtosis, heights)) > tolerance:
        raise ConvergenceError("fitted surface", f"Ssk {heights.skewness:.3g} and Sku {heights.kurtosis:.3g} within"
                               f" {tolerance:.2g}", f"{skewness:.3g} and {kurtosis:.3g} at best with this spectrum",
                               "raise the tolerance, or state moments nearer to Gaussian ones")
