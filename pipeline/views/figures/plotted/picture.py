"""A picture with the numbers that it shows, as CSV text and as places on the picture."""

import base64
import json
import zipfile
from dataclasses import dataclass, field
from functools import cached_property
from io import BytesIO

from pipeline.views.figures.plotted.columns import Table
from pipeline.views.figures.plotted.shape import Shape, shape_of

#: CSV text of more bytes than these is zipped
_PLAIN = 64_000
#: date of the file in a zip archive, so that the same numbers give the same bytes
_DATE = (1980, 1, 1, 0, 0, 0)


@dataclass(frozen=True)
class Picture:
    """PNG or WebP bytes or SVG text, and the Series shown in its Panels.

    ``moving``: an animation, whose numbers are those of its last frame. ``shape``: of a picture in three dimensions.
    """

    image: bytes | str
    panels: tuple = field(default=(), compare=False)
    series: tuple = field(default=(), compare=False)
    moving: bool = False
    shape: Shape | None = field(default=None, compare=False)

    @cached_property
    def table(self):
        """Table of the numbers."""
        return Table.of(self.series)

    @cached_property
    def csv(self):
        """The numbers as CSV text: a column for each quantity, with its unit; empty where there are none."""
        return self.table.text() if self.series else ""

    @cached_property
    def places(self):
        """JSON text: where the panels lie on the picture, and which columns are points in which panel."""
        if self.moving or not self.panels or not self.series:
            return ""
        return json.dumps({"panels": [panel.place() for panel in self.panels], "series": self.table.places()},
                          separators=(",", ":"), allow_nan=False)


def in_space(scenes, images):
    """[Picture] of Scenes, from the ``images`` (bytes) that were drawn of them; None where none could be drawn."""
    if images is None:
        return None
    shapes = map(shape_of, scenes)
    return [Picture(image, (), shape.series, shape=shape) for image, shape in zip(images, shapes, strict=True)]


def data_uri(csv, name):
    """(Address, file name) of CSV text as a download: plain, or zipped under its ``name`` if it is long."""
    content = csv.encode()
    if len(content) <= _PLAIN:
        return f"data:text/csv;base64,{base64.b64encode(content).decode()}", f"{name}.csv"
    stream = BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(zipfile.ZipInfo(f"{name}.csv", _DATE), content, zipfile.ZIP_DEFLATED)
    return f"data:application/zip;base64,{base64.b64encode(stream.getvalue()).decode()}", f"{name}.csv.zip"
