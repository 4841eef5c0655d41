"""Matrices of other programs, meshes of bodies, scans of surfaces."""

import io
import tempfile
from functools import cache
from pathlib import Path

import numpy as np
import scipy

from pipeline.case_models.rough import scans
from pipeline.decks import matrix_files
from pipeline.decks.meshes.body import read_body
from pipeline.physics.fem.mesh import block
from tests.fuzz.mutation import damaged, draw, garbled
from tests.fuzz.trial import Target, Trial, difference

#: a symmetric matrix of 3 nodes with 2 directions each
_NODES, _DIRECTIONS = (11, 12, 20), (1, 3)
_LABELS = [(node, direction) for node in _NODES for direction in _DIRECTIONS]
_K = np.round(
    np.diag([4.0, 5, 6, 7, 8, 9])
    + 0.5 * np.eye(6, k=1)
    + 0.5 * np.eye(6, k=-1)
    - 0.25 * np.eye(6, k=3)
    - 0.25 * np.eye(6, k=-3),
    3,
)
_ENTRIES = [(i, j) for i, j in zip(*np.nonzero(_K), strict=True)]


def _matrix(path, **given):
    """The matrix; of what Abaqus halves without saying so, with its other triangle."""
    found = matrix_files.read(path, **given)
    matrix = found.matrix().toarray()
    half = found.halves and not np.triu(matrix, 1).any()
    return found.whole(path, "symmetric").matrix().toarray() if half else matrix


def _saved(write, name="file"):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / name
        write(path)
        return path.read_bytes()


def _of_abaqus(rng, labelled, entries, mark=", "):
    lines = [
        mark.join(str(v) for v in ((*_LABELS[i], *_LABELS[j]) if labelled else (i + 1, j + 1)))
        + mark
        + f"{_K[i, j]:.9e}"
        for i, j in entries
    ]
    return ("** MATRIX\n" * int(rng.random() < 0.5) + "\n".join(lines) + "\n").encode()


def _number(rng, value, width=16):
    """A number as Nastran writes it: 1.5E+0, 1.5D+0 or 1.5+0."""
    spelt = f"{value:.6E}"
    return draw(rng, (spelt, spelt.replace("E", "D"), spelt.replace("E", ""))).rjust(width)


def _of_nastran(rng):
    """A DMIG in wide fields or between commas, its columns in any order."""
    wide, lines = rng.random() < 0.6, []
    columns = [int(j) for j in rng.permutation(6)]
    if wide:
        lines.append(f"{'DMIG':<8}{'KAA':<8}{'0':>8}{'6':>8}{'2':>8}{'0':>8}")
    else:
        lines.append("DMIG,KAA,0,6,2,0")
    for j in columns:
        rows = [i for i in range(6) if i >= j and _K[i, j]]
        if wide:
            lines.append(f"{'DMIG*':<8}{'KAA':<16}{_LABELS[j][0]:>16}{_LABELS[j][1]:>16}")
            lines += [f"{'*':<8}{_LABELS[i][0]:>16}{_LABELS[i][1]:>16}{_number(rng, _K[i, j])}" for i in rows]
        else:
            lines.append(
                f"DMIG,KAA,{_LABELS[j][0]},{_LABELS[j][1]},,"
                + ",,".join(f"{_LABELS[i][0]},{_LABELS[i][1]},{_number(rng, _K[i, j], 0)}" for i in rows[:1])
            )
            lines += [f"*,{_LABELS[i][0]},{_LABELS[i][1]},{_number(rng, _K[i, j], 0)}" for i in rows[1:]]
    return "\n".join(["$ made by a test", *lines, ""]).encode()


def _matrix_content(rng, form):
    sparse = scipy.sparse.coo_matrix(_K)
    if form == ".mtx":
        stream = io.BytesIO()
        scipy.io.mmwrite(
            stream, draw(rng, (sparse, _K)), comment="of a test", symmetry=draw(rng, ("general", "symmetric"))
        )
        return stream.getvalue()
    if form == ".npz":
        return _saved(
            lambda path: scipy.sparse.save_npz(path, draw(rng, (sparse, sparse.tocsr(), sparse.tocsc()))), "a.npz"
        )
    if form == ".mat":
        return _saved(lambda path: scipy.io.savemat(path, {"K": draw(rng, (_K, scipy.sparse.csc_matrix(_K)))}), "a.mat")
    if form == ".pch":
        return _of_nastran(rng)
    half, labelled = rng.random() < 0.5, rng.random() < 0.6
    entries = [_ENTRIES[k] for k in rng.permutation(len(_ENTRIES)) if not half or _ENTRIES[k][0] >= _ENTRIES[k][1]]
    return _of_abaqus(rng, labelled, entries, draw(rng, (", ", ",", " ")))


_FORMS = (".mtx", ".npz", ".mat", ".pch", "abaqus")


