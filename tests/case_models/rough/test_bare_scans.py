"""Points and matrices of heights without unit, as profilometers, libraries and spreadsheets write them."""

import io

import numpy as np
import pandas
import pytest
from scipy.io import savemat

from pipeline.case_models.rough.scans import levelled
from pipeline.case_models.rough.sections import Scan
from pipeline.contract import ConfigError
from pipeline.contract.received import process
from pipeline.contract.settings import fill
from pipeline.physics.rough.generator import self_affine

HEIGHTS = self_affine(np.random.default_rng(3), 48, 48e-6, 8e-6, 30e-6, 0.8)[:32] + np.sin(np.arange(48) / 4)
HOLED = np.where((np.indices(HEIGHTS.shape) == np.array([5, 7])[:, None, None]).all(axis=0), np.nan, HEIGHTS)
Y, X = (axis.ravel() for axis in np.meshgrid(2.0 * np.arange(32), 0.5 * np.arange(48), indexing="ij"))
POINTS = np.column_stack([X, Y, HEIGHTS.ravel()])
PIXELS = {"pixel_size": "0.5 um", "pixel_size_y": "2 um", "height_unit": "1 um"}
SHUFFLED = np.random.default_rng(0).permutation(len(POINTS))


@pytest.fixture(autouse=True)
def in_this_process(monkeypatch):
    """The reader of scans without a process of its own."""
    def started(reader, path, folder, limits, given):
        process.leave(reader, path, folder, limits.memory, given)
        return 0

    monkeypatch.setattr(process, "started", started)


def read(path, **stated):
    given = {"file": str(path), "rms_height": "1 um", "reason": "test", "outlier_threshold": 1e9, **stated}
    return levelled(fill(Scan, given, "pad"), "pad")


def text(values, **how):
    stream = io.StringIO()
    np.savetxt(stream, values, **{"fmt": "%.5f", **how})
    return stream.getvalue()


def spreadsheet(values, **how):
    stream = io.StringIO()
    pandas.DataFrame(values).to_csv(stream, header=False, index=False, **how)
    return stream.getvalue()


def the_map(scan, missing=0):
    """The scan is HEIGHTS in um, but for the form that is taken off, to which a filled sample adds a little."""
    assert scan.heights.shape == HEIGHTS.shape and scan.spacing == pytest.approx((2e-6, 0.5e-6))
    assert scan.missing.sum() == missing
    y, x = np.indices(HEIGHTS.shape) / 32
    form = np.stack([np.ones_like(x), x, y, x * y, x**2, y**2], -1).reshape(-1, 6)
    left = HEIGHTS.ravel() - form @ np.linalg.lstsq(form, HEIGHTS.ravel(), rcond=None)[0]
    measured = ~scan.missing.ravel()
    np.testing.assert_allclose(1e6 * scan.heights.ravel()[measured], left[measured], atol=2e-3 if missing else 1e-4)


@pytest.mark.parametrize("content", [
    text(HEIGHTS), text(HEIGHTS, delimiter="\t"), text(HEIGHTS, delimiter=","),
    spreadsheet(HEIGHTS, sep=";", decimal=","), text(HEIGHTS, delimiter=",").replace("\n", ",\n"),
    "Instrument X\n\n" + text(HEIGHTS)])
def test_a_matrix_has_its_rows_along_y(tmp_path, content):
    (tmp_path / "a.txt").write_text(content)
    the_map(read(tmp_path / "a.txt", **PIXELS))
    turned = read(tmp_path / "a.txt", transposed=True, **PIXELS)
    assert turned.heights.shape == (48, 32) and turned.spacing == pytest.approx((0.5e-6, 2e-6))


@pytest.mark.parametrize("content", [
    text(HOLED), spreadsheet(HOLED), spreadsheet(HOLED, sep="\t", na_rep="BAD"),
    spreadsheet(HOLED, sep=";", decimal=",")])
def test_heights_that_are_missing_are_filled(tmp_path, content):
    (tmp_path / "a.csv").write_text(content)
    scan = read(tmp_path / "a.csv", **PIXELS)
    the_map(scan, missing=1)
    assert scan.missing[5, 7] and "rows along y, pixels of 5e-07 m along x and 2e-06 m along y" in scan.told


