"""From the section of a fitted surface to its generator, and from a scan to that section."""

from itertools import pairwise

import numpy as np

from pipeline.case_models.rough.scans import levelled
from pipeline.case_models.rough.sections import FitSettings, Fitted
from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from pipeline.physics.rough.generator import construction_size
from pipeline.physics.rough.plausible_scan import refuse_coarse
from pipeline.physics.rough.prescribed.bands import Bands
from pipeline.physics.rough.prescribed.fit import PIXELS, fitted, largest_patch, mean_figures
from pipeline.physics.rough.prescribed.generator import deviations, prescribed_surface
from pipeline.physics.rough.prescribed.heights import SCORES, Heights, mean_heights, moments

#: deviation of a figure from the scan's that is called a miss; an Ssk that counts as none
MISS, SMALL_SKEWNESS = 0.05, 0.01
_TOLERANCE = Fitted.model_fields["tolerance"].default


def generated(choice, nodes, length, shortest, seed, where):
    """Surface (nodes, nodes) in m of a section Fitted at ``where``; ``seed`` instead of its own."""
    _refuse_inconsistent(choice, where)
    directions = None if choice.direction_shares is None else np.array(choice.direction_shares)
    bands = Bands(np.array(choice.wavelengths), np.array(choice.variance_shares), directions)
    quantiles = None if choice.height_quantiles is None else np.array(choice.height_quantiles)
    return prescribed_surface(nodes, length, shortest, choice.rms_height, seed=seed, bands=bands,
                              heights=Heights(choice.skewness, choice.kurtosis, quantiles), tolerance=choice.tolerance)


def fit(settings: FitSettings):
    """(document of the section ``surface``, lines that compare generated surfaces with the scan) of FitSettings.

    Where seeds miss Ssk or Sku by more than 5 %, the section states the tolerance that they need. ConfigError for scans
    that cannot be read or are smaller than the patch.
    """
    where = f"surface --fit {settings.file}"
    scan = levelled(settings, where)
    length = settings.patch_length or _rounded(largest_patch(scan.heights.shape, scan.spacing), np.floor)
    shortest = settings.shortest_wavelength or _rounded(PIXELS * max(scan.spacing), np.ceil)
    refuse_coarse(scan.spacing, shortest, where, "raise shortest_wavelength, or take a finer scan")
    result = fitted(scan.heights, scan.spacing, length, shortest, settings.longest_wavelength or np.inf)
    size = construction_size(length, shortest)
    tries = [_tried(shape, result, size, settings.seeds, where) for shape in _shapes(result)]
    body, maps = min(tries, key=lambda tried: _unlike(result, tried[1]))
    document = {"surface": {"nodes": size, "patch_length": _micrometres(length),
                            "shortest_wavelength": _micrometres(shortest), settings.body: body}}
    return document, _comparison(scan, result, maps, settings)


def _tried(body, result, size, seeds, where):
    """(the section with the tolerance that it needs, its maps (seeds, size, size), made from what is written)."""
    choice = fill(Fitted, {**body, "tolerance": 1e9}, where)
    maps = np.array([generated(choice, size, result.length, result.shortest, seed, where) for seed in range(seeds)])
    worst = max(max(deviations(*moments(values), result.heights)) for values in maps)
    return body if worst <= _TOLERANCE else {**body, "tolerance": float(f"{1.5 * worst:.2g}")}, maps


def _unlike(result, maps):
    """How unlike the scan maps are in what the moments leave open: Sz, edges, shape of the height distribution."""
    made, aimed = mean_figures(maps, result.length, result.bands.wavelength), result.figures
    return (abs(np.log(made.peak_to_valley / aimed.peak_to_valley)) + _quantile_difference(result, maps)
            + abs(np.log(made.slope_kurtosis / aimed.slope_kurtosis)))


def _quantile_difference(result, maps):
    """Rms difference of the height distributions over rms heights, weighted by probability."""
    weight = np.exp(-0.5 * SCORES ** 2)
    difference = mean_heights(maps).quantiles - result.heights.quantiles
    return np.sqrt((weight * difference ** 2).sum() / weight.sum())


def _shapes(result):
    """Sections Fitted of a SurfaceFit: by the moments of the heights alone, and by their distribution."""
    body = {"kind": "fitted", "seed": 1, "rms_height": _micrometres(result.figures.rms_height),
            "wavelengths": [_micrometres(w) for w in result.bands.wavelength],
            "variance_shares": _short(result.bands.variance), "direction_shares": _short(result.bands.directions, 3),
            "skewness": float(f"{result.heights.skewness:.4g}"), "kurtosis": float(f"{result.heights.kurtosis:.5g}")}
    return body, {**body, "height_quantiles": _short(result.heights.quantiles, 4)}


