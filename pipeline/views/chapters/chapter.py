"""What a page is made of: chapters of sentences, figures and tables."""

import base64
from dataclasses import dataclass

from pipeline.views.figures.plotted.picture import Picture, data_uri


@dataclass(frozen=True)
class Look:
    """How pictures are drawn."""

    dpi: int = 150
    shapes: int = 6     # mode shapes of the disc; 0: none, and no unstable mode in motion


@dataclass(frozen=True)
class Figure:
    """A Picture (or PNG or WebP bytes without numbers) and a caption that states its numbers."""

    image: Picture | bytes
    caption: str
    small: bool = False

    @property
    def picture(self):
        """The Picture."""
        return self.image if isinstance(self.image, Picture) else Picture(self.image)

    @property
    def uri(self):
        """The picture as a data URI."""
        image = self.picture.image
        kind = "svg+xml" if isinstance(image, str) else "webp" if image[:4] == b"RIFF" else "png"
        data = image.encode() if isinstance(image, str) else image
        return f"data:image/{kind};base64,{base64.b64encode(data).decode()}"

    def data(self, name):
        """(Data URI, file name) of its numbers as CSV, the file named after ``name``; None without numbers."""
        return data_uri(self.picture.csv, name) if self.picture.csv else None


@dataclass(frozen=True)
class Sound:
    """A sound to listen to (bytes of a WAV file), and a caption that says what it is."""

    data: bytes
    caption: str

    @property
    def uri(self):
        """The sound as a data URI."""
        return f"data:audio/wav;base64,{base64.b64encode(self.data).decode()}"


@dataclass(frozen=True)
class Table:
    """Rows of text under a head; ``numeric`` columns are right-aligned, ``wide`` ones hold sentences.

    ``subtitles`` are small second lines below the first cell of each row, none if empty.
    """

    head: tuple
    rows: tuple
    title: str
    numeric: tuple = ()
    wide: tuple = ()
    folded: bool = False
    subtitles: tuple = ()


def remarks_table(remarks, title):
    """(Table of the sentences ``remarks``,), () of none."""
    rows = tuple((str(line),) for line in remarks)
    return (Table(("remark",), rows, title, wide=(0,), folded=len(rows) > 12),) if rows else ()


@dataclass(frozen=True)
class Block:
    """One thing of several alike: what there is to say of it, and its figures side by side."""

    title: str
    text: str
    figures: tuple = ()


@dataclass(frozen=True)
class Chapter:
    """One step of the chain on the page: what is shown, what follows from it."""

    anchor: str
    title: str
    see: str
    conclude: str
    figures: tuple = ()
    tables: tuple = ()
    notes: tuple = ()
    blocks: tuple = ()
    sounds: tuple = ()