@pytest.mark.parametrize("content", [
    text(POINTS), text(POINTS[SHUFFLED], delimiter=";"), text(POINTS[np.lexsort((Y, X))], header="x y z"),
    pandas.DataFrame(POINTS[SHUFFLED], columns=["x", "y", "z"]).to_csv(index=False, sep=";", decimal=",")])
def test_points_lie_on_a_grid_in_any_order(tmp_path, content):
    (tmp_path / "a.xyz").write_text(content)
    the_map(read(tmp_path / "a.xyz", height_unit="1 um"))


def test_points_may_be_missing_and_have_units_in_their_head(tmp_path):
    scaled = np.delete(POINTS, [5 * 48 + 7], 0)[SHUFFLED[len(POINTS) - 1 > SHUFFLED]] * [1e-3, 1e-3, 1.0]
    (tmp_path / "a.csv").write_text("X (mm),Y (mm),Z (um)\n" + text(scaled, fmt="%.7f", delimiter=","))
    the_map(read(tmp_path / "a.csv"), missing=1)
    (tmp_path / "b.xyz").write_text(text(scaled, fmt="%.7f"))
    the_map(read(tmp_path / "b.xyz", height_unit="1 um", lateral_unit="1 mm"), missing=1)


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")      # the reader leaves its file open
@pytest.mark.parametrize("suffix", ["npy", "mat"])
def test_arrays(tmp_path, suffix):
    path = tmp_path / f"a.{suffix}"
    np.save(path, HEIGHTS) if suffix == "npy" else savemat(path, {"Z": HEIGHTS, "x": 0.5 * np.arange(48)})
    the_map(read(path, **PIXELS))


@pytest.mark.parametrize("content, stated, told", [
    (text(HEIGHTS), {}, "pad: expected the distance of neighbouring heights .* found a matrix of 32 rows .y. of 48"
                        " heights .* state pixel_size: 2 um and height_unit: 1 um"),
    (text(HEIGHTS), {"height_unit": "1 um"}, "state pixel_size: 2 um, say"),
    (text(HEIGHTS), {**PIXELS, "lateral_unit": "1 um"}, "pad: lateral_unit: expected pixel_size alone"),
    (text(POINTS), {}, "the unit of points x y z, .* found 1536 points .* from line 1: '0.0.* state height_unit: 1 um"),
    (text(POINTS), {"height_unit": "1 um", "pixel_size": "2 um"}, "pixel_size: expected none, as the points have"),
    (text(POINTS + np.random.default_rng(1).uniform(0, 0.3, (1536, 3))), {"height_unit": "1 um"},
     "points on a regular grid along x and y, .* interpolate the cloud onto a grid"),
    (text(np.vstack([POINTS, POINTS[:3]])), {"height_unit": "1 um"}, "one point at each place of a grid, found 3"),
    ("a word\nand another\n", {}, "expected a surface scan"),
    (text(HEIGHTS).replace("\n", "\nxx yy\n", 1), PIXELS, r"a.txt:2: expected 48 numbers, found 'xx yy'"),
    (text(0 * HEIGHTS), PIXELS, "heights that vary, found a constant surface")])
def test_what_is_not_clear_is_asked_for(tmp_path, content, stated, told):
    (tmp_path / "a.txt").write_text(content)
    with pytest.raises(ConfigError, match=told):
        read(tmp_path / "a.txt", **stated)


def test_a_file_with_its_size_needs_no_pixels(tmp_path):
    head = "# Channel: Main\n# Width: 24 um\n# Height: 64 um\n# Value units: um\n"
    (tmp_path / "a.txt").write_text(head + text(HEIGHTS))
    the_map(read(tmp_path / "a.txt"))
    with pytest.raises(ConfigError, match="pixel_size: expected none, as the file states its size: pixels of 5e-07 m"):
        read(tmp_path / "a.txt", **PIXELS)


def test_text_of_as_many_bytes_as_a_map_of_elevations_is_text(tmp_path):
    """Files of elevations (hgt) have no head: any file of 2 n^2 bytes may be one."""
    content = text(HEIGHTS)
    side = int(np.ceil(np.sqrt(len(content) / 2)))
    (tmp_path / "a.txt").write_text(content + "\n" * (2 * side**2 - len(content)))
    the_map(read(tmp_path / "a.txt", **PIXELS))