def _matrix_damaged(rng):
    form = draw(rng, _FORMS)
    change = damaged if form in (".npz", ".mat") else garbled
    content = change(rng, _matrix_content(rng, form))
    return Trial(f"a{form.replace('abaqus', '.mtx')}", content, given=draw(rng, ({}, {}, {"variable": "K"})))


def _matrix_arranged(rng):
    form = draw(rng, _FORMS)
    return Trial(
        f"a{form.replace('abaqus', '.mtx')}",
        _matrix_content(rng, form),
        f"matrix as {form}",
        {},
        lambda value: difference(value, _K, 1e-6),
        "read",
    )


def _matrix_doubled(rng):
    """An entry given in two parts is their sum."""
    i, j = draw(rng, _ENTRIES)
    lines = [f"{a + 1} {b + 1} {_K[a, b] * (0.25 if (a, b) == (i, j) else 1.0):.12g}" for a, b in _ENTRIES]
    lines.insert(int(rng.integers(len(lines))), f"{i + 1} {j + 1} {0.75 * _K[i, j]:.12g}")
    head = f"%%MatrixMarket matrix coordinate real general\n%x\n6 6 {len(lines)}\n"
    return Trial(
        "a.mtx",
        (head + "\n".join(lines) + "\n").encode(),
        "an entry in two parts",
        {},
        lambda value: difference(value, _K, 1e-6),
        "read",
    )


@cache
def _mesh():
    return block(np.linspace(0, 0.1, 3), np.linspace(0, 0.05, 2), np.linspace(0, 0.02, 2), kind="hexahedron20")


@cache
def _mesh_content(form, scale):
    import meshio

    mesh = _mesh()
    return _saved(
        lambda path: meshio.Mesh(scale * mesh.node, [(mesh.kind, mesh.element)]).write(
            path, {".msh": "gmsh"}.get(form)
        ),
        f"a{form}",
    )


def _meshed(path, units="SI"):
    mesh = read_body(path, units).mesh
    corners = mesh.node[mesh.element]
    return {
        "middles": np.sort(corners.mean(axis=1), axis=0),
        "nodes": len(mesh.node),
        "low": corners.min(axis=(0, 1)),
        "high": corners.max(axis=(0, 1)),
        "order": corners,
    }


def _mesh_damaged(rng):
    form = draw(
        rng, (".inp", ".msh", ".vtu", ".bdf", ".vtk", ".inp", ".msh", ".vtu", ".vtk", ".med", ".xdmf", ".su2", ".cgns")
    )
    written = form if form in (".inp", ".msh", ".vtu", ".bdf", ".vtk", ".med") else draw(rng, (".inp", ".bdf"))
    content = _mesh_content(written, 1.0)
    return Trial(f"a{form}", (garbled if written in (".inp", ".bdf") else damaged)(rng, content))


def _mesh_arranged(rng):
    """Nodes numbered otherwise, elements in another order, comments, another unit of length."""
    mesh, (units, scale) = _mesh(), draw(rng, (("SI", 1.0), ("mm-t-s", 1e3)))
    number = rng.permutation(np.arange(1, 500))[: len(mesh.node)]
    head = ["** a part", "*Heading", " of a test"] if rng.random() < 0.5 else ["*Heading", " of a test"]
    nodes = [
        f"{number[k]}, " + ", ".join(f"{scale * v:.12g}" for v in mesh.node[k]) for k in rng.permutation(len(mesh.node))
    ]
    elements = [
        f"{k + 1}, " + ", ".join(str(number[v]) for v in _as_abaqus(mesh.element[k]))
        for k in rng.permutation(len(mesh.element))
    ]
    if rng.random() < 0.5:
        elements = [row.replace(", ", ",\n ", 16).replace(",\n ", ", ", 15) for row in elements]
    text = "\n".join([*head, "*NODE", *nodes, "*ELEMENT, TYPE=C3D20, ELSET=all", *elements, ""])
    return Trial("a.inp", text.encode(), "numbers, order, unit of a mesh", {"units": units}, _same_body, "read")


def _as_abaqus(cell):
    """Vertices of a hexahedron of 20 nodes in the order of Abaqus: that of meshio."""
    return cell


def _same_body(value):
    mesh = _mesh()
    corners = mesh.node[mesh.element]
    wanted = {
        "middles": np.sort(corners.mean(axis=1), axis=0),
        "nodes": len(mesh.node),
        "low": corners.min(axis=(0, 1)),
        "high": corners.max(axis=(0, 1)),
    }
    order = min(difference(value["order"], corners[list(k)], 1e-9) for k in ((0, 1), (1, 0)))
    return difference({k: v for k, v in value.items() if k != "order"}, wanted, 1e-9) or order


_ROUGH = 1e-6 * np.round(np.random.default_rng(3).normal(size=(24, 32)), 4)


