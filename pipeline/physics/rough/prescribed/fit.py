"""What a levelled scan prescribes for a generator, and how near the generated surfaces come to it."""

from dataclasses import dataclass, fields
from itertools import product

import numpy as np

from pipeline.physics.rough.generator import band_limit, construction_size, resample
from pipeline.physics.rough.patch import OVERLAP, periodic_patch
from pipeline.physics.rough.prescribed.bands import Bands, band_edges, measured_bands
from pipeline.physics.rough.prescribed.heights import Heights, mean_heights
from pipeline.physics.rough.topography import statistics

#: sectors of the directions of waves, of 15 degrees
SECTORS = 12
#: pixels of a scan on the shortest wavelength that a fit takes from it unless told; below it is mostly noise
PIXELS = 4
#: spare room on an axis, over the patch length, from which on patches are taken at both of its ends too
SPARE = 0.05
#: share of the variance in a band that is nothing but rounding
_ROUNDING = 1e-12


@dataclass(frozen=True)
class Figures:
    """Sq in m, Ssk, Sku and Sdq of a map, and the share of the variance of each band (bands,).

    Two more that no generator here prescribes: Sz in m and the kurtosis of the slopes, which is 3 where waves meet at
    random and more where scratches, pits or plateaus have edges.
    """

    rms_height: float
    skewness: float
    kurtosis: float
    rms_slope: float
    variance: np.ndarray
    peak_to_valley: float
    slope_kurtosis: float


@dataclass(frozen=True)
class SurfaceFit:
    """A scan as a generator's values: patch ``length`` and ``shortest`` wave in m, Bands, Heights, their Figures."""

    length: float
    shortest: float
    bands: Bands
    heights: Heights
    figures: Figures


def largest_patch(shape, spacing):
    """Edge in m of the largest periodic square patch of a scan."""
    samples = [int(n / (1.0 + OVERLAP) + 1e-9) for n in shape]
    return min(n * d for n, d in zip(samples, spacing, strict=True))


def fitted(levelled, spacing, length, shortest, longest=np.inf):
    """SurfaceFit of a levelled scan (ny, nx) in m on square patches of ``length`` m, waves ``shortest`` to ``longest``.

    Patches at the ends and in the middle of each axis that has room for them are measured each by itself: a surface of
    this size is to be like one of them. Figures are their means.
    """
    size = construction_size(length, shortest)
    maps = []
    for place in _places(levelled.shape, spacing, length):
        patch = periodic_patch(levelled - levelled.mean(), spacing, length, place=place)
        grid = resample(band_limit(patch, (length, length), shortest, longest), (size, size))
        maps.append(grid - grid.mean())
    edges = band_edges(length, shortest)
    every = [measured_bands(patch, length, edges, SECTORS) for patch in maps]
    energy = np.mean([bands.variance[:, None] * bands.directions for bands in every], axis=0)
    variance = energy.sum(axis=1)
    variance[variance < _ROUNDING] = 0.0
    directions = np.where(variance[:, None] > 0.0, energy / energy.sum(axis=1, keepdims=True), 1.0 / SECTORS)
    bands = Bands(edges, variance / variance.sum(), directions)
    return SurfaceFit(length, shortest, bands, mean_heights(maps), mean_figures(maps, length, edges))


def mean_figures(maps, length, edges):
    """Means of the Figures of each of ``maps``, periodic (n, n) in m on squares of ``length`` m."""
    each = [figures(heights, length, edges) for heights in maps]
    return Figures(*(np.mean([getattr(f, field.name) for f in each], axis=0) for field in fields(Figures)))


def figures(heights, length, edges):
    """Figures of a periodic map (n, n) in m on a square of ``length`` m, in bands of bounds ``edges`` (m)."""
    gradients = [heights - np.roll(heights, 1, axis) for axis in (0, 1)]
    fourth = sum((g ** 4).mean() for g in gradients) / sum((g ** 2).mean() ** 2 for g in gradients)
    told = statistics(heights, (length / len(heights),) * 2)
    return Figures(told.rms_height, told.skewness, told.kurtosis, told.rms_slope,
                   measured_bands(heights, length, edges, 1).variance, told.peak_to_valley, fourth)


def _places(shape, spacing, length):
    """Places (y, x) of the patches of a scan, see ``patch.periodic_patch``."""
    room = (n * d / length - 1.0 - OVERLAP for n, d in zip(shape, spacing, strict=True))
    return list(product(*((0.0, 0.5, 1.0) if spare > SPARE else (0.5,) for spare in room)))
