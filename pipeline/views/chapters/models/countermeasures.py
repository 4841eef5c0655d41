"""Chapter: what does each countermeasure do to unstable modes and to the probability of squeal, and at what cost?"""

import numpy as np

from pipeline.views.chapters.chapter import Chapter, Figure, Table
from pipeline.views.chapters.models.countermeasure_modes import (
    HIGHER,
    MODES,
    before_after,
    distinct,
    in_words,
    modes_table,
    name_of,
)
from pipeline.views.figures.models import countermeasures as pictures
from pipeline.views.figures.number_format import number, percent, plural, quantity
from pipeline.views.figures.probability import nominal

_STATES = ("gone", "weaker", "unchanged", "ambiguous", "stronger", "new")


def chapter(product, look):
    """Chapter of the product Countermeasures; None without any."""
    if not len(product.variant):
        return None
    paired = " The draws are those of the case: a change is judged draw by draw." \
        if product.draws and product.paired.all() else ""
    return Chapter(
        "countermeasures", "Countermeasures",
        f"{plural(len(product.variant), 'variant')} of the brake compared with it at the same operating points. Modes"
        " before and after are matched by their shapes (MAC) among all modes, stable ones too; variants are computed in"
        " the reduced model. A change within what refined models move a growth rate by counts as none."
        + paired, statement(product), _figures(product),
        (summary_table(product), *modes_table(product), *_bands(product)))


def statement(product):
    """Which variant helps most, by how much, at what cost, and what it makes worse; empty without variants."""
    if not len(product.variant):
        return ""
    best = best_variant(product)
    if best is None:
        return f"{_nothing(product)} {' '.join(_worse(product, k) for k in range(len(product.variant)))}".strip()
    cost = cost_in_words(product, best)
    return f"{_gain(product, best)}{f', at {cost}' if cost else ''}. {_worse(product, best)}"


def best_variant(product):
    """Index of the variant that lowers the probability of squeal most or, without draws, the largest growth rate; None
    where none does beyond its interval, or beyond the error that refinement shows."""
    if product.draws:
        helps = np.flatnonzero(product.overall_change_interval[:, 1] < 0)
        return int(helps[np.argmin(product.overall_change[helps])]) if len(helps) else None
    change = np.array([_largest(product, k)[1] - _largest(product, k)[0] for k in range(len(product.variant))])
    best = int(np.argmin(change))
    allowed = product.error[product.mode_variant == best].max(initial=0.0)
    return best if change[best] < -allowed else None


def _largest(product, variant):
    """Largest growth rates (before, after) of the modes of a variant; 0 where all are stable."""
    here = product.mode_variant == variant
    return tuple(float(getattr(product, when).real[here & (getattr(product, f"{when}_known") == 1)].max(initial=0.0))
                 for when in ("before", "after"))


def _gain(product, variant):
    name = name_of(product, variant)
    if not product.draws:
        before, after = _largest(product, variant)
        return (f"{name} lowers the largest growth rate most, from {number(before, 3)} to {quantity(after, '1/s', 3)}"
                " (no probabilities were computed)")
    return (f"{name} lowers the probability of squeal most: {percent(product.overall, 2)} of the draws squeal without"
            f" it at any operating point, {percent(product.variant_overall[variant], 2)} with it,"
            f" {points(-product.overall_change[variant])} fewer"
            f" (95 %: {points(-product.overall_change_interval[variant, 1], '')} to"
            f" {points(-product.overall_change_interval[variant, 0], '')})")


def points(share, unit=" percentage points"):
    """'29.5 percentage points' for 0.295."""
    return f"{number(round(100 * float(share), 1), 3)}{unit}"


def _nothing(product):
    if not product.draws:
        return "No variant lowers the largest growth rate beyond the error that refinement shows."
    if not float(product.overall):
        return "No draw of the case squeals: there is nothing to lower."
    return (f"No variant lowers the probability of squeal, {percent(product.overall, 2)} of the draws, beyond its"
            " interval.")


def cost_in_words(product, variant):
    """'mass 0.1 kg, price 2' of what is stated; empty without any."""
    stated = np.flatnonzero(product.cost_known[variant])
    return ", ".join(f"{product.cost_name[c]} {number(product.cost[variant, c])} {product.cost_unit[c]}".strip()
                     for c in stated)


