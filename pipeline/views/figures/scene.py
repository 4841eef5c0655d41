"""Three-dimensional pictures by pyvista, drawn off screen in a process of their own.

OpenGL belongs to the machine, not to Python: where it is missing, VTK ends its process. A child process keeps that,
and VTK's own messages, away from the chain; the report then says that it has no such pictures.
"""

import pickle
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import BrakechainError
from pipeline.environment import of_children

#: corner and mid-edge nodes that VTK needs of each cell type of meshio
CELLS = {"hexahedron": (8, "HEXAHEDRON"), "hexahedron20": (20, "QUADRATIC_HEXAHEDRON"),
         "hexahedron27": (20, "QUADRATIC_HEXAHEDRON"), "quad": (4, "QUAD"), "tetra10": (10, "QUADRATIC_TETRA"),
         "wedge15": (15, "QUADRATIC_WEDGE")}
#: kinds of a mixed body, whose shorter cells repeat their first vertex
_MIXED = ("tetra10", "wedge15", "hexahedron20")

#: so many scenes are drawn by so many processes
_MANY, _SIDE_BY_SIDE = 4, 2
#: ms that one period of an animation takes
_PERIOD = 1600


@dataclass(frozen=True)
class Solid:
    """One body of a picture: cells over points, coloured by its axial motion or by one colour."""

    points: np.ndarray          # (point, xyz) in m, at rest
    cells: np.ndarray           # (cell, vertex)
    kind: str                   # key of CELLS, or mixed
    colour: str = "#9aa3ad"
    edges: bool = False
    opacity: float = 1.0
    motion: np.ndarray | None = None    # (point, xyz), real or complex, in m; colour = its axial part
    limit: float = 1.0          # axial motion of full colour, in m


@dataclass(frozen=True)
class Scene:
    """Solids seen from ``direction`` (towards the camera), z upwards; ``frames`` of a period (linear cells), or 1."""

    solids: tuple
    direction: tuple = (0.45, -1.0, 1.1)
    size: tuple = (840, 640)
    frames: int = 1


def render(scenes):
    """PNG bytes of each scene, WebP of those with frames, or None where this machine cannot draw (no OpenGL)."""
    if not scenes:
        return []
    count = _SIDE_BY_SIDE if len(scenes) >= _MANY else 1
    with ThreadPoolExecutor(count) as threads:
        parts = list(threads.map(_rendered, (scenes[k::count] for k in range(count))))
    if None in parts:
        return None
    return [parts[k % count][k // count] for k in range(len(scenes))]


def _rendered(scenes):
    """``render`` in one process."""
    child = subprocess.run([sys.executable, "-P", "-m", "pipeline.views.figures.scene"], input=pickle.dumps(scenes),
                           capture_output=True, env=of_children(), check=False)
    if child.returncode in (-11, -6, 139, 134):
        return None
    if child.returncode:
        raise BrakechainError("report: pictures by pyvista", found=child.stderr.decode(errors="replace")[-800:],
                              remedy="install pyvista and VTK as the lock file says")
    return pickle.loads(child.stdout)


def draw(scene):
    """PNG or, of several frames, WebP bytes of one scene; needs OpenGL in this process."""
    import pyvista

    plotter = pyvista.Plotter(off_screen=True, window_size=list(scene.size), lighting="three lights")
    plotter.enable_anti_aliasing("msaa", multi_samples=8)
    plotter.set_background("white")
    skins = [_add(plotter, solid, pyvista) for solid in scene.solids]
    plotter.enable_parallel_projection()
    plotter.view_vector(scene.direction, viewup=(0, 0, 1))
    plotter.camera.zoom(1.25)
    pictures = []
    for frame in range(scene.frames):
        for solid, skin in zip(scene.solids, skins, strict=True) if frame else ():
            _move(solid, skin, np.exp(2j * np.pi * frame / scene.frames))
        plotter.render()
        pictures.append(plotter.screenshot(return_img=True))
    plotter.close()
    return _encoded(pictures[0]) if scene.frames == 1 else _animated(np.array(pictures))


def _add(plotter, solid, pyvista):
    cells = {pyvista.CellType[CELLS[kind][1]]: each[:, :CELLS[kind][0]] for kind, each in blocks(solid)}
    motion = 0.0 if solid.motion is None else solid.motion.real
    grid = pyvista.UnstructuredGrid(cells, np.asarray(solid.points + motion, dtype=float))
    if solid.motion is not None:
        grid.point_data["colour"] = motion[:, 2] / solid.limit
    skin = grid.extract_surface(algorithm="dataset_surface", nonlinear_subdivision=0 if solid.edges else 2)
    look = {"show_edges": solid.edges, "edge_color": "#3a4048", "line_width": 1, "smooth_shading": False,
            "opacity": solid.opacity}
    if solid.motion is None:
        plotter.add_mesh(skin, color=solid.colour, **look)
    else:
        plotter.add_mesh(skin, scalars="colour", cmap="PuOr_r", clim=(-1, 1), show_scalar_bar=False, **look)
    return skin


def blocks(solid):
    """[(kind, cells)] of a solid."""
    if solid.kind != "mixed":
        return [(solid.kind, solid.cells)]
    count = np.array([next(n for n in (10, 15, 20) if (row[n:] == row[0]).all()) for row in solid.cells])
    return [(kind, solid.cells[count == CELLS[kind][0]]) for kind in _MIXED if (count == CELLS[kind][0]).any()]


def _move(solid, skin, phase):
    """Put the skin of a moving solid where it is at a ``phase`` of its period."""
    if solid.motion is not None:
        corner = skin.point_data["vtkOriginalPointIds"]
        moved = (solid.motion * phase).real[corner]
        skin.points, skin.point_data["colour"] = solid.points[corner] + moved, moved[:, 2] / solid.limit


def _rows(picture):
    """First and last row, with a margin, of what a picture (rows, columns, colours) shows."""
    rows = np.flatnonzero((picture < 250).any(axis=(1, 2)))
    first, last = (rows[0], rows[-1]) if len(rows) else (0, len(picture))
    return slice(max(first - 16, 0), last + 17)


def _animated(pictures):
    """WebP bytes of the pictures (frames, rows, columns, colours) of one period, repeated for ever."""
    from io import BytesIO

    from PIL import Image

    stream, shown = BytesIO(), _rows(pictures.min(axis=0))
    first, *others = (Image.fromarray(picture[shown]) for picture in pictures)
    first.save(stream, format="WEBP", save_all=True, append_images=others, duration=_PERIOD // len(pictures), loop=0,
               quality=70, method=4)
    return stream.getvalue()


def _encoded(picture):
    """PNG bytes of a picture, empty rows above and below cut off, in a palette of 200 colours."""
    from io import BytesIO

    from PIL import Image

    stream, cut = BytesIO(), Image.fromarray(picture[_rows(picture)])
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
