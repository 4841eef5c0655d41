"""Our numbers for the published facts of each system, computed from products: fact key -> Ours, in SI.

Beside its rows, every module names the product field behind each fact key in ``FIELDS``, e.g. real_area_start:
"micro_friction.real_area"; a key may be a pattern such as frequency_*.
"""

from fnmatch import fnmatchcase
from typing import NamedTuple

import numpy as np

#: a published operating point and one of ours are the same when they agree to this, relative
SAME = 0.01


class Ours(NamedTuple):
    """Our value in SI, None where the products do not give it; and how it was formed, or why it is missing.

    ``field`` is given only where the value comes from another product field than ``FIELDS`` says.
    """

    value: float | None
    note: str
    field: str = ""


def ours(value, note, lacking="this case does not vary what the row needs"):
    """Ours; a value that is None or not finite is missing."""
    return Ours(None, lacking) if value is None or not np.isfinite(value) else Ours(float(value), note)


def field_of(key, fields):
    """The product field behind fact ``key``, e.g. "squeal.event_frequency"; "" where ``fields`` names none."""
    return next((field for pattern, field in fields.items() if fnmatchcase(key, pattern)), "")


def ratio(part, whole):
    """part / whole; nan for a whole of zero."""
    return part / whole if whole else np.nan


def correlation(first, second):
    """Pearson correlation of two series; nan where one of them is constant."""
    return np.corrcoef(first, second)[0, 1] if np.ptp(first) and np.ptp(second) else np.nan


def index_of(wanted, *axes):
    """First index at which each axis has its wanted value (to 1 %), None where there is no such index.

    ``wanted`` is one value per axis; a value of None matches nothing.
    """
    if any(value is None for value in wanted):
        return None
    near = [np.abs(axis - value) <= SAME * abs(value) for axis, value in zip(axes, wanted, strict=True)]
    indices = np.flatnonzero(np.logical_and.reduce(near))
    return int(indices[0]) if len(indices) else None
