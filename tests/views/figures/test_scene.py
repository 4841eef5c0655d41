"""Pictures by pyvista: drawn in a child process, same bytes twice, no crash without OpenGL."""

import numpy as np
import pytest

from pipeline.contract import BrakechainError
from pipeline.views.figures import mode_shapes
from pipeline.views.figures.scene import Scene, Solid, render
from tests.views import products_for_views as small


@pytest.fixture(scope="module")
def pictures():
    structure, model, modes = small.structure(), small.reduced_model(), small.complex_modes()
    scenes = [mode_shapes.assembly(structure), *(mode_shapes.disc_mode(structure.disc, n) for n in (0, 0, 1)),
              mode_shapes.unstable_mode(model, modes, 0)]
    drawn = render(scenes)
    if drawn is None:
        pytest.skip("this machine offers no OpenGL")
    return drawn


def test_scenes_become_pictures_with_the_same_bytes_for_the_same_scene(pictures):
    assert len(pictures) == 5
    assert all(picture.startswith(b"\x89PNG") for picture in pictures[:4])
    assert pictures[1] == pictures[2]
    assert pictures[1] != pictures[3]


def test_an_unstable_mode_moves_through_one_period_for_ever(pictures):
    from io import BytesIO

    from PIL import Image, ImageSequence

    moving = Image.open(BytesIO(pictures[4]))
    frames = [np.asarray(frame.convert("L"), float) for frame in ImageSequence.Iterator(moving)]
    assert moving.format == "WEBP" and moving.info["loop"] == 0 and len(frames) == moving.n_frames == 16
    changes = [abs(frames[k] - frames[k - 1]).mean() for k in range(16)]    # last to first as well
    assert max(changes) < 3 * min(changes) and min(changes) > 0.05


def test_a_picture_is_not_empty(pictures):
    from io import BytesIO

    from PIL import Image

    for picture in pictures:
        pixels = np.asarray(Image.open(BytesIO(picture)).convert("L"))
        assert 0.05 < (pixels < 250).mean() < 0.9


def test_a_machine_without_opengl_gets_no_pictures_and_no_crash(monkeypatch):
    monkeypatch.setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/none")
    monkeypatch.setenv("VTK_DEFAULT_OPENGL_WINDOW", "vtkOSOpenGLRenderWindow")
    drawn = render([mode_shapes.disc_mode(small.structure().disc, 0)])
    assert drawn is None or drawn[0].startswith(b"\x89PNG")


def test_a_child_that_fails_says_why():
    wrong = Scene((Solid(np.zeros((2, 3)), np.array([[0, 1, 2, 9]]), "no such cell"),))
    with pytest.raises(BrakechainError, match="pyvista"):
        render([wrong])


@pytest.mark.exact
def test_nodal_diameters_are_counted():
    disc = small.structure().disc
    assert [mode_shapes.diameters(disc, mode) for mode in (0, 1)] == [2, 3]


@pytest.mark.exact
def test_one_mode_of_each_pair_is_shown():
    frequency = np.array([0.0, 1e-4, 259.4, 259.4001, 431.6, 660.1, 660.2])
    assert mode_shapes.distinct(frequency, 10).tolist() == [2, 4, 5]
    assert mode_shapes.distinct(frequency, 1).tolist() == [2]
