"""Three-dimensional pictures by pyvista, drawn off screen in a process of their own.

OpenGL belongs to the machine, not to Python: where it is missing, VTK ends its process. A child process keeps that,
and VTK's own messages, away from the chain; the report then says that it has no such pictures.
"""

import os
import pickle
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from pipeline.contract.errors import BrakechainError

#: corner and mid-edge nodes that VTK needs of each cell type of meshio
CELLS = {"hexahedron": (8, "HEXAHEDRON"), "hexahedron20": (20, "QUADRATIC_HEXAHEDRON"),
         "hexahedron27": (20, "QUADRATIC_HEXAHEDRON"), "quad": (4, "QUAD")}


@dataclass(frozen=True)
class Solid:
    """One body of a picture: cells over points, coloured by a scalar per point or by one colour."""

    points: np.ndarray          # (point, xyz) in m, already displaced
    cells: np.ndarray           # (cell, vertex)
    kind: str                   # key of CELLS
    scalar: np.ndarray | None = None    # (point,), -1 ... 1
    colour: str = "#9aa3ad"
    edges: bool = False
    opacity: float = 1.0


@dataclass(frozen=True)
class Scene:
    """Solids seen from ``direction`` (towards the camera), z upwards."""

    solids: tuple
    direction: tuple = (0.45, -1.0, 1.1)
    size: tuple = (840, 640)


def render(scenes):
    """PNG bytes of each scene, or None where this machine cannot draw (no OpenGL)."""
    if not scenes:
        return []
    root = Path(__file__).resolve().parents[3]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(root), os.environ.get("PYTHONPATH", "")])}
    child = subprocess.run([sys.executable, "-m", "pipeline.views.figures.scene"], input=pickle.dumps(scenes),
                           capture_output=True, env=environment, check=False)
    if child.returncode in (-11, -6, 139, 134):
        return None
    if child.returncode:
        raise BrakechainError("report: pictures by pyvista", found=child.stderr.decode(errors="replace")[-800:],
                              remedy="install pyvista and VTK as the lock file says")
    return pickle.loads(child.stdout)


def draw(scene):
    """PNG bytes of one scene; needs OpenGL in this process."""
    import pyvista

    plotter = pyvista.Plotter(off_screen=True, window_size=list(scene.size), lighting="three lights")
    plotter.enable_anti_aliasing("msaa", multi_samples=8)
    plotter.set_background("white")
    for solid in scene.solids:
        _add(plotter, solid, pyvista)
    plotter.enable_parallel_projection()
    plotter.view_vector(scene.direction, viewup=(0, 0, 1))
    plotter.camera.zoom(1.25)
    picture = plotter.screenshot(return_img=True)
    plotter.close()
    return _encoded(picture)


def _add(plotter, solid, pyvista):
    vertices, name = CELLS[solid.kind]
    cells = {pyvista.CellType[name]: solid.cells[:, :vertices]}
    grid = pyvista.UnstructuredGrid(cells, np.asarray(solid.points, dtype=float))
    if solid.scalar is not None:
        grid.point_data["colour"] = solid.scalar
    skin = grid.extract_surface(algorithm="dataset_surface", nonlinear_subdivision=0 if solid.edges else 2)
    look = {"show_edges": solid.edges, "edge_color": "#3a4048", "line_width": 1, "smooth_shading": False,
            "opacity": solid.opacity}
    if solid.scalar is None:
        plotter.add_mesh(skin, color=solid.colour, **look)
    else:
        plotter.add_mesh(skin, scalars="colour", cmap="PuOr_r", clim=(-1, 1), show_scalar_bar=False, **look)


def _encoded(picture):
    """PNG bytes of a picture, empty rows above and below cut off, in a palette of 200 colours."""
    from io import BytesIO

    from PIL import Image

    rows = np.flatnonzero((picture < 250).any(axis=(1, 2)))
    first, last = (rows[0], rows[-1]) if len(rows) else (0, len(picture))
    stream, cut = BytesIO(), Image.fromarray(picture[max(first - 16, 0):last + 17])
    reduced = cut.quantize(200, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    reduced.save(stream, format="PNG", optimize=True)
    return stream.getvalue()


def main():
    """Child process: scenes on standard input, PNG bytes on standard output."""
    scenes = pickle.load(sys.stdin.buffer)
    pictures = [draw(scene) for scene in scenes]
    sys.stdout.buffer.write(pickle.dumps(pictures))


if __name__ == "__main__":
    main()
