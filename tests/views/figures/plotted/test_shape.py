"""Surfaces that the page can turn: skins of cells, displacements as CSV, packed faces."""

import base64
import csv
import json
import zlib
from io import StringIO

import numpy as np
import pytest

from pipeline.views.figures import mode_shapes
from pipeline.views.figures.plotted.picture import Picture, in_space
from pipeline.views.figures.plotted.shape import shape_of, surface
from pipeline.views.figures.scene import Scene, Solid
from tests.views import products_for_views as small

CUBE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1.0]])


@pytest.mark.exact
def test_the_skin_of_two_cubes_has_ten_faces_and_that_of_cells_of_every_kind_is_closed():
    two = np.array([[0, 1, 2, 3, 4, 5, 6, 7], [1, 8, 9, 2, 5, 10, 11, 6]])
    assert len(surface([("hexahedron", two)])) == 10
    assert len(surface([("tetra10", np.arange(10)[None])])) == 4
    assert len(surface([("wedge15", np.arange(15)[None])])) == 5
    assert len(surface([("hexahedron20", np.arange(20)[None]), ("wedge15", 100 + np.arange(15)[None])])) == 11


def test_a_solid_becomes_points_and_faces_that_read_back():
    """The largest component of the motion is 1; a node inside, number 8, is left out."""
    motion = np.zeros((9, 3), complex)
    motion[2] = 0.0, 2e-3j, -1e-3
    points = np.vstack((CUBE, [[0.5, 0.5, 0.5]]))
    shape = shape_of(Scene((Solid(points, np.arange(8)[None], "hexahedron", motion=motion, limit=1e-3),)))
    rows = list(csv.reader(StringIO(Picture(b"", (), shape.series, shape=shape).csv)))
    assert rows[0][:4] == ["x / mm", "y / mm", "z / mm", "real part of the displacement in x / 1"] and len(rows) == 9
    assert rows[3] == ["1000", "1000", "0", "0", "0", "0", "1", "-0.5", "0"]
    look = json.loads(shape.look)
    assert look["moving"] and look["scale"] == 2.0 and look["limit"] == 0.5 and look["bodies"][0]["faces"] == 6
    unpacked = zlib.decompress(base64.b64decode(shape.packed), -zlib.MAX_WBITS)
    np.testing.assert_array_equal(np.frombuffer(unpacked, "<u4").reshape(-1, 4), shape.skins[0].faces)


def test_bodies_keep_their_colours_and_a_body_at_rest_stands_beside_a_moving_one():
    solids = (Solid(CUBE, np.arange(8)[None], "hexahedron", colour="#112233", opacity=0.3),
              Solid(CUBE + 2, np.arange(8)[None], "hexahedron", motion=np.ones((8, 3)), limit=2.0))
    shape = shape_of(Scene(solids))
    assert [skin.opacity for skin in shape.skins] == [0.3, 1.0] and shape.skins[0].colour == "#112233"
    assert shape.skins[1].faces.min() == 8 and not shape.motion[:8].any() and (shape.motion[8:] == 1).all()
    assert shape_of(Scene(solids[:1])).motion is None


def test_scenes_of_the_brake_become_pictures_with_data():
    modes, model = small.complex_modes(), small.reduced_model()
    scenes = [mode_shapes.assembly(small.structure()), mode_shapes.disc_mode(small.structure().disc, 0),
              mode_shapes.unstable_mode(model, modes, 0)]
    assembly, disc, unstable = in_space(scenes, [b"a", b"b", b"c"])
    assert assembly.csv.startswith("x / mm,y / mm,z / mm\n") and not assembly.places
    assert len(disc.csv.splitlines()[0].split(",")) == len(unstable.csv.splitlines()[0].split(",")) == 9
    assert in_space(scenes, None) is None
