"""Our numbers for the published facts of each system, computed from products: fact key -> Ours, in SI."""

from typing import NamedTuple

import numpy as np

#: a published operating point and one of ours are the same when they agree to this, relative
SAME = 0.01


class Ours(NamedTuple):
    """Our value in SI, None where the products do not give it; and how it was formed, or why it is missing."""

    value: float | None
    note: str


def ours(value, note, lacking="this case does not vary what the row needs"):
    """Ours; a value that is None or not finite is missing."""
    return Ours(None, lacking) if value is None or not np.isfinite(value) else Ours(float(value), note)


def ratio(part, whole):
    """part / whole; nan for a whole of zero."""
    return part / whole if whole else np.nan


def correlation(first, second):
    """Pearson's correlation of two series; nan where one does not vary."""
    return np.corrcoef(first, second)[0, 1] if np.ptp(first) and np.ptp(second) else np.nan


def index_of(wanted, *axes):
    """Place where each axis has its wanted value (to 1 %), None where there is no such place.

    ``wanted`` is one value per axis; a value of None is nowhere.
    """
    if any(value is None for value in wanted):
        return None
    near = [np.abs(axis - value) <= SAME * abs(value) for axis, value in zip(axes, wanted, strict=True)]
    places = np.flatnonzero(np.logical_and.reduce(near))
    return int(places[0]) if len(places) else None
