"""Chapter: modes of a modal test, with their uncertainty."""

import numpy as np

from pipeline.views.chapters.chapter import Chapter, Figure, Table
from pipeline.views.figures.bench import modal_test as pictures
from pipeline.views.figures.number_format import number, percent, plural, quantity, span


def chapter(product, look):
    """Chapter of the product ModalTest."""
    figures, tables = [], []
    for name, modes in product.runs.items():
        count = plural(len(modes.frequency), "mode")
        figures.append(Figure(pictures.stabilisation(modes, look.dpi), f"Run {name}: responses, measured (grey) and as"
                              " the modes give them (blue); below, poles of every order: blue came back from the order"
                              f" before, red became one of {count}, at the lines."))
        if len(modes.frequency) > 1:
            figures.append(Figure(pictures.likeness(modes, look.dpi), f"Run {name}: likeness (MAC) of the shapes among"
                                  f" themselves, at the {plural(len(modes.place), 'response')} measured."))
        tables.append(_table(name, modes))
    told = " ".join(_sentence(name, modes) for name, modes in product.runs.items())
    return Chapter("modal_test", "Modes of the modal test",
                   f"Frequency responses of {plural(len(product.runs), 'run')}, taken together, give natural"
                   " frequencies, damping ratios and shapes. Errors are standard deviations by what is left of each"
                   " response.", told, tuple(figures), tuple(tables))


def headline(product):
    """(text, tone) of the first screen."""
    every = [modes for modes in product.runs.values() if len(modes.frequency)]
    if not every:
        return "No mode in the frequency responses", "warning"
    low, high = (f(np.concatenate([m.frequency for m in every])) for f in (np.min, np.max))
    count = sum(len(modes.frequency) for modes in every)
    return f"{plural(count, 'mode')} from {quantity(low, 'Hz', 3)} to {quantity(high, 'Hz', 3)}", "quiet"


def key_figure(product, look):
    """Figure of the first screen: the first run's diagram."""
    name, modes = next(iter(product.runs.items()))
    return Figure(pictures.stabilisation(modes, look.dpi), f"Run {name}: responses, and poles that became modes (red).")


def _sentence(name, modes):
    count = len(modes.frequency)
    if not count:
        return f"Run {name}: no mode stands out of the noise."
    pairs = np.count_nonzero(modes.partner > np.arange(count))
    frequency, damping = (percent(float(np.median(std / value)), 2) for std, value in (
        (modes.frequency_std, modes.frequency), (modes.damping_ratio_std, modes.damping_ratio)))
    told = (f"Run {name}: {plural(count, 'mode')}, frequencies known to {frequency}, damping ratios of"
            f" {span(100 * modes.damping_ratio, '1', 2)} % to {damping} of themselves (medians). The modes leave"
            f" {percent(np.median(modes.noise), 2)} of a response.")
    if modes.narrow.any():
        told += (f" The damping of {plural(int(modes.narrow.sum()), 'mode')} comes out too large: fewer than four"
                 " lines lie within the peak; take a finer response_functions.resolution, and a longer record.")
    return told + (f" {plural(pairs, 'pair')} of modes {'is' if pairs == 1 else 'are'} split by"
                   f" {_splits(modes)}." if pairs else "")


def _splits(modes):
    first = np.flatnonzero(modes.partner > np.arange(len(modes.frequency)))
    split = modes.frequency[modes.partner[first]] / modes.frequency[first] - 1.0
    low, high = percent(split.min(), 2), percent(split.max(), 2)
    return low if low == high else f"{low} to {high}"


def _table(name, modes):
    rows = tuple((str(k + 1), f"{number(modes.frequency[k], 7)} ± {number(modes.frequency_std[k], 2)}",
                  f"{number(100 * modes.damping_ratio[k], 3)} ± {number(100 * modes.damping_ratio_std[k], 1)}",
                  str(modes.partner[k] + 1) if modes.partner[k] != k else "")
                 for k in range(len(modes.frequency)))
    return Table(("mode", "frequency / Hz", "damping ratio / %", "pair with"), rows, f"Modes of run {name}",
                 numeric=(0, 1, 2, 3), folded=len(rows) > 20)
