"""Chapter: cost of three friction descriptions in an implicit calculation, beside the claims of the 1999 paper."""

import numpy as np

from pipeline.views.chapters.chapter import Chapter, Table
from pipeline.views.figures.number_format import number, percent, quantity

WITHOUT, WITH = 0, 1


def chapter(product, look):
    """Chapter of the product FrictionDescriptions."""
    names = list(product.description)
    return Chapter(
        "friction_descriptions", "Three descriptions of stick",
        f"A block on elastic feet under a pulsating load, time step {quantity(float(product.step), 's', 2)},"
        " Newton's method; where the load pulsates by more than its mean, contact is lost. Work counts"
        " factorisations, relative to the cheapest run.",
        _conclusion(product, names), (), (_counts(product, names), _curve(product, names)))


def _conclusion(product, names):
    """The claims of section 4, each beside our count."""
    steady = product.modulation < 1
    extra = product.iterations[WITHOUT] / product.iterations[WITH] - 1
    lagging = names[int(np.argmax(product.iterations.mean(axis=(0, 1))))]
    worst = names[np.unravel_index(np.argmax(product.worst), product.worst.shape)[2]]
    rigid = names.index("rigid")
    work = product.cost[..., rigid].mean() / np.delete(product.cost, rigid, axis=2).mean()
    outcome = "always converged" if product.converged[..., rigid].all() else "failed to converge in some steps"
    text = (f"Closest to the curve of a single contact: {names[int(np.argmin(product.curve_error))]} (the paper says"
            f" evolution). Most iterations: {lagging}; the worst single step: {worst} with {product.worst.max()} (the"
            f" paper: evolution converges worst). Leaving out the unsymmetric term changes the iterations by"
            f" {percent(extra.min(), 2)} to {percent(extra.max(), 2)}. Rigid stick {outcome} and took"
            f" {number(work, 2)} times the work of the others (the paper: it always converges, slowly).")
    if steady.any():
        text += f" Steady sliding differs by {percent(_spread(product, steady), 2)} between descriptions"
        text += (f", motion that loses contact by {percent(_spread(product, ~steady), 2)}." if (~steady).any() else ".")
    return text


def _spread(product, selected):
    """Largest difference of the mean displacement between descriptions, over its size."""
    shift = product.mean_shift[WITH][selected]
    return float(np.max(np.ptp(shift, axis=1) / np.abs(shift).mean(axis=1)))


def _counts(product, names):
    rows = []
    for m, modulation in enumerate(product.modulation):
        for tangent, label in ((WITH, "yes"), (WITHOUT, "no")):
            for d, name in enumerate(names):
                at = tangent, m, d
                rows.append((percent(modulation, 3), label, name, number(product.iterations[at], 3),
                             str(product.worst[at]), str(product.halvings[at]),
                             "yes" if product.converged[at] else "NO", number(product.cost[at], 2),
                             percent(product.sliding_share[at], 2)))
    head = ("load pulsates by", "unsymmetric term", "description", "iterations per step", "worst step", "halved steps",
            "converged", "work", "sliding")
    return Table(head, tuple(rows), "Newton's method under three descriptions", numeric=(3, 4, 5, 7, 8))


def _curve(product, names):
    rows = tuple((name, percent(error, 2)) for name, error in zip(names, product.curve_error, strict=True))
    return Table(("description", "deviation from the curve"), rows, "Tangential curve of one Hertz contact",
                 numeric=(1,))
