"""A picture with its numbers: where points lie on it, and its CSV text as a download."""

import base64
import json
import zipfile
from io import BytesIO

import numpy as np
import pytest

from pipeline.views.figures.plotted.picture import Picture, data_uri
from pipeline.views.figures.style import animated, drawing, png, svg


def drawn(values=(1.0, 10.0), finish=svg):
    with drawing() as figure:
        axes = figure.subplots()
        axes.semilogy([0.0, 1.0], values)
        axes.set(xlabel="time / s", ylabel="force / N", xlim=(0, 2), ylim=(1, 100))
        return finish(figure)


@pytest.mark.exact
def test_places_say_where_a_point_lies():
    """The axes begin 0.72 of 4.6 inches from the left and end 0.15 from the right, 0.34 of 3.2 from the top."""
    panel, = json.loads(drawn().places)["panels"]
    assert panel["box"] == pytest.approx([0.72 / 4.6, 0.34 / 3.2, 1 - 0.15 / 4.6, 1 - 0.52 / 3.2], abs=1e-5)
    assert panel["x"] == {"limits": [0.0, 2.0], "log": False} and panel["y"] == {"limits": [1.0, 100.0], "log": True}


def test_a_short_file_is_plain_and_a_long_one_zipped_with_the_same_bytes_each_time():
    address, name = data_uri("a\n1\n", "figure_1")
    assert name == "figure_1.csv" and base64.b64decode(address.partition(",")[2]) == b"a\n1\n"
    long = "a\n" + "1\n" * 100_000
    address, name = data_uri(long, "figure_1")
    assert name == "figure_1.csv.zip" and address == data_uri(long, "figure_1")[0]
    with zipfile.ZipFile(BytesIO(base64.b64decode(address.partition(",")[2]))) as archive:
        assert archive.namelist() == ["figure_1.csv"] and archive.read("figure_1.csv").decode() == long


def test_pictures_are_equal_if_they_look_alike():
    assert drawn() == drawn() != drawn((1.0, 20.0))
    assert Picture(b"") .csv == Picture(b"").places == ""


def test_an_animation_has_the_numbers_of_its_last_frame_and_no_places():
    moving = animated(lambda k: drawn((1.0, 10.0 + k), lambda figure: png(figure, 40)), 3, 100)
    assert moving.moving and not moving.places
    assert moving.csv.splitlines()[-1] == "1,12" and moving.image.startswith(b"\x89PNG")


def test_values_without_a_number_are_left_out_of_the_places():
    picture = drawn((np.nan, 10.0))
    assert picture.csv.splitlines()[1] == "0," and "NaN" not in picture.places
