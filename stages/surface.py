"""Stage surface: the two rough surfaces, from scans or seeded generators."""

from typing import Literal

import numpy as np

from pipeline.contract import ConfigError, Context, InputFile, Quantity, Section, option, stage
from pipeline.physics.rough.generator import band_limit, plateau_pad, resample, turned_disc
from pipeline.physics.rough.layered_solid import graded_depth
from pipeline.physics.rough.topography import (
    crops,
    isotropic_spectrum,
    level,
    read_scan,
    remove_outliers,
    statistics,
    to_grid,
)
from pipeline.physics.rough.worn_depth import without_plane
from pipeline.products import Surface
from pipeline.recordings.neutral import read_neutral

#: the two surfaces by their sections of the settings
BODIES = ("disc", "pad")


class Scan(Section):
    """A measured surface."""

    kind: Literal["scan"] = "scan"
    file: InputFile = option(..., "scan in any format that SurfaceTopography reads; measured:PATH for a registered one")
    transposed: bool = option(False, "turn the scan by 90 degrees, so that turning marks run along sliding (x)")
    outlier_threshold: float = option(8.0, "local median test: difference over robust scatter that is an outlier", gt=0)
    longest_wavelength: Quantity("m", gt=0) = option("1 mm", "long cut-off: waviness above it is removed")
    rms_height: Quantity("m", gt=0) = option(..., "Sq to which the heights are scaled")
    reason: str = option(..., "why the heights are scaled", min_length=1)


class Recorded(Section):
    """A height map of a recording that covers exactly the patch."""

    kind: Literal["recorded"] = "recorded"
    file: InputFile = option(..., "plain HDF5 in the form that 'brakechain data format' prints")
    run: str = option("new", "its run")
    map: str = option(..., "its height map")


class TurnedDisc(Section):
    """A generated turned cast-iron disc."""

    kind: Literal["generated"] = "generated"
    seed: int = option(1, "seed of the generator", ge=0)
    rms_height: Quantity("m", gt=0) = option("3.5 um", "Sq, rms height")
    feed: Quantity("m", gt=0) = option("250 um", "feed of the turning tool; a whole number of feeds fits the patch")
    marks_share: float = option(0.9, "share of the height variance in the turning marks", ge=0, le=1)
    roughness_wavelength: Quantity("m", gt=0) = option("250 um", "roll-off wavelength of the roughness")
    hurst: float = option(0.8, "Hurst exponent of the roughness", ge=0, le=1)
    outbreak_share: float = option(0.03, "share of the area with grain outbreaks", ge=0, lt=1)
    outbreak_size: Quantity("m", gt=0) = option("80 um", "diameter of a grain outbreak")
    outbreak_depth: float = option(3.0, "depth of an outbreak over the rms of the rest", ge=0)


class PlateauPad(Section):
    """A generated brake pad."""

    kind: Literal["generated"] = "generated"
    seed: int = option(2, "seed of the generator", ge=0)
    rms_height: Quantity("m", gt=0) = option("3.8 um", "Sq, rms height")
    plateau_share: float = option(0.25, "share of the area in plateaus", gt=0, lt=1)
    plateau_size: Quantity("m", gt=0) = option("250 um", "distance between plateaus")
    plateau_height: float = option(1.0, "plateau above matrix over the rms of the matrix")
    plateau_roughness: float = option(6.0, "rms of plateaus over rms of the matrix", ge=0)
    edge_width: float = option(0.2, "width of the plateau edges in the generating field", gt=0)
    roughness_wavelength: Quantity("m", gt=0) = option("250 um", "roll-off wavelength of the roughness")
    hurst: float = option(0.8, "Hurst exponent of the roughness", ge=0, le=1)


class Settings(Section):
    """Rough surfaces and the depth grading of their solids."""

    nodes: int = option(128, "grid nodes along each edge of the patch", ge=8)
    patch_length: Quantity("m", gt=0) = option("1 mm", "edge of the square periodic patch")
    shortest_wavelength: Quantity("m", gt=0) = option("62.5 um", "short cut-off; put 8 or more nodes on it")
    disc_thickness: Quantity("m", gt=0) = option("1 mm", "depth of the disc block under its surface")
    pad_thickness: Quantity("m", gt=0) = option("1 mm", "depth of the pad block under its surface")
    layer_growth: float = option(1.5, "thickness ratio of neighbouring FE layers; the first is a grid cube", ge=1)
    pairs: int = option(1, "pairs of surfaces: generated ones of further seeds, crops of a scan at other places; what"
                           " differs between them is the error of every result for one of them", ge=1)
    bodies: tuple[str, str] = option(BODIES, "names of the bodies in the report, that of 'pad' last")
    disc: TurnedDisc | Scan | Recorded = option(TurnedDisc(), "surface of the disc", discriminator="kind")
    pad: PlateauPad | Scan | Recorded = option(PlateauPad(), "surface of the pad", discriminator="kind")


