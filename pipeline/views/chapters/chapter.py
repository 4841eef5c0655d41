"""What a page is made of: chapters of sentences, figures and tables."""

import base64
from dataclasses import dataclass


@dataclass(frozen=True)
class Look:
    """How pictures are drawn."""

    dpi: int = 150
    shapes: int = 6     # mode shape pictures, of each kind


@dataclass(frozen=True)
class Figure:
    """A picture (PNG bytes or SVG text) and the caption that tells its numbers."""

    image: bytes | str
    caption: str
    small: bool = False

    @property
    def uri(self):
        """The picture as a data URI."""
        kind = "svg+xml" if isinstance(self.image, str) else "png"
        data = self.image.encode() if isinstance(self.image, str) else self.image
        return f"data:image/{kind};base64,{base64.b64encode(data).decode()}"


@dataclass(frozen=True)
class Table:
    """Rows of text under a head; ``numeric`` columns are set to the right, ``wide`` ones hold sentences."""

    head: tuple
    rows: tuple
    title: str
    numeric: tuple = ()
    wide: tuple = ()
    folded: bool = False


@dataclass(frozen=True)
class Chapter:
    """One step of the chain on the page: what you see, what to conclude."""

    anchor: str
    title: str
    see: str
    conclude: str
    figures: tuple = ()
    tables: tuple = ()
    notes: tuple = ()
