"""Modes as VTKHDF, read back by VTK through pyvista."""

import h5py
import numpy as np
import pytest
import pyvista

from pipeline.contract import ConfigError
from pipeline.exports.mode_set import ModeSet, body_modes_of, complex_modes_of
from pipeline.exports.vtkhdf_modes import write_vtkhdf
from pipeline.physics.fem.reference_cells import reference_vertices


def read_back(modes, path):
    write_vtkhdf(modes, path, "a test")
    return pyvista.read(path)


def test_complex_modes_come_back(brake, tmp_path):
    """Real and imaginary parts at the points; frequency and growth rate in the field data and as attributes."""
    modes = complex_modes_of(brake)
    grid = read_back(modes, tmp_path / "modes.vtkhdf")
    assert isinstance(grid, pyvista.UnstructuredGrid) and len(modes.root) >= 1
    np.testing.assert_array_equal(grid.points, modes.node)
    np.testing.assert_array_equal(grid.point_data["body"], modes.body)
    np.testing.assert_array_equal(grid.field_data["growth_rate"], modes.root.real)
    np.testing.assert_array_equal(grid.field_data["frequency"], modes.frequency)
    with h5py.File(tmp_path / "modes.vtkhdf") as h5:
        assert list(h5["modes"].attrs["mode"]) == list(modes.about)
        for k, root in enumerate(modes.root):
            for part in ("real", "imaginary"):
                data = h5[f"VTKHDF/PointData/mode_{k + 1:03d}_{part}"]
                assert data.attrs["growth_rate"] == root.real
                assert data.attrs["frequency"] == pytest.approx(root.imag / (2 * np.pi))
    for k, shape in enumerate(modes.shape, 1):
        found = grid.point_data[f"mode_{k:03d}_real"] + 1j * grid.point_data[f"mode_{k:03d}_imaginary"]
        np.testing.assert_array_equal(found, shape)


@pytest.mark.exact
def test_modes_of_a_body_on_its_solid_mesh(brake, tmp_path):
    """A ring of radii 50 and 100 mm, 10 mm thick: VTK finds its volume less what 12 straight-sided cells cut off."""
    modes = body_modes_of(brake, "disc")
    grid = read_back(modes, tmp_path / "disc.vtkhdf")
    np.testing.assert_array_equal(grid.point_data["mode_001"], modes.shape[0])
    assert grid.n_cells == len(modes.cells[0][1])
    assert grid.compute_cell_sizes()["Volume"].sum() == pytest.approx(np.pi * 0.01 * (0.1**2 - 0.05**2), rel=0.05)


@pytest.mark.exact
@pytest.mark.parametrize(("kind", "volume"), [("hexahedron20", 1.0), ("hexahedron27", 1.0), ("tetra10", 1 / 6),
                                              ("wedge15", 0.5), ("hexahedron", 1.0)])
def test_cells_have_the_order_of_vertices_of_vtk(tmp_path, kind, volume):
    """Volume of a reference cell, and the first derivative of a field that is x at all its vertices."""
    node = reference_vertices(kind)
    modes = ModeSet(node, ((kind, np.arange(len(node))[None]),), np.zeros(len(node), int), ("a",), np.array([10j]),
                    node[None], ("mode",), "unit", 1.0, np.zeros(1))
    grid = read_back(modes, tmp_path / "one.vtkhdf")
    assert grid.compute_cell_sizes()["Volume"].sum() == pytest.approx(volume, rel=1e-6)
    gradient = grid.compute_derivative("mode_001", gradient=True)["gradient"]
    np.testing.assert_allclose(gradient, np.tile(np.eye(3).ravel(), (len(node), 1)), atol=1e-6)
    with pytest.raises(ConfigError, match="a name that is free"):
        write_vtkhdf(modes, tmp_path / "one.vtkhdf", "a test")
