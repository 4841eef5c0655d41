"""A scan as a section describes it: read, turned, without outliers, holes and form, in its true unit; and pictures.

Files are read in a process of their own.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from pipeline.case_models.rough.bare_scans import scaled
from pipeline.contract import ConfigError
from pipeline.contract.received.process import answered
from pipeline.physics.rough.plausible_scan import in_true_unit, refuse_holes
from pipeline.physics.rough.topography import Scan, UnscaledScan, level, read_scan, remove_outliers

_HELD = "held.npz"
#: what a section states of a scan that does not state it itself
_STATED = ("height_unit", "lateral_unit", "pixel_size", "pixel_size_y")


@dataclass(frozen=True)
class Levelled:
    """``heights`` (ny, nx) in m and ``spacing`` (dy, dx) in m; ``missing`` samples (ny, nx); share of ``outliers``;
    ``told``: what of the file they are, where that is a choice."""

    heights: np.ndarray
    spacing: tuple
    missing: np.ndarray
    outliers: float
    told: str = ""


def levelled(choice, where):
    """Levelled of a section ScanFile.

    ConfigError at ``where`` for unreadable files, what they do not state, mostly holes, or heights of an implausible
    size.
    """
    stated = {name: getattr(choice, name) for name in _STATED}
    scan, bare = answered(f"{__name__}:leave_scan", choice.file, _scan, where=where, channel=choice.channel,
                          stated=stated)
    heights, spacing = (scan.heights.T, scan.spacing[::-1]) if choice.transposed else (scan.heights, scan.spacing)
    cleaned, outliers = remove_outliers(heights, choice.outlier_threshold)
    missing = np.isnan(cleaned)
    refuse_holes(missing, where)
    flat = level(cleaned, spacing)[0]
    true = flat if bare else in_true_unit(flat, choice.height_unit, where)
    return Levelled(true, spacing, missing, outliers, scan.told)


def leave_scan(path, folder, where, channel, stated):
    """In the child process: read a scan and leave it in ``folder``."""
    bare = False
    try:
        scan = read_scan(path, channel)
    except UnscaledScan as error:
        scan, bare = scaled(path, error.heights, stated, where, error), True
    needless = [] if bare else [name for name in _STATED[1:] if stated[name] is not None]
    if needless:
        raise ConfigError(f"{where}: {needless[0]}", "none, as the file states its size: pixels of"
                          f" {scan.spacing[1]:.4g} m", f"{stated[needless[0]]:g} m",
                          f"leave {' and '.join(needless)} out")
    np.savez(Path(folder) / _HELD, heights=scan.heights, spacing=scan.spacing, told=scan.told, bare=bare)


def _scan(folder):
    """(Scan, whether its unit is that of the section)."""
    with np.load(folder / _HELD) as held:
        return Scan(held["heights"], tuple(held["spacing"]), str(held["told"])), bool(held["bare"])


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