def _worse(product, variant):
    """What a variant makes worse, and how many matches are ambiguous."""
    name = name_of(product, variant)
    worse = [row for row in distinct(product, variant) if product.state[row] in HIGHER]
    doubt = np.sum((product.mode_variant == variant) & (product.state == "ambiguous"))
    tail = f" Ambiguous matches, which say nothing: {int(doubt)}." if doubt else ""
    tail = _more_likely(product, variant) + tail
    if not worse:
        return f"{name} makes no other mode worse beyond the error that refinement shows.{tail}"
    shown = "; ".join(in_words(product, row) for row in worse[:2])
    more = f"; and {plural(len(worse) - 2, 'more mode')}" if len(worse) > 2 else ""
    return f"{name} makes other modes worse: {shown}{more}.{tail}"


def _octave(product, band):
    return f"{nominal(product.band[band]) / 1e3:g} kHz"


def _more_likely(product, variant):
    """The 1/3 octaves in which more draws are unstable, beyond the interval; empty without any."""
    more = np.flatnonzero(product.band_change_interval[variant, :, 0] > 0)
    shown = [f"{_octave(product, b)} ({percent(product.band_probability[b], 2)} to"
             f" {percent(product.variant_band_probability[variant, b], 2)} of the draws)" for b in more]
    return f" Unstable modes become more likely in the 1/3 octaves of {', '.join(shown)}." if shown else ""


def _bands(product):
    """Shares of unstable draws by 1/3 octave; none without draws."""
    used = np.flatnonzero((product.band_probability > 0) | (product.variant_band_probability > 0).any(axis=0))
    if not len(used):
        return ()
    rows = []
    for b in used:
        cells = []
        for share, (low, high) in zip(product.variant_band_probability[:, b], product.band_change_interval[:, b],
                                      strict=True):
            cells.append(percent(share) + (" (more)" if low > 0 else " (less)" if high < 0 else ""))
        rows.append((_octave(product, b), percent(product.band_probability[b]), *cells))
    head = "1/3 octave", "as it is", *map(str, product.variant)
    title = ("Share of the draws with an unstable mode at any operating point, by 1/3 octave; more and less: beyond the"
             " 95 % interval of the change, of each band by itself")
    return (Table(head, tuple(rows), title, tuple(range(1, len(head)))),)


def _figures(product):
    rows = [row for k in range(len(product.variant)) for row in distinct(product, k)[:MODES]]
    figures = (Figure(pictures.dumbbells(product, rows, [before_after(product, row) for row in rows]),
                      "Growth rate of each mode before (circle) and after (mark), where it is largest: green and to the"
                      " left, lower; red and to the right, higher; grey, no change beyond the error, or an ambiguous"
                      " match (dotted). Marks at the left edge lie beyond it."),) if rows else ()
    if not product.draws:
        return figures
    return (Figure(pictures.probabilities(product), "Share of the draws that squeal at any operating point, without and"
                   " with each countermeasure, with 95 % interval."), *figures)


def summary_table(product):
    """One row per variant: probability, change, costs, what became of the modes, what it is."""
    rows, costs = [], [f"{name} / {unit}" if unit else str(name) for name, unit in
                       zip(product.cost_name, product.cost_unit, strict=True)]
    for k in range(len(product.variant)):
        states = product.state[product.mode_variant == k]
        stated = (number(value) if known else "" for value, known in
                  zip(product.cost[k], product.cost_known[k], strict=True))
        counts = ", ".join(f"{np.sum(states == s)} {s}" for s in _STATES if (states == s).any())
        rows.append((str(product.variant[k]), *_probability(product, k), *stated, number(_largest(product, k)[1], 3),
                     counts or "none unstable",
                     ": ".join(filter(None, (str(product.note[k]), str(product.change[k]))))))
    drawn = ("squealing draws", "change / % points", "beyond interval") if product.draws else ()
    head = ("countermeasure", *drawn, *costs, "growth rate / 1/s", "modes, all operating points", "what it changes")
    title = "Countermeasures, with the largest growth rate that each leaves" + (
        f"; without any, {percent(product.overall, 3)} of the draws squeal at any operating point" if product.draws
        else "")
    return Table(head, tuple(rows), title, tuple(range(1, len(head) - 2)), (len(head) - 2, len(head) - 1))


def _probability(product, variant):
    if not product.draws:
        return ()
    share, ends = product.variant_overall[variant], product.variant_overall_interval[variant]
    change, reach = product.overall_change[variant], product.overall_change_interval[variant]
    return (f"{percent(share)} ({percent(ends[0])} to {percent(ends[1])})",
            f"{points(change, '')} ({points(reach[0], '')} to {points(reach[1], '')})",
            "yes" if reach[0] > 0 or reach[1] < 0 else "no")