def _scan_text(heights, unit="m", size=1.0):
    width, height = 32.0, 24.0
    head = f"# Channel: Topography\n# Width: {width:.9g} um\n# Height: {height:.9g} um\n# Value units: {unit}\n"
    return (head + "\n".join(" ".join(f"{v / size:.9e}" for v in row) for row in heights) + "\n").encode()


@cache
def _scan_content(form):
    from SurfaceTopography import Topography

    made = Topography(_ROUGH.T.copy(), (32e-6, 24e-6), unit="m")
    stream = io.BytesIO()
    if form == ".nc":
        return _saved(made.to_netcdf, "a.nc")
    if form == ".x3p":
        return _x3p()
    if form == ".sdf":
        return _sdf()
    stream.close()
    return _scan_text(_ROUGH)


def _sdf():
    """A surface data file of ISO 25178-71, text form."""
    head = {
        "ManufacID": "test",
        "CreateDate": "271120260800",
        "ModDate": "271120260800",
        "NumPoints": 32,
        "NumProfiles": 24,
        "Xscale": 1e-6,
        "Yscale": 1e-6,
        "Zscale": 1e-9,
        "Zresolution": -1,
        "Compression": 0,
        "DataType": 5,
        "CheckType": 0,
    }
    rows = [" ".join(str(int(round(v * 1e9))) for v in row) for row in _ROUGH]
    return ("aISO-1.0\n" + "".join(f"{k}={v}\n" for k, v in head.items()) + "*\n" + "\n".join(rows) + "\n*\n").encode()


def _x3p():
    """A file of ISO 25178-72: a ZIP of an XML head and binary heights."""
    import hashlib
    import zipfile

    data = _ROUGH.astype("<f8").tobytes()
    digest = hashlib.md5(data, usedforsecurity=False).hexdigest()
    axis = "<C{0}><AxisType>{1}</AxisType><DataType>D</DataType><Increment>{2}</Increment><Offset>0</Offset></C{0}>"
    axes = axis.format("X", "I", 1e-6) + axis.format("Y", "I", 1e-6) + axis.format("Z", "A", 1)
    xml = (
        '<?xml version="1.0" encoding="UTF-8"?><p:ISO5436_2 xmlns:p="http://www.opengps.eu/2008/ISO5436_2"><Record1>'
        f"<Revision>ISO5436 - 2000</Revision><FeatureType>SUR</FeatureType><Axes>{axes.replace('C', 'C')}</Axes>"
        "</Record1><Record2><Date>2026-11-27T08:00:00</Date><Creator>test</Creator></Record2><Record3><MatrixDimension>"
        "<SizeX>32</SizeX><SizeY>24</SizeY><SizeZ>1</SizeZ></MatrixDimension><DataLink><PointDataLink>bindata/data.bin"
        f"</PointDataLink><MD5ChecksumPointData>{digest}</MD5ChecksumPointData></DataLink></Record3><Record4>"
        "<ChecksumFile>md5checksum.hex</ChecksumFile></Record4></p:ISO5436_2>"
    )
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as file:
        file.writestr("main.xml", xml)
        file.writestr("bindata/data.bin", data)
        file.writestr("md5checksum.hex", hashlib.md5(xml.encode(), usedforsecurity=False).hexdigest() + " *main.xml")
    return stream.getvalue()


class _Choice:
    """What a case says of a scan."""

    transposed, outlier_threshold, height_unit = False, 1e3, None
    channel = lateral_unit = pixel_size = pixel_size_y = None

    def __init__(self, path):
        self.file = path


def _scanned(path):
    scans.levelled(_Choice(path), "surface.pad")
    stated = dict.fromkeys(scans._STATED)
    scan, _ = scans.answered(f"{scans.__name__}:leave_scan", path, scans._scan, where="surface.pad", channel=None,
                             stated=stated)
    return {"heights": scan.heights, "spacing": scan.spacing}


_SCANS = (".txt", ".nc", ".x3p", ".sdf")


def _scan_damaged(rng):
    form = draw(rng, _SCANS)
    change = damaged if form in (".nc", ".x3p") else garbled
    return Trial(f"a{form}", change(rng, _scan_content(form)))


def _scan_arranged(rng):
    form = draw(rng, _SCANS)
    content = _scan_content(form)
    if form == ".txt":
        unit, size = draw(rng, (("m", 1.0), ("um", 1e-6), ("nm", 1e-9)))
        content = _scan_text(_ROUGH, unit, size)
    return Trial(
        f"a{form}",
        content,
        f"scan as {form}",
        {},
        lambda value: difference(value, {"heights": _ROUGH, "spacing": (1e-6, 1e-6)}, 1e-3 if form == ".sdf" else 1e-6),
        "read",
    )


TARGETS = (
    Target("matrix", _matrix, _matrix_damaged, (_matrix_arranged, _matrix_doubled), True),
    Target("mesh", _meshed, _mesh_damaged, (_mesh_arranged,), True, share=0.15),
    Target("scan", _scanned, _scan_damaged, (_scan_arranged,), True, share=0.15),
)
