"""Named modes: nearest within a share, how much of a band they cover, from products of other runs."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.case_models.named_modes import named_modes
from pipeline.contract import ConfigError, store
from pipeline.products import ModalTest
from tests.views import products_for_views as small


@pytest.mark.exact
def test_the_nearest_mode_lies_within_the_share_or_there_is_none():
    modes = named_modes({"bell": 3000.0, "ring": 2000.0}, None, "here")
    assert modes.name == ("ring", "bell") and modes.unstable.tolist() == [-1, -1]
    assert modes.nearest([2040.0, 2061.0, 2950.0, 9e3], 0.03).tolist() == [0, -1, 1, -1]
    assert named_modes({}, None, "here").nearest([100.0], 0.03).tolist() == [-1]


@pytest.mark.exact
def test_the_covered_share_counts_overlaps_once_and_nothing_beyond_the_band():
    one = named_modes({"a": 2000.0}, None, "here")
    assert one.covered((1e3, 4e3), 0.1) == pytest.approx(np.log(1.1 / 0.9) / np.log(4))
    assert one.covered((2e3, 4e3), 0.1) == pytest.approx(np.log(1.1) / np.log(2))
    two = named_modes({"a": 2000.0, "b": 2100.0}, None, "here")
    assert two.covered((1e3, 4e3), 0.1) == pytest.approx(np.log(2310 / 1800) / np.log(4))
    assert two.covered((1e3, 4e3), 0.1, unstable=True) == 0.0 and one.covered((8e3, 9e3), 0.1) == 0.0
    drawn = np.exp(np.random.default_rng(1).uniform(np.log(1e3), np.log(4e3), 20000))
    assert (two.nearest(drawn, 0.1) >= 0).mean() == pytest.approx(two.covered((1e3, 4e3), 0.1), abs=0.01)


def test_modes_of_a_run_say_which_are_unstable(tmp_path):
    product = small.complex_modes()
    file = tmp_path / "complex_modes.h5"
    store.write(product, file, {})
    modes = named_modes({"stated": 1234.0}, file, "here")
    assert np.all(np.diff(modes.frequency) >= 0) and "stated" in modes.name
    squealing = np.abs(product.unstable_root.imag) / (2 * np.pi)
    marked = modes.frequency[modes.unstable == 1]
    assert len(marked) and all(np.min(abs(marked / f - 1)) < 0.02 for f in squealing if f > 0)
    beyond = replace(product, unstable_root=product.unstable_root + 1e6j)
    store.write(beyond, file, {})
    assert named_modes({}, file, "here").frequency[-1] > 1e5


def test_measured_modes_are_named_by_run_and_other_files_refused(tmp_path):
    tested = small.modal_test()
    store.write(tested, tmp_path / "modal_test.h5", {})
    modes = named_modes({}, tmp_path / "modal_test.h5", "here")
    assert isinstance(tested, ModalTest) and len(modes.name) == sum(len(r.frequency) for r in tested.runs.values())
    assert set(modes.unstable) == {-1}
    store.write(small.surface(), tmp_path / "surface.h5", {})
    with pytest.raises(ConfigError, match="a product complex_modes or matrix_modes or modal_test of a run, found"):
        named_modes({}, tmp_path / "surface.h5", "here")
    (tmp_path / "text.h5").write_text("no")
    with pytest.raises(ConfigError, match="expected a product complex_modes or matrix_modes"):
        named_modes({}, tmp_path / "text.h5", "here")
