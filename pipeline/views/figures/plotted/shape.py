"""Bodies of a three-dimensional picture as a surface that the page can turn and move, with its numbers as CSV."""

import base64
import json
import zlib
from dataclasses import dataclass

import numpy as np

from pipeline.views.figures.plotted.columns import Column, Series
from pipeline.views.figures.scene import blocks

#: corners of the faces of a cell, by its kind; triangles repeat their last corner
_HEXAHEDRON = (0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)
_FACES = {
    "hexahedron": _HEXAHEDRON, "hexahedron20": _HEXAHEDRON, "hexahedron27": _HEXAHEDRON, "quad": ((0, 1, 2, 3),),
    "tetra10": ((0, 1, 2, 2), (0, 1, 3, 3), (1, 2, 3, 3), (0, 2, 3, 3)),
    "wedge15": ((0, 1, 2, 2), (3, 4, 5, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5))}
_AXES = "xyz"


@dataclass(frozen=True)
class Skin:
    """Faces (f, 4) of one body, rows of the points of its Shape, and its look."""

    faces: np.ndarray
    colour: str
    opacity: float


@dataclass(frozen=True)
class Shape:
    """Points (n, 3) in m with the ``skins`` between them, seen from ``direction``.

    ``motion`` (n, 3): complex displacement, largest component 1, drawn ``scale`` m large; full colour at an axial
    displacement of ``limit``. None: at rest.
    """

    points: np.ndarray
    skins: tuple
    direction: tuple
    motion: np.ndarray | None = None
    scale: float = 0.0
    limit: float = 1.0

    @property
    def series(self):
        """The coordinates and displacements of the points, as Series."""
        columns = [Column(f"{axis} / mm", np.asarray(1e3 * values, np.float32))
                   for axis, values in zip(_AXES, self.points.T, strict=True)]
        if self.motion is not None:
            columns += [Column(f"{name} part of the displacement in {axis} / 1", np.asarray(part, np.float32).round(5))
                        for axis, values in zip(_AXES, self.motion.T, strict=True)
                        for name, part in (("real", values.real), ("imaginary", values.imag))]
        return (Series(0, "", tuple(columns)),)

    @property
    def look(self):
        """JSON text: bodies with their number of faces, the view, and how displacements are drawn (mm)."""
        bodies = [{"faces": len(skin.faces), "colour": skin.colour, "opacity": skin.opacity} for skin in self.skins]
        made = {"bodies": bodies, "direction": list(self.direction), "moving": self.motion is not None,
                "scale": float(f"{1e3 * self.scale:.5g}"), "limit": float(f"{self.limit:.5g}")}
        return json.dumps(made, separators=(",", ":"))

    @property
    def packed(self):
        """The faces of all bodies, four unsigned 32-bit integers each, deflated, in base64."""
        corners = np.concatenate([skin.faces for skin in self.skins]).astype("<u4").tobytes()
        packer = zlib.compressobj(9, zlib.DEFLATED, -zlib.MAX_WBITS)
        return base64.b64encode(packer.compress(corners) + packer.flush()).decode()


def shape_of(scene):
    """Shape of the surfaces of the solids of a Scene."""
    points, motions, skins, first = [], [], [], 0
    moving = [solid for solid in scene.solids if solid.motion is not None]
    for solid in scene.solids:
        faces = surface(blocks(solid))
        used, corners = np.unique(faces, return_inverse=True)
        skins.append(Skin(first + corners.reshape(-1, 4), solid.colour, solid.opacity))
        points.append(np.asarray(solid.points, float)[used])
        motions.append(np.zeros((len(used), 3)) if solid.motion is None else np.asarray(solid.motion)[used])
        first += len(used)
    if not moving:
        return Shape(np.concatenate(points), tuple(skins), scene.direction)
    motion = np.concatenate(motions)
    scale = float(abs(motion).max(initial=0.0)) or 1.0
    return Shape(np.concatenate(points), tuple(skins), scene.direction, motion / scale, scale,
                 float(moving[0].limit) / scale)


def surface(cells):
    """Faces (f, 4), vertices, that belong to one cell only: the skin of ``cells`` [(kind, (cell, vertex))]."""
    faces = np.concatenate([np.asarray(each)[:, np.array(_FACES[kind])].reshape(-1, 4) for kind, each in cells])
    _, index, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return faces[np.sort(index[count == 1])]