@stage
def surface(settings: Settings, context: Context) -> Surface:
    """Prepare the rough surfaces of disc and pad, from scans or seeded generators.

    Method:
    Pairs of surfaces: {pairs}. Both surfaces are periodic patches with an edge of {patch_length}, {nodes} nodes per
    edge and no wavelength below {shortest_wavelength}. In scans, outliers were removed by a local median test, holes
    were filled harmonically, the quadratic form was removed, the margins were blended periodically, and heights were
    scaled to the stated rms height. Generated surfaces are a turned disc (tool marks, roughness, grain outbreaks) and
    rough plateaus over a smoother matrix. Recorded maps of the whole patch only lose their mean plane and wavelengths
    below the shortest one.
    """
    spacing = settings.patch_length / settings.nodes
    if settings.shortest_wavelength < 2.0 * spacing:
        raise ConfigError("surface.shortest_wavelength", f"at least two grid spacings ({2.0 * spacing:g} m)",
                          f"{settings.shortest_wavelength:g} m", "raise surface.nodes")
    made = [_make(body, getattr(settings, body), settings) for body in BODIES]
    heights = [m["height"] for m in made]
    figures = [[statistics(h, (spacing, spacing)) for h in maps] for maps in heights]
    spectra = [[isotropic_spectrum(h, (spacing, spacing)) for h in maps] for maps in heights]
    position = np.arange(settings.nodes) * spacing
    return Surface(
        x=position, y=position, disc_height=heights[0], pad_height=heights[1],
        disc_depth=graded_depth(spacing, settings.disc_thickness, settings.layer_growth),
        pad_depth=graded_depth(spacing, settings.pad_thickness, settings.layer_growth),
        body=settings.bodies, source=[m["source"] for m in made],
        outlier_share=[m["outliers"] for m in made], filled_share=[m["filled"] for m in made],
        shortest_wavelength=[settings.shortest_wavelength] * 2,
        nodes_per_wavelength=[settings.shortest_wavelength / spacing] * 2,
        wavenumber=spectra[0][0][0], power_spectrum=[np.mean([power for _, power in maps], axis=0) for maps in spectra],
        **{name: [np.mean([getattr(f, name) for f in maps]) for maps in figures] for name in
           ("rms_height", "mean_height", "peak_to_valley", "skewness", "kurtosis", "rms_slope")})


def _make(body, choice, settings):
    """Height maps (pair, y, x) of one body with their source and cleaning shares."""
    if choice.kind == "scan":
        return _measured(body, choice, settings)
    if choice.kind == "recorded":
        if settings.pairs > 1:
            raise ConfigError("surface.pairs", "1, as a recorded map covers exactly the patch", str(settings.pairs))
        return _recorded(body, choice, settings)
    generate = turned_disc if body == "disc" else plateau_pad
    values = choice.model_dump(exclude={"kind", "seed"})
    height = [generate(settings.nodes, settings.patch_length, settings.shortest_wavelength, **values,
                       seed=_seed(choice.seed, pair)) for pair in range(settings.pairs)]
    further = f" and {settings.pairs - 1} further" if settings.pairs > 1 else ""
    source = f"generated: {generate.__name__}, seed {choice.seed}{further}"
    return {"height": np.array(height), "source": source, "outliers": 0.0, "filled": 0.0}


def _seed(seed, pair):
    """Seed of the pair of this number; the first has that of the case, others share none with any other case."""
    return seed if pair == 0 else [seed, pair]


def _measured(body, choice, settings):
    scan = read_scan(choice.file)
    heights, spacing = (scan.heights.T, scan.spacing[::-1]) if choice.transposed else (scan.heights, scan.spacing)
    cleaned, outliers = remove_outliers(heights, choice.outlier_threshold)
    levelled, filled = level(cleaned, spacing)
    places = crops(heights.shape, spacing, settings.patch_length, settings.pairs, f"surface.pairs: {choice.file}")
    height = [to_grid(levelled, spacing, settings.patch_length, settings.nodes, settings.shortest_wavelength,
                      choice.longest_wavelength, choice.rms_height, f"surface.{body}: {choice.file}", place)
              for place in places]
    return {"height": np.array(height), "source": choice.file.name, "outliers": outliers, "filled": filled}


def _recorded(body, choice, settings):
    runs, where = read_neutral(choice.file), f"surface.{body}"
    maps = runs[choice.run].topography if choice.run in runs else {}
    if choice.map not in maps:
        raise ConfigError(f"{where}.map", f"one of {', '.join(maps) or 'no map'} in run {choice.run} of"
                          f" {', '.join(runs)}", choice.map)
    scan = maps[choice.map]
    length = [2 * axis[-1] - axis[-2] for axis in (scan.y, scan.x)]
    if not np.allclose(length, settings.patch_length, rtol=1e-6):
        raise ConfigError(f"{where}.map", f"the whole patch, {settings.patch_length:g} m",
                          f"{length[0]:g} by {length[1]:g} m", "set surface.patch_length, or use kind: scan")
    levelled = without_plane(scan.height)
    height = resample(band_limit(levelled, (settings.patch_length,) * 2, settings.shortest_wavelength),
                      (settings.nodes,) * 2)
    return {"height": height[None], "source": f"{choice.file.name}: {choice.run}/{choice.map}", "outliers": 0.0,
            "filled": 0.0}
