"""Named columns of numbers: those of each element of a picture, and all of them side by side as CSV text."""

import csv
import re
from dataclasses import dataclass
from io import StringIO
from itertools import zip_longest

import numpy as np

_POWER = re.compile(r"\$\^\{?([^}$]*)\}?\$")
#: significant digits of numbers by their bytes: of curves, of maps
_DIGITS = {8: 7, 4: 5}


@dataclass(frozen=True)
class Column:
    """``values`` (n,), numbers or texts, of the quantity ``name``, with its unit; ``axis``: 'x', 'y' or ''."""

    name: str
    values: np.ndarray
    axis: str = ""

    def same(self, other):
        """Whether both have one name and the same values."""
        kinds = self.values.dtype.kind, other.values.dtype.kind
        return self.name == other.name and kinds[0] == kinds[1] and np.array_equal(self.values, other.values,
                                                                                    equal_nan=kinds[0] == "f")

    def texts(self):
        """The values as texts, empty where there is none."""
        if self.values.dtype.kind not in "fiu":
            return [str(value) for value in self.values]
        digits = _DIGITS.get(self.values.dtype.itemsize, 7)
        return ["" if value != value else f"{value:.{digits}g}" for value in self.values.tolist()]


@dataclass(frozen=True)
class Series:
    """Columns (n,) of one element of a picture: ``label``, its name in a legend; ``panel``, the index of its axes, and
    ``title`` of these where there are several; ``titled``: others of them show the same quantity."""

    panel: int
    label: str
    columns: tuple
    title: str = ""
    titled: bool = False


@dataclass(frozen=True)
class Table:
    """All columns of a picture, each name once, and which of them each series has: ((panel, (index, ...)), ...)."""

    columns: tuple
    series: tuple

    @classmethod
    def of(cls, series):
        """Table of some Series; equal columns, such as a common abscissa, appear once."""
        originals, columns, members = [], [], []
        for item in series:
            indices = []
            for column in item.columns:
                shared = column.axis == "x" or column.values.dtype.kind == "U"
                known = next((k for k, other in enumerate(originals) if shared and other.same(column)), len(columns))
                if known == len(columns):
                    originals.append(column)
                    name = _free({other.name for other in columns}, column, item)
                    columns.append(Column(name, column.values, column.axis))
                indices.append(known)
            members.append((item.panel, tuple(indices)))
        return cls(tuple(columns), tuple(members))

    def text(self):
        """CSV text, the names first; shorter columns end in empty cells."""
        stream = StringIO()
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(column.name for column in self.columns)
        writer.writerows(zip_longest(*(column.texts() for column in self.columns), fillvalue=""))
        return stream.getvalue()

    def places(self):
        """[{panel, x, y, more}] of each series that has points: indices of its columns."""
        made = []
        for panel, indices in self.series:
            at = {self.columns[k].axis: k for k in indices if self.columns[k].axis}
            if len(at) == 2:
                more = [k for k in indices if not self.columns[k].axis]
                made.append({"panel": panel, **at, **({"more": more} if more else {})})
        return made


def named(label):
    """A label of an axis as the name of a column: on one line, with '/ 1' where it has no unit."""
    text = " ".join(_POWER.sub(r"^\1", label).split())
    return text if " / " in text else f"{text} / 1"


def _free(taken, column, series):
    """A name of a column of some Series that is not ``taken``: with label and title as far as it takes these."""
    plain = column.axis == "x" or column.values.dtype.kind == "U"
    title, label = series.title if series.titled else "", "" if plain else series.label
    starts = (title, label), (title, series.label), (series.title, series.label)
    tries = [", ".join(filter(None, parts)) for parts in starts]
    named_so = [f"{start}: {column.name}" if start else column.name for start in tries]
    numbered = (f"{tries[-1]}{': ' * bool(tries[-1])}({count}) {column.name}" for count in range(2, len(taken) + 3))
    return next(name for name in (*named_so, *numbered) if name not in taken)
