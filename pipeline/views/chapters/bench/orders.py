"""Chapter: orders of a shaft in the recordings. Absent where no speed varies."""

import numpy as np

from pipeline.views.chapters.chapter import Chapter, Figure, Table, remarks_table
from pipeline.views.figures.bench import orders as pictures
from pipeline.views.figures.number_format import number, plural, quantity, span

#: channels and rows that are shown
_SHOWN, _ROWS = 4, 60


def chapter(product, look):
    """Chapter of the product Orders; None where it holds nothing."""
    left_out = remarks_table(product.remarks, "Remarks on the channels")
    if not (product.spectra or left_out):
        return None
    see = ("What the recordings hold that follows the revolutions: order 1 is once per revolution, as judder from one"
           " high spot; order 2 twice, and so on.")
    return Chapter("orders", "Orders of the shaft", see, _conclusion(product), tuple(_figures(product, look)),
                   (*_tables(product), *left_out))


def _rows(product):
    """(spectra of a channel, index of the order, bin of its largest amplitude), the largest of each unit first."""
    rows = [(one, k, int(np.argmax(one.level[k]))) for one in product.spectra.values()
            for k in range(len(one.outstanding))]
    return sorted(rows, key=lambda row: (str(row[0].unit), -row[0].level[row[1], row[2]]))


def _speed(one, which):
    return (one.edge[which] + one.edge[which + 1]) / 2


def _frequency(one, k, which):
    return one.outstanding[k] * _speed(one, which) / (2.0 * np.pi)


def largest(product):
    """The largest order of each unit in words; '' where none stands out, or there is no product."""
    units = {}
    for row in _rows(product) if product is not None else ():
        units.setdefault(str(row[0].unit), row)
    return "; ".join(f"order {number(one.outstanding[k], 3)} of {one.channel} with"
                     f" {quantity(one.level[k, b], unit, 3)} at {number(pictures.rpm(_speed(one, b)), 3)} rpm,"
                     f" {quantity(_frequency(one, k, b), 'Hz', 3)}, run {one.run}"
                     for unit, (one, k, b) in units.items())


def key_figure(product, look):
    """Figure of the first screen: the Campbell diagram of the channel with the largest order; None without any."""
    rows = _rows(product) if product is not None else ()
    return _diagram(rows[0][0], look) if rows else None


def _conclusion(product):
    spectra, rows, told = product.spectra.values(), _rows(product), largest(product)
    if not spectra:
        return "No channel has orders, see below why."
    speeds = span([pictures.rpm(edge) for one in spectra for edge in one.edge[[0, -1]]], "1", 3)
    heard = len({id(one) for one, *_ in rows})
    have = f"{heard or 'none'} {'has' if heard < 2 else 'have'}"
    return (f"Of {plural(len(spectra), 'channel')}, at {speeds} rpm, {have} orders that stand out. "
            + (f"The largest: {told}." if told else "What is loud there keeps its frequency while the speed changes, or"
               " is noise.")
            + ("" if all(one.sure[k] for one, k, _ in rows) else " An order or steady tone: over this range of speed a"
               " tone of constant frequency would look alike; more range, or more revolutions a block, tells.")
            + "".join(f" Run {run}, {shaft}: {remark}." for run, shaft, remark in dict.fromkeys(
                (str(one.run), str(one.shaft), str(one.remark)) for one in spectra if str(one.remark)))
            + "".join(f" {remark}." for remark in product.remarks if "overloaded" in remark))


def _diagram(one, look):
    return Figure(pictures.campbell(one, look.dpi),
                  f"Run {one.run}, {one.channel}: Campbell diagram, amplitude over speed and frequency; dashed: "
                  + ("orders that stand out." if len(one.outstanding) else "whole orders, none of which stands out.")
                  + " White: no such speed was recorded.")


def _figures(product, look):
    chosen = sorted(product.spectra.values(), key=lambda one: -len(one.outstanding))
    for one in [one for one in chosen if len(one.outstanding)][:_SHOWN] or chosen[:1]:
        yield _diagram(one, look)
        if len(one.outstanding):
            yield Figure(pictures.levels(one), f"Run {one.run}, {one.channel}: amplitude of its orders over the speed.")


def _tables(product):
    rows = tuple((str(one.run), str(one.channel), number(one.outstanding[k], 3),
                  quantity(one.level[k, b], str(one.unit), 3), number(pictures.rpm(_speed(one, b)), 3),
                  quantity(_frequency(one, k, b), "Hz", 3), "order" if one.sure[k] else "order or steady tone")
                 for one, k, b in _rows(product)[:_ROWS])
    if rows:
        yield Table(("run", "channel", "order", "largest amplitude", "at / rpm", "that is", "what it is"), rows,
                    "Orders", numeric=(2, 3, 4, 5), folded=len(rows) > 12)
