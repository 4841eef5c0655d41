"""A scan as a section describes it: read, turned, without outliers, holes and form, in its true unit."""

from dataclasses import dataclass

import numpy as np

from pipeline.contract import ConfigError
from pipeline.physics.rough.plausible_scan import in_true_unit, refuse_holes
from pipeline.physics.rough.topography import level, read_scan, remove_outliers


@dataclass(frozen=True)
class Levelled:
    """``heights`` (ny, nx) in m and ``spacing`` (dy, dx) in m; ``missing`` samples (ny, nx); share of ``outliers``."""

    heights: np.ndarray
    spacing: tuple
    missing: np.ndarray
    outliers: float


def levelled(choice, where):
    """Levelled of a section with ``file``, ``transposed``, ``outlier_threshold`` and ``height_unit``.

    ConfigError at ``where`` for unreadable files, mostly holes, or heights of an implausible size.
    """
    scan = read_scan(choice.file)
    heights, spacing = (scan.heights.T, scan.spacing[::-1]) if choice.transposed else (scan.heights, scan.spacing)
    cleaned, outliers = remove_outliers(heights, choice.outlier_threshold)
    missing = np.isnan(cleaned)
    refuse_holes(missing, where)
    return Levelled(in_true_unit(level(cleaned, spacing)[0], choice.height_unit, where), spacing, missing, outliers)


def grey_image(file, where):
    """Grey values (ny, nx) of a picture in any common format. ConfigError at ``where`` for what is no picture."""
    from PIL import Image

    try:
        with Image.open(file) as picture:
            return np.asarray(picture.convert("L"), float)
    except (OSError, ValueError, SyntaxError) as error:
        raise ConfigError(where, "a picture, as PNG or TIFF", f"{file}: {error}", "save it in such a format") from error
