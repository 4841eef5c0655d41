"""What a scan must show before it is taken for a surface: plausible heights, fine pixels, and not mostly holes."""

import numpy as np

from pipeline.contract.errors import ConfigError

#: Sq in m that ground, turned or worn technical surfaces have; beyond it the unit of the heights is asked back
PLAUSIBLE_HEIGHT = (1e-9, 100e-6)
#: share of a map that may be filled between the samples that were measured
MOST_HOLES = 0.5


def in_true_unit(heights, unit, where):
    """Levelled heights (ny, nx) in m, those of a file whose metre is truly ``unit`` m; None where nobody states it.

    Raises ConfigError at ``where`` if the unit is not stated and Sq is below 1 nm or above 100 um.
    """
    if unit is not None:
        return heights * unit
    low, high = PLAUSIBLE_HEIGHT
    height = heights.std()
    if not low <= height <= high:
        factor = next((f for f in (1e-3, 1e3, 1e-6, 1e6) if low <= f * height <= high), None)
        guess = f"height_unit: {'1 m' if factor is None else f'{factor:g} m'}"
        raise ConfigError(where, "an rms height Sq of 1 nm to 100 um", f"{height:.3g} m",
                          f"if the file states a wrong unit, say what a metre of its heights is, such as {guess};"
                          " if its heights are right, say height_unit: 1 m")
    return heights


def refuse_coarse(spacing, shortest, where, remedy):
    """ConfigError at ``where`` if pixels of ``spacing`` (dy, dx) in m do not tell the ``shortest`` wavelength (m)."""
    pixel = max(spacing)
    if 2 * pixel > shortest * (1 + 1e-6):
        raise ConfigError(where, f"pixels of at most {shortest / 2:.3g} m, two a shortest wavelength", f"{pixel:.3g} m",
                          remedy)


def refuse_holes(missing, where):
    """ConfigError at ``where`` if more than half of the samples of a map are ``missing`` (a mask)."""
    share = np.mean(missing)
    if share > MOST_HOLES:
        raise ConfigError(where, f"measured heights on at least {1 - MOST_HOLES:.0%} of the map",
                          f"holes on {share:.0%} of it", "cut the scan to what was measured, or take another one")
