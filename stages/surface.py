"""Stage surface: the two rough surfaces, from scans or seeded generators."""

from functools import partial

import numpy as np

from pipeline.case_models.rough.prescriptions import generated
from pipeline.case_models.rough.scans import levelled
from pipeline.case_models.rough.sections import BODIES, Settings
from pipeline.contract import ConfigError, Context, stage
from pipeline.physics.numerics.memory import refuse_beyond_memory
from pipeline.physics.rough.generator import band_limit, construction_size, plateau_pad, resample, turned_disc
from pipeline.physics.rough.layered_solid import graded_depth
from pipeline.physics.rough.patch import crops, window
from pipeline.physics.rough.plausible_scan import in_true_unit, refuse_coarse, refuse_holes
from pipeline.physics.rough.topography import isotropic_spectrum, statistics, to_grid
from pipeline.physics.rough.worn_depth import without_plane
from pipeline.products import Surface
from pipeline.recordings.neutral import read_neutral

#: largest memory per grid node, measured from 128^2 to 512^2 nodes, and what a pair of maps keeps of it
NODE_BYTES, MAP_BYTES = 180, 32


@stage
def surface(settings: Settings, context: Context) -> Surface:
    """Prepare the rough surfaces of disc and pad, from scans or seeded generators.

    Method:
    Pairs of surfaces: {pairs}. Both surfaces are periodic patches with an edge of {patch_length}, {nodes} nodes per
    edge and no wavelength below {shortest_wavelength}. In scans, outliers were removed by a local median test, holes
    were filled harmonically, the quadratic form was removed, the margins were blended periodically, and heights were
    scaled to the stated rms height. Generated surfaces are a turned disc (tool marks, roughness, grain outbreaks) and
    rough plateaus over a smoother matrix; fitted ones have spectrum and height distribution of a scan, restored in
    turns (Pérez-Ràfols and Almqvist 2019). Recorded maps of the whole patch only lose their mean plane and wavelengths
    below the shortest one.
    """
    spacing = settings.patch_length / settings.nodes
    if settings.shortest_wavelength < 2.0 * spacing:
        raise ConfigError("surface.shortest_wavelength", f"at least two grid spacings ({2.0 * spacing:g} m)",
                          f"{settings.shortest_wavelength:g} m", "raise surface.nodes")
    _refuse_large(settings)
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


def _refuse_large(settings):
    """ConfigError for grids that the memory cannot hold, before they are made."""
    nodes = settings.nodes ** 2
    refuse_beyond_memory(nodes * (NODE_BYTES + MAP_BYTES * settings.pairs), f"{settings.pairs} pairs of maps of"
                         f" {settings.nodes} x {settings.nodes} nodes", "surface.nodes", "lower it, or surface.pairs")
    size = construction_size(settings.patch_length, settings.shortest_wavelength)
    if any(getattr(settings, body).kind in ("generated", "fitted") for body in BODIES):
        refuse_beyond_memory(NODE_BYTES * size ** 2, f"generating a surface on {size} x {size} nodes",
                             "surface.shortest_wavelength", "raise it, or shorten surface.patch_length")


def _make(body, choice, settings):
    """Height maps (pair, y, x) of one body with their source and cleaning shares."""
    if choice.kind == "scan":
        return _measured(body, choice, settings)
    if choice.kind == "recorded":
        if settings.pairs > 1:
            raise ConfigError("surface.pairs", "1, as a recorded map covers exactly the patch", str(settings.pairs))
        return _recorded(body, choice, settings)
    if choice.kind == "fitted":
        return _generated(choice, settings, "fitted", partial(generated, choice, where=f"surface.{body}"))
    generate = turned_disc if body == "disc" else plateau_pad
    values = choice.model_dump(exclude={"kind", "seed"})
    return _generated(choice, settings, generate.__name__, partial(generate, **values))


def _generated(choice, settings, name, generate):
    """Maps of a generator, one for each pair, which differ in their seeds."""
    height = [generate(nodes=settings.nodes, length=settings.patch_length, shortest=settings.shortest_wavelength,
                       seed=_seed(choice.seed, pair)) for pair in range(settings.pairs)]
    further = f" and {settings.pairs - 1} further" if settings.pairs > 1 else ""
    return {"height": np.array(height), "source": f"generated: {name}, seed {choice.seed}{further}", "outliers": 0.0,
            "filled": 0.0}


def _seed(seed, pair):
    """Seed of the pair of this number; the first has that of the case, others share none with any other case."""
    return seed if pair == 0 else [seed, pair]


def _measured(body, choice, settings):
    where = f"surface.{body}: {choice.file}"
    scan = levelled(choice, where)
    shape, spacing = scan.heights.shape, scan.spacing
    places = crops(shape, spacing, settings.patch_length, settings.pairs, f"surface.pairs: {choice.file}")
    height = [to_grid(scan.heights, spacing, settings.patch_length, settings.nodes, settings.shortest_wavelength,
                      choice.longest_wavelength, choice.rms_height, where, place)
              for place in places]
    for place in places:
        patch = window(shape, spacing, settings.patch_length, place=place)
        refuse_holes(scan.missing[tuple(slice(first, first + count) for first, count, _ in patch)], f"{where}: patch")
    source = choice.file.name + f" ({scan.told})" * bool(scan.told)
    return {"height": np.array(height), "source": source, "outliers": scan.outliers,
            "filled": scan.missing.mean()}


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
    refuse_coarse((scan.y[1], scan.x[1]), settings.shortest_wavelength, f"{where}.map",
                  "raise surface.shortest_wavelength, or take a finer map")
    heights = in_true_unit(without_plane(scan.height), choice.height_unit, f"{where}.map")
    height = resample(band_limit(heights, (settings.patch_length,) * 2, settings.shortest_wavelength),
                      (settings.nodes,) * 2)
    return {"height": height[None], "source": f"{choice.file.name}: {choice.run}/{choice.map}", "outliers": 0.0,
            "filled": 0.0}
