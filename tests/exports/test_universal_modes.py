"""Modes as a universal file, read back by pyuff."""

import numpy as np
import pytest
import pyuff

from pipeline.contract import ConfigError
from pipeline.exports.mode_set import ModeSet, body_modes_of, complex_modes_of
from pipeline.exports.universal_modes import write_universal
from pipeline.recordings.uff import read_uff


def read_back(modes, path):
    """({type: data set}, [data set 55 of each mode])."""
    write_universal(modes, path, "a test")
    sets = pyuff.UFF(str(path)).read_sets()
    return {s["type"]: s for s in sets}, [s for s in sets if s["type"] == 55]


def shape_of(data_set):
    return np.column_stack([data_set[name] for name in ("r1", "r2", "r3")])


def test_complex_modes_come_back_with_their_eigenvalues(brake, tmp_path):
    """Real and imaginary parts, growth rate and angular frequency: to the six digits of the format."""
    modes = complex_modes_of(brake)
    kinds, found = read_back(modes, tmp_path / "modes.unv")
    assert len(found) == len(modes.root) >= 1 and abs(modes.shape.imag).max() > 1e-3
    for k, data_set in enumerate(found):
        assert (data_set["analysis_type"], data_set["data_type"], data_set["mode_n"]) == (3, 5, k + 1)
        assert data_set["eig"] == pytest.approx(modes.root[k], rel=1e-5)
        np.testing.assert_allclose(shape_of(data_set), modes.shape[k], rtol=0, atol=6e-6)
        assert data_set["id1"].startswith(modes.about[k][:40]) and data_set["id4"].strip() == "largest component 1"
    np.testing.assert_allclose(np.column_stack([kinds[2411][axis] for axis in "xyz"]), modes.node, rtol=1e-15)
    np.testing.assert_array_equal(np.asarray(kinds[2411]["color"], int), modes.body + 1)
    assert (kinds[164]["length"], kinds[164]["force"]) == (1.0, 1.0)


def test_modes_of_a_body_come_back_with_their_frequencies(brake, tmp_path):
    modes = body_modes_of(brake, "disc")
    kinds, found = read_back(modes, tmp_path / "modes.uff")
    assert len(found) == len(modes.root)
    for k, data_set in enumerate(found):
        assert data_set["freq"] == pytest.approx(modes.frequency[k], rel=1e-5) and data_set["modal_m"] == 1.0
        np.testing.assert_allclose(shape_of(data_set), modes.shape[k], rtol=1e-5, atol=1e-12)
    corners = [e["nodes_nums"] for e in kinds[2412][115]]
    np.testing.assert_array_equal(np.array(corners) - 1, modes.cells[0][1][:, :8])
    assert len(read_uff(tmp_path / "modes.uff")[2]) == len(found)


def test_tetrahedra_and_wedges_stand_by_their_corners(tmp_path):
    node = np.random.default_rng(0).standard_normal((25, 3))
    cells = (("tetra10", np.arange(10)[None]), ("wedge15", np.arange(10, 25)[None]))
    modes = ModeSet(node, cells, np.zeros(25, int), ("a",), np.array([10j]), node[None], ("mode",), "unit", 1.0,
                    np.zeros(1))
    kinds, _ = read_back(modes, tmp_path / "a.unv")
    assert [e["nodes_nums"] for e in kinds[2412][111]] == [[1, 2, 3, 4]]
    assert [e["nodes_nums"] for e in kinds[2412][112]] == [[11, 12, 13, 14, 15, 16]]
    with pytest.raises(ConfigError, match="a name that is free, found a file"):
        write_universal(modes, tmp_path / "a.unv", "a test")


def test_complex_modes_are_read_again_as_measured_ones_are(brake, tmp_path):
    modes = complex_modes_of(brake)
    write_universal(modes, tmp_path / "again.unv", "a test")
    _, _, found = read_uff(tmp_path / "again.unv")
    assert list(found) == [f"mode_{k + 1}" for k in range(len(modes.root))]
    for one, root, shape in zip(found.values(), modes.root, modes.shape, strict=True):
        assert one.frequency[0] == pytest.approx(abs(root) / (2 * np.pi), rel=1e-5)
        assert one.damping_ratio[0] == pytest.approx(-root.real / abs(root), abs=1e-5)
        np.testing.assert_allclose(one.shape[0], shape.T.ravel(), atol=6e-6)
