"""Chapter: what the bench recorded."""

import numpy as np

from pipeline.views.chapters.chapter import Chapter, Figure, Table, remarks_table
from pipeline.views.figures.bench import recording as pictures
from pipeline.views.figures.number_format import percent, plural, quantity

#: runs that are plotted
MOST = 6


def chapter(product, look):
    """Chapter of the product Recording."""
    shown = [(name, run) for name, run in product.runs.items() if run.channels][:MOST]
    figures = [Figure(pictures.channels(run, look.dpi), _caption(name, run)) for name, run in shown]
    rubbed = [name for name, run in product.runs.items() if run.friction]
    if rubbed:
        figures.append(Figure(pictures.friction(product), "Measured friction over the sliding distance, mean over"
                              f" speeds; runs {', '.join(rubbed)}."))
    files = ", ".join(str(line).split(" ")[0] for line in product.source)
    return Chapter("recording", "What the bench recorded", f"{plural(len(product.runs), 'run')} from {files}.",
                   _noise(product) if shown else "",
                   tuple(figures), (*_channels(product), *_others(product), *_told(product)))


def _noise(product):
    repeats = sum(bool(str(run.repeat_of)) for run in product.runs.values())
    if not repeats:
        return "No run repeats another: the noise has to be estimated from the signals themselves."
    return (f"{plural(repeats, 'run')} {'repeats' if repeats == 1 else 'repeat'} another: their difference gives"
            " the noise.")


def _caption(name, run):
    description = str(run.description)
    conditions = ", ".join(f"{key} {_condition(c)}" for key, c in run.conditions.items())
    return f"Run {name}{': ' + description if description else ''}{' (' + conditions + ')' if conditions else ''}."


def _condition(condition):
    low, high = float(np.min(condition.value)), float(np.max(condition.value))
    unit = str(condition.unit)
    return quantity(low, unit, 3) if low == high else f"{quantity(low, unit, 3)} to {quantity(high, unit, 3)}"


def _channels(product):
    """The table of sampled signals, if any."""
    rows = []
    for name, run in product.runs.items():
        for key, channel in run.channels.items():
            count, lost = len(channel.samples), int(np.sum(np.diff(channel.missing, axis=1)))
            rows.append((name, key, str(channel.measures), str(channel.role),
                         quantity(pictures.largest(channel), str(channel.unit), 3),
                         quantity(channel.rate, "Hz", 4), quantity(count / float(channel.rate), "s", 3),
                         percent(lost / count, 2)))
    head = ("run", "channel", "measures", "role", "largest", "sampling rate", "length", "missing")
    return (Table(head, tuple(rows), "Channels", numeric=(4, 5, 6, 7), folded=len(rows) > 12),) if rows else ()


def _told(product):
    """The table of what was left out, taken for granted or made of what the files hold, if anything."""
    return remarks_table(product.remarks, "Remarks on the files")


def _others(product):
    """The table of measurements other than sampled signals, if any."""
    kinds = {"frf": "frequency response", "modes": "modes", "lines": "peak list", "topography": "height map",
             "friction": "friction"}
    rows = tuple((name, key, label) for name, run in product.runs.items() for kind, label in kinds.items()
                 for key in getattr(run, kind))
    return (Table(("run", "name", "what"), rows, "Other measurements", folded=len(rows) > 12),) if rows else ()
