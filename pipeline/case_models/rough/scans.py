"""A scan as a section describes it: read, turned, without outliers, holes and form, in its true unit; and pictures.

Files are read in a process of their own.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from pipeline.contract import ConfigError
from pipeline.contract.received.process import answered
from pipeline.physics.rough.plausible_scan import in_true_unit, refuse_holes
from pipeline.physics.rough.topography import Scan, level, read_scan, remove_outliers

_HELD = "held.npz"


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
    scan = answered(f"{__name__}:leave_scan", choice.file, _scan)
    heights, spacing = (scan.heights.T, scan.spacing[::-1]) if choice.transposed else (scan.heights, scan.spacing)
    cleaned, outliers = remove_outliers(heights, choice.outlier_threshold)
    missing = np.isnan(cleaned)
    refuse_holes(missing, where)
    return Levelled(in_true_unit(level(cleaned, spacing)[0], choice.height_unit, where), spacing, missing, outliers)


def leave_scan(path, folder):
    """In the child process: read a scan and leave it in ``folder``."""
    scan = read_scan(path)
    np.savez(Path(folder) / _HELD, heights=scan.heights, spacing=scan.spacing)


def _scan(folder):
    with np.load(folder / _HELD) as held:
        return Scan(held["heights"], tuple(held["spacing"]))


def grey_image(file, where):
    """Grey values (ny, nx) of a picture in any common format. ConfigError at ``where`` for what is no picture."""
    return answered(f"{__name__}:leave_image", file, _image, where=where)


def leave_image(file, folder, where):
    """In the child process: read a picture and leave its grey values in ``folder``."""
    from PIL import Image

    try:
        with Image.open(file) as picture:
            np.savez(Path(folder) / _HELD, grey=np.asarray(picture.convert("L")))
    except (OSError, ValueError, SyntaxError) as error:
        raise ConfigError(where, "a picture, as PNG or TIFF", f"{file}: {error}", "save it in such a format") from error


def _image(folder):
    with np.load(folder / _HELD) as held:
        return held["grey"].astype(float)
