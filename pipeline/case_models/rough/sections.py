"""The section ``surface`` of a case: two bodies, each a scan, a recorded map or a seeded generator."""

from typing import Literal

from pipeline.contract import InputFile, Quantities, Quantity, Section, option
from pipeline.physics.rough.prescribed.heights import SCORES

#: the two surfaces by their sections of the settings
BODIES = ("disc", "pad")

_HEIGHT_UNIT = ("what a metre of the file's heights truly is, where the file states a wrong unit: 1 mm for heights a"
                " thousand times too large; 1 m where an Sq below 1 nm or above 100 um is right")
_SCAN_UNIT = f"what 1 of the file's heights is, where the file states no unit: 1 um; {_HEIGHT_UNIT}"


class ScanFile(Section):
    """A scan and how it is read."""

    file: InputFile = option(..., "scan in any format that SurfaceTopography reads, points x y z or a matrix of"
                                  " heights; measured:PATH for a registered one")
    channel: str | None = option(None, "channel of the file with the heights, where it has several")
    transposed: bool = option(False, "turn the scan by 90 degrees, so that turning marks run along sliding (x)")
    outlier_threshold: float = option(8.0, "local median test: difference over robust scatter that is an outlier", gt=0)
    height_unit: Quantity("m", gt=0) | None = option(None, _SCAN_UNIT)
    lateral_unit: Quantity("m", gt=0) | None = option(None, "what 1 of x and y is in a file of points x y z without a"
                                                            " unit; none = as height_unit")
    pixel_size: Quantity("m", gt=0) | None = option(None, "distance of neighbouring heights along x, where the file"
                                                          " does not state it")
    pixel_size_y: Quantity("m", gt=0) | None = option(None, "the same along y; none = as along x")


class Scan(ScanFile):
    """A measured surface."""

    kind: Literal["scan"] = "scan"
    longest_wavelength: Quantity("m", gt=0) = option("1 mm", "long cut-off: waviness above it is removed")
    rms_height: Quantity("m", gt=0) = option(..., "Sq to which the heights are scaled")
    reason: str = option(..., "why the heights are scaled", min_length=1)


class Recorded(Section):
    """A height map of a recording that covers exactly the patch."""

    kind: Literal["recorded"] = "recorded"
    file: InputFile = option(..., "plain HDF5 in the form that 'brakechain data format' prints")
    run: str = option("new", "its run")
    map: str = option(..., "its height map")
    height_unit: Quantity("m", gt=0) | None = option(None, _HEIGHT_UNIT)


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


class Fitted(Section):
    """A generated surface with the spectrum and the heights of a scan, as 'brakechain surface --fit SCAN' writes it."""

    kind: Literal["fitted"] = "fitted"
    seed: int = option(1, "seed of the generator", ge=0)
    rms_height: Quantity("m", gt=0) = option(..., "Sq, rms height")
    wavelengths: Quantities("m", gt=0) = option(..., "wavelengths that bound the bands of the spectrum, falling")
    variance_shares: Quantities("1", ge=0) = option(..., "share of the height variance in each band")
    direction_shares: tuple[Quantities("1", ge=0), ...] | None = option(
        None, "of each band, shares of sectors of the direction of its waves over half a turn, the first about x"
              " (sliding); none: the same in all directions")
    skewness: float = option(0.0, "Ssk, skewness of the heights")
    kurtosis: float = option(3.0, "Sku, kurtosis of the heights (3 = Gaussian)", gt=1)
    height_quantiles: tuple[float, ...] | None = option(
        None, f"heights over Sq at {len(SCORES)} standard normal quantiles evenly from {SCORES[0]:g} to {SCORES[-1]:g};"
              " none: what Ssk and Sku make of a Gaussian surface")
    tolerance: float = option(0.05, "deviation of Ssk and Sku beyond which a surface is refused", gt=0)


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
    disc: TurnedDisc | Fitted | Scan | Recorded = option(TurnedDisc(), "surface of the disc", discriminator="kind")
    pad: PlateauPad | Fitted | Scan | Recorded = option(PlateauPad(), "surface of the pad", discriminator="kind")


class FitSettings(ScanFile):
    """What a scan is fitted by with 'brakechain surface --fit SCAN', set with --set."""

    body: Literal["disc", "pad"] = option("pad", "body whose section is written")
    patch_length: Quantity("m", gt=0) | None = option(None, "edge of the square patch; none: the largest of the scan")
    shortest_wavelength: Quantity("m", gt=0) | None = option(None, "short cut-off; none: four pixels of the scan")
    longest_wavelength: Quantity("m", gt=0) | None = option(None, "long cut-off: waviness above it is removed; none:"
                                                                  " the patch")
    seeds: int = option(5, "generated surfaces that are compared with the scan", ge=1)