def _comparison(scan, result, maps, settings):
    made, aimed = mean_figures(maps, result.length, result.bands.wavelength), result.figures
    filled = result.bands.variance > 0.0
    band = np.abs(made.variance[filled] / aimed.variance[filled] - 1.0)
    rows = {"Sq": (aimed.rms_height, made.rms_height, " m"), "Ssk": (aimed.skewness, made.skewness, ""),
            "Sku": (aimed.kurtosis, made.kurtosis, ""), "Sdq": (aimed.rms_slope, made.rms_slope, "")}
    missed = [name for name, (a, b, _) in rows.items() if deviation(name, a, b) > MISS]
    missed += ["spectrum"] * bool(band.max() > MISS)
    whole = scan.heights - scan.heights.mean()
    return [
        *([f"read: {scan.told}"] if scan.told else []),
        f"{settings.file.name}: patches of {result.length:.4g} m, waves down to {result.shortest:.3g} m; means of"
        f" {settings.seeds} seeds",
        f"{'':<16}{'scan':>14}{'generated':>14}{'deviation':>12}",
        *(_row(name, *row) for name, row in rows.items()),
        f"spectrum, {band.size} bands: largest deviation {band.max():.1%}, mean {band.mean():.1%}",
        f"missed by more than {MISS:.0%}: {', '.join(missed) or 'nothing'}", "not prescribed, for comparison:",
        _row("Sz", aimed.peak_to_valley, made.peak_to_valley, " m"),
        _row("slope kurtosis", aimed.slope_kurtosis, made.slope_kurtosis, ""),
        f"height distribution: rms difference {_quantile_difference(result, maps):.3f} Sq",
        f"whole scan with all its waves: Sq {whole.std():.4g} m, Ssk {moments(whole)[0]:.3g}, Sku"
        f" {moments(whole)[1]:.3g}; outliers {scan.outliers:.2%}, filled {scan.missing.mean():.2%}"]


def deviation(name, scan, generated):
    """Relative deviation; that of an Ssk near 0 over ``SMALL_SKEWNESS``."""
    return abs(generated - scan) / max(abs(scan), SMALL_SKEWNESS * (name == "Ssk"))


def _row(name, scan, generated, unit):
    return f"{name:<16}{f'{scan:.4g}{unit}':>14}{f'{generated:.4g}{unit}':>14}{deviation(name, scan, generated):>12.1%}"


def _refuse_inconsistent(choice, where):
    """ConfigError for keys of a section Fitted that contradict each other."""
    bands = len(choice.variance_shares)
    if len(choice.wavelengths) != bands + 1 or any(b >= a for a, b in pairwise(choice.wavelengths)):
        raise ConfigError(f"{where}.wavelengths", f"{bands + 1} falling ones, the bounds of {bands} variance_shares",
                          f"{len(choice.wavelengths)}: {', '.join(f'{w:.3g}' for w in choice.wavelengths)} m")
    if not sum(choice.variance_shares) > 0.0:
        raise ConfigError(f"{where}.variance_shares", "some share above 0", "none")
    rows = choice.direction_shares
    if rows is not None and (len(rows) != bands or len({len(row) for row in rows}) > 1):
        raise ConfigError(f"{where}.direction_shares", f"{bands} rows of one length, a row for each band",
                          f"{len(rows)} rows of {', '.join(sorted({str(len(row)) for row in rows}))}")
    heights = choice.height_quantiles
    if heights is not None and (len(heights) != len(SCORES) or any(b < a for a, b in pairwise(heights))):
        raise ConfigError(f"{where}.height_quantiles", f"{len(SCORES)} rising values", f"{len(heights)} values"
                          + ", some falling" * (len(heights) == len(SCORES)))
    least = choice.skewness ** 2 + 1.0
    if choice.kurtosis < least:
        raise ConfigError(f"{where}.kurtosis", f"at least skewness^2 + 1 = {least:.4g}, as of every distribution",
                          f"{choice.kurtosis:.4g}")


def _micrometres(value):
    return f"{1e6 * value:.6g} um"


def _short(values, digits=5):
    values = np.asarray(values)
    return [_short(row, digits) for row in values] if values.ndim > 1 else [float(f"{v:.{digits}g}") for v in values]


def _rounded(value, direction):
    """``value`` with four digits, np.floor or np.ceil of the fifth."""
    unit = 10.0 ** (np.floor(np.log10(value)) - 3)
    return float(f"{direction(round(value / unit, 6)) * unit:.6g}")
