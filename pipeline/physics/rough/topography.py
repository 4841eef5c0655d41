"""Measured surfaces: read, clean, level, make periodic; roughness statistics and spectrum.

The one door of SurfaceTopography. Maps are (ny, nx) in m, NaN where the instrument saw nothing.
"""

import contextlib
import io
import logging
import re
import warnings
from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.rough.generator import band_limit, resample
from pipeline.physics.rough.patch import periodic_patch
from pipeline.physics.rough.plausible_scan import refuse_coarse
from pipeline.physics.rough.prescribed.heights import moments

#: formats of text
_TEXT = ("asc", "xyz", "matrix")
#: a format of elevations that has no head: any file of 2 n^2 bytes, also of text, is taken for one
_BY_SIZE = "hgt"
_LIKELY = re.compile(r"topo|height|z\b", re.IGNORECASE)
#: median absolute deviation to standard deviation of Gaussian scatter
MAD_TO_RMS = 1.4826


class UnscaledScan(ConfigError):
    """A file that may be a scan, but states no unit or no size; ``heights`` (row, column) as it has them, or None."""

    def __init__(self, *parts, heights=None):
        super().__init__(*parts)
        self.heights = heights


@dataclass(frozen=True)
class Scan:
    """Measured ``heights`` (ny, nx) in m with NaN where missing, and ``spacing`` (dy, dx) in m; ``told``: what of the
    file they are, where that is a choice."""

    heights: np.ndarray
    spacing: tuple
    told: str = ""


@dataclass(frozen=True)
class Statistics:
    """ISO 25178 parameters: rms Sq, mean Sa, peak to valley Sz in m; skewness Ssk, kurtosis Sku, rms slope Sdq."""

    rms_height: float
    mean_height: float
    peak_to_valley: float
    skewness: float
    kurtosis: float
    rms_slope: float


def read_scan(path, channel=None):
    """Scan of any file that SurfaceTopography reads (x3p, sur, opd, al3d, plu, dat, nc, ...), heights outwards.

    ``channel``: name of that with the heights, where a file has several. Raises ConfigError that names the file when it
    is unreadable, holds no or constant heights, or several channels of which none is stated; UnscaledScan where it
    states no unit or size.
    """
    where = f"scan {path}"
    with _quiet_readers():
        topography, told = _open(path, where, channel)
        heights = np.ma.filled(np.ma.asarray(topography.heights(), dtype=float), np.nan).T
        size_x, size_y = topography.physical_sizes
    if not np.isfinite(heights).any():
        raise ConfigError(where, "measured heights", "no value that is a number", "choose another scan")
    _refuse_constant(heights, where)
    return Scan(heights, (size_y / heights.shape[0], size_x / heights.shape[1]), told)


def remove_outliers(heights, threshold, window=5):
    """(heights with NaN at outliers, their share): a local median test.

    A sample is an outlier when it differs from the median of its ``window`` x ``window`` neighbours by more than
    ``threshold`` times the robust scatter of such differences. A pit wider than half the window moves the
    median with it and stays, however deep; a spike does not.
    """
    missing = np.isnan(heights)
    nearest = scipy.ndimage.distance_transform_edt(missing, return_distances=False, return_indices=True)
    complete = heights[tuple(nearest)]
    difference = np.abs(complete - scipy.ndimage.median_filter(complete, window, mode="nearest"))
    scatter = MAD_TO_RMS * np.median(difference[~missing])
    if scatter == 0.0:
        scatter = difference[~missing].std()
    outlier = ~missing & (difference > threshold * scatter)
    return np.where(outlier, np.nan, heights), outlier.mean()


def level(heights, spacing):
    """(heights without holes and form, share of samples filled): harmonic filling, then a quadratic form removed."""
    missing = np.isnan(heights)
    with _quiet_readers():
        topography = _topography(np.ma.masked_invalid(heights), spacing, periodic=False)
        if missing.any():
            topography = topography.interpolate_undefined_data_with_harmonic_function()
        levelled = np.ma.filled(topography.detrend("curvature").heights(), np.nan).T
    return levelled, missing.mean()


def to_grid(heights, spacing, length, nodes, shortest, longest, rms_height, where, place=(0.5, 0.5)):
    """Periodic map (nodes, nodes) of a levelled scan in the band ``shortest`` to ``longest``, of rms ``rms_height``, at
    a ``place`` (see ``periodic_patch``).

    ConfigError at ``where`` for a scan whose pixels do not tell the shortest wavelength, or without height.
    """
    refuse_coarse(spacing, shortest, where, "raise surface.shortest_wavelength, or take a finer scan")
    patch = periodic_patch(heights - heights.mean(), spacing, length, place=place)
    filtered = resample(band_limit(patch, (length, length), shortest, longest), (nodes, nodes))
    _refuse_constant(filtered, where)
    return filtered * (rms_height / filtered.std())


