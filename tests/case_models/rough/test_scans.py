"""A scan as its section describes it."""

import numpy as np
import pytest

from pipeline.case_models.rough.scans import grey_image, levelled
from pipeline.case_models.rough.sections import Scan
from pipeline.contract import ConfigError
from pipeline.physics.rough.generator import self_affine

ROUGH = 1e-6 * self_affine(np.random.default_rng(3), 64, 64e-6, 8e-6, 30e-6, 0.8)


def scan(path, heights, **more):
    head = f"# Channel: Topography\n# Width: {heights.shape[1]} um\n# Height: {heights.shape[0]} um\n# Value units: m\n"
    path.write_text(head + "\n".join(" ".join(f"{v:.6e}" for v in row) for row in heights))
    return Scan(file=str(path), rms_height="1 um", reason="test", **more)


def test_a_scan_is_turned_cleaned_and_levelled(tmp_path):
    dirty = ROUGH[:48].copy()
    dirty[7, 9] += 1e-4
    made = levelled(scan(tmp_path / "a.txt", dirty, transposed=True), "here")
    assert made.heights.shape == (64, 48) and made.spacing == pytest.approx((1e-6, 1e-6))
    assert made.missing[9, 7] and made.outliers == pytest.approx(1 / dirty.size)
    assert abs(made.heights.mean()) < 1e-9


def test_units_and_holes_are_refused_at_the_section(tmp_path):
    with pytest.raises(ConfigError, match="^here: expected an rms height"):
        levelled(scan(tmp_path / "mm.txt", 1e3 * ROUGH), "here")
    assert levelled(scan(tmp_path / "mm.txt", 1e3 * ROUGH, height_unit="1 mm"), "here").heights.std() < 1e-5
    holed = np.where(np.arange(64)[:, None] < 40, np.nan, ROUGH)
    with pytest.raises(ConfigError, match="^here: expected measured heights"):
        levelled(scan(tmp_path / "holes.txt", holed), "here")


def test_what_is_no_picture_is_told(tmp_path):
    (tmp_path / "lining.png").write_text("no picture")
    with pytest.raises(ConfigError, match="a picture, as PNG or TIFF"):
        grey_image(tmp_path / "lining.png", "micro_friction.pad.inclusions.image")


def test_a_damaged_scan_ends_with_the_process_that_reads_it(tmp_path):
    """A MATLAB file inside out stops some readers of scans with errors that are none of a scan."""
    from scipy.io import savemat

    savemat(tmp_path / "a.mat", {"x": ROUGH})
    content = (tmp_path / "a.mat").read_bytes()
    for k in range(130, 190, 12):
        (tmp_path / "a.mat").write_bytes(content[:k] + b"\xff" * 8 + content[k + 8:])
        with pytest.raises(ConfigError, match="expected"):
            levelled(Scan(file=str(tmp_path / "a.mat"), rms_height="1 um", reason="test"), "here")


def test_a_picture_of_more_pixels_than_any_memory_holds_is_refused(tmp_path):
    from PIL import Image

    Image.new("1", (40000, 20000)).save(tmp_path / "lining.png")
    with pytest.raises(ConfigError, match="DecompressionBombError"):
        grey_image(tmp_path / "lining.png", "micro_friction.pad.inclusions.image")
