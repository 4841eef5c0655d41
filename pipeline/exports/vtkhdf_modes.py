"""Modes as VTKHDF, the format of ParaView and VTK in HDF5: an unstructured grid with one array for each mode.

Arrays mode_001_real and mode_001_imaginary of a complex mode (mode_001 of a real one) lie at the points; their HDF5
attributes and the field data hold frequency in Hz and growth rate in 1/s. Words are attributes of the group /modes,
which VTK leaves alone. The layout is that of version 2.0 of the specification
(https://docs.vtk.org/en/latest/vtk_file_formats/vtkhdf_file_format/vtkhdf_specifications.html), for one part.
"""

import numpy as np

from pipeline.contract.store import new_hdf5
from pipeline.exports.run_products import refuse_existing

#: meshio cell type -> VTK cell type; vertices have one order in both
_TYPES = {"quad": 9, "quad8": 23, "hexahedron": 12, "hexahedron20": 25, "hexahedron27": 29, "tetra10": 24,
          "wedge15": 26}
_VERSION = (2, 0)


def write_vtkhdf(modes, path, source):
    """Write a ModeSet to a new VTKHDF file; ``source``: what it is from, in words.

    Raises ConfigError where the file exists.
    """
    refuse_existing(path)
    with new_hdf5(path) as h5:
        grid = h5.create_group("VTKHDF", track_order=True)
        grid.attrs["Version"] = np.array(_VERSION, np.int64)
        grid.attrs.create("Type", np.bytes_("UnstructuredGrid"))
        _write_cells(grid, modes)
        points, field = grid.create_group("PointData", track_order=True), grid.create_group("FieldData")
        points.create_dataset("body", data=np.asarray(modes.body, np.int32))
        for k in range(len(modes.root)):
            _write_mode(points, modes, k)
        for name, values in (("frequency", modes.frequency), ("growth_rate", modes.root.real)):
            field.create_dataset(name, data=np.asarray(values, float))
        h5.create_group("modes").attrs.update(mode=list(modes.about), body=list(modes.body_name), shapes=modes.scale,
                                              source=source)


def _write_cells(grid, modes):
    """Points, and the cells: nodes in one row, where each begins, and its type."""
    connectivity = [np.ravel(cells) for _, cells in modes.cells]
    width = [np.full(len(cells), cells.shape[1]) for _, cells in modes.cells]
    kind = [np.full(len(cells), _TYPES[kind]) for kind, cells in modes.cells]
    connectivity, width, kind = (np.concatenate([np.zeros(0, int), *part]) for part in (connectivity, width, kind))
    grid.create_dataset("Points", data=np.asarray(modes.node, float))
    grid.create_dataset("Connectivity", data=connectivity.astype(np.int64))
    grid.create_dataset("Offsets", data=np.concatenate(([0], np.cumsum(width))).astype(np.int64))
    grid.create_dataset("Types", data=kind.astype(np.uint8))
    for name, count in (("NumberOfPoints", len(modes.node)), ("NumberOfCells", len(kind)),
                        ("NumberOfConnectivityIds", len(connectivity))):
        grid.create_dataset(name, data=np.array([count], np.int64))


def _write_mode(points, modes, k):
    """One array, or the real and the imaginary one, of mode ``k`` with its root."""
    shape, name = modes.shape[k], f"mode_{k + 1:03d}"
    parts = {f"{name}_real": shape.real, f"{name}_imaginary": shape.imag} if modes.is_complex else {name: shape}
    for each, values in parts.items():
        data = points.create_dataset(each, data=np.asarray(values, float))
        data.attrs.update(frequency=modes.frequency[k], growth_rate=modes.root[k].real, about=modes.about[k])