def statistics(heights, spacing):
    """Statistics of a periodic map (ny, nx)."""
    centred = heights - heights.mean()
    with _quiet_readers():
        topography = _topography(centred, spacing, periodic=True)
        rms, slope = topography.rms_height_from_area(), topography.rms_gradient()
    return Statistics(rms, np.abs(centred).mean(), np.ptp(centred), *moments(centred), slope)


def isotropic_spectrum(heights, spacing):
    """(wavenumber rad/m, power spectrum m^4) of a periodic map, averaged over directions; empty bins left out."""
    with _quiet_readers():
        wave, power = _topography(heights, spacing, periodic=True).power_spectrum_from_area()
    filled = ~(np.ma.getmaskarray(wave) | np.ma.getmaskarray(power)) & np.isfinite(np.ma.getdata(power))
    return np.ma.getdata(wave)[filled], np.ma.getdata(power)[filled]


def _open(path, where, name):
    """(topography in m, what of the file it is) of the only channel of heights, or of that called ``name``."""
    from SurfaceTopography import open_topography
    from SurfaceTopography.IO import CannotDetectFileFormat, ReadFileError

    remedy = "check the file; 'SurfaceTopography' lists the formats it reads"
    try:
        reader = open_topography(str(path))
        if reader.format() == _BY_SIZE and not str(path).lower().endswith(_BY_SIZE):
            raise CannotDetectFileFormat
        channel, told = _channel(reader, name, where)
        if channel.unit is None or channel.physical_sizes is None:
            raise UnscaledScan(where, "a map with its length unit", "no unit or no size", "state pixel_size and"
                               " height_unit", heights=_as_held(reader, channel))
        return channel.topography().to_unit("m"), told
    except CannotDetectFileFormat:
        raise UnscaledScan(where, "a surface scan", "no format that is known", remedy) from None
    except (ReadFileError, ValueError, EOFError, OSError, IndexError) as error:
        raise ConfigError(where, "a surface scan", (str(error).splitlines() or ["nothing"])[0][:120], remedy) from None


def _channel(reader, name, where):
    """(channel of a file, what of it this is): the only one of heights, or that called ``name``."""
    from SurfaceTopography.IO.Reader import DataKind

    maps = [c for c in reader.channels if c.dim == 2 and min(c.nb_grid_pts or (2,)) > 1]
    names = [c.name if [d.name for d in maps].count(c.name) == 1 else f"{c.name} ({c.index + 1})" for c in maps]
    heights = {n: c for n, c in zip(names, maps, strict=True)
               if c.data_kind is DataKind.HEIGHT and not (isinstance(c.data_unit, tuple) and None in c.data_unit)}
    if not heights:
        others = ", ".join(c.name for c in reader.channels) or "none"
        raise ConfigError(where, "a surface scan with a map of heights", others, "choose another scan")
    if name is None and len(heights) > 1:
        likely = next((n for n in heights if _LIKELY.match(n)), next(iter(heights)))
        raise ConfigError(f"{where}: channel", "one channel of heights", f"{len(heights)}: {', '.join(heights)}",
                          f"state which one holds the topography, such as channel: {likely}")
    name = next(iter(heights)) if name is None else name
    if name not in heights:
        raise ConfigError(f"{where}: channel", f"a channel of heights, one of {', '.join(heights)}", repr(name))
    return heights[name], f"channel {name}" * (len(maps) > 1)


def _as_held(reader, channel):
    """Heights (row, column) as a file of one array holds them, whose rows lie along y; None of text."""
    if reader.format() in _TEXT:
        return None
    topography = channel.topography(**({} if channel.physical_sizes else {"physical_sizes": channel.nb_grid_pts}))
    return np.ma.filled(np.ma.asarray(topography.heights(), dtype=float), np.nan)


def _topography(heights, spacing, periodic):
    from SurfaceTopography import Topography

    size = (heights.shape[1] * spacing[1], heights.shape[0] * spacing[0])
    return Topography(heights.T, size, unit="m", periodic=periodic)


def _refuse_constant(heights, where):
    span, size = np.nanmax(heights) - np.nanmin(heights), np.nanmax(np.abs(heights))
    if not span > 1e-12 * size:
        raise ConfigError(where, "heights that vary", f"a constant surface at {np.nanmean(heights):g} m",
                          "choose another scan or longer cut-off")


@contextlib.contextmanager
def _quiet_readers():
    """Readers that try formats in turn print, log, warn and leave files open: none of it concerns the user."""
    before = logging.root.manager.disable
    logging.disable(logging.CRITICAL)
    try:
        with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):
            warnings.simplefilter("ignore")
            yield
    finally:
        logging.disable(before)
