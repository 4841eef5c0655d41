"""Chapter: which design of the declared space squeals least, how it was found, and what was not searched?"""

import numpy as np

from pipeline.views.chapters.chapter import Chapter, Figure, Table
from pipeline.views.chapters.models.sensitivities import in_words
from pipeline.views.figures.models import design_search as pictures
from pipeline.views.figures.number_format import number, plural, quantity

_GROWTH = {"largest": "largest growth rate", "sum": "sum of the growth rates"}


def chapter(product, look):
    """Chapter of the product DesignSearch; None without a space."""
    if not len(product.parameter):
        return None
    return Chapter(
        "design-search", "Search for a design",
        f"{plural(int(product.computed), 'brake')} beside the case, of a budget of {int(product.budget)}, in a declared"
        f" space of {plural(len(product.parameter), 'value')}. {plural(len(product.start_ended), 'start')} went down"
        f" the slope of the {_GROWTH[str(product.kind)]}{_with_costs(product)}, in the reduced model.",
        statement(product), _figures(product),
        (_values(product), _points(product), _starts(product), _open(product)))


def statement(product):
    """What the best design is and what it does; empty without a space."""
    if not len(product.parameter):
        return ""
    what, tried = _GROWTH[str(product.kind)], plural(int(product.computed), "brake")
    if product.best <= 0:
        return (f"None of the {tried} that were tried is better than the case ({what}"
                f" {quantity(product.growth[0], '1/s', 3)}).")
    best = int(product.best)
    left = "no unstable mode is left in the reduced model" if not product.unstable[best] else \
        f"{plural(int(product.unstable[best]), 'unstable mode')} {'is' if product.unstable[best] == 1 else 'are'} left"
    return (f"The best of {tried} lowers the {what} from {number(product.growth[0], 3)} to"
            f" {quantity(product.growth[best], '1/s', 3)} ({left}) with {_changed(product, best)}{_at_cost(product)}."
            " That no better design exists is not shown: see what was not searched.")


def written(product, parameter, brake):
    """A value of a brake as it is shown."""
    if product.choices[parameter]:
        return str(product.written[brake, parameter])
    if not product.unit[parameter]:
        return number(product.value[brake, parameter], 3)
    return quantity(product.value[brake, parameter], str(product.unit[parameter]), 4)


def _changed(product, best):
    return ", ".join(f"{in_words(name)} {written(product, p, best)} instead of {written(product, p, 0)}"
                     for p, name in enumerate(product.parameter) if product.written[best, p] != product.written[0, p])


def _at_cost(product):
    shown = [f"{name} {number(cost, 3)} {unit}".strip() for name, unit, cost in
             zip(product.cost_name, product.cost_unit, product.best_cost, strict=True)]
    return f", at {', '.join(shown)}" if shown else ""


def _with_costs(product):
    return " with weighted costs" if product.cost.any() else ""


def _figures(product):
    ranges = [p for p, choices in enumerate(product.choices) if not choices]
    figures = [Figure(pictures.course(product), "Objective of every brake in the order in which they were computed,"
                      f" the case first; the best has {quantity(product.objective[int(product.best)], '1/s', 3)}.")]
    if ranges:
        names = [in_words(product.parameter[p]) for p in ranges]
        figures.append(Figure(pictures.spread(product, names, shares(product)[:, ranges]),
                              "Where in their ranges the values of the brakes lie: the case (circle), the best (filled)"
                              " and all others (lines)."))
    return tuple(figures)


def shares(product):
    """(brake, parameter) where in its range each value lies; of lists 0."""
    wide = product.upper > product.lower
    return np.where(wide, (product.value - product.lower) / np.where(wide, product.upper - product.lower, 1.0), 0.0)


def _values(product):
    best, rows = int(product.best), []
    for p, name in enumerate(product.parameter):
        limits = str(product.choices[p]) or " to ".join(
            quantity(end, str(product.unit[p]), 4) if product.unit[p] else number(end)
            for end in (product.lower[p], product.upper[p]))
        rows.append((in_words(name), limits, written(product, p, 0), written(product, p, best), str(product.slope[p]),
                     str(name)))
    return Table(("value", "searched", "case", "best", "slope", "setting"), tuple(rows),
                 "Values of the space; best_design.yaml holds the best as a piece of a case", (2, 3), (1,))


def _points(product):
    rows = tuple((quantity(p, "Pa", 3), quantity(s, "rad/s"), number(b, 3), number(a, 3), str(nb), str(na))
                 for p, s, b, a, nb, na in zip(product.pressure, product.speed, product.growth_before,
                                               product.growth_after, product.unstable_before, product.unstable_after,
                                               strict=True))
    return Table(("pressure", "speed", "growth before, 1/s", "after, 1/s", "unstable modes before", "after"), rows,
                 "Largest growth rate at each operating point, in the case and in the best design", (0, 1, 2, 3, 4, 5))


def _starts(product):
    rows = tuple((str(k + 1), _objective(product, first), _objective(product, best), str(ended)) for k, (
        first, best, ended) in enumerate(zip(product.start_first, product.start_best, product.start_ended,
                                             strict=True)))
    return Table(("start", "objective at its beginning, 1/s", "smallest, 1/s", "why it ended"), rows,
                 "Starts of the search", (0, 1, 2), (3,))


def _open(product):
    return Table(("the search leaves open",), tuple((str(sentence),) for sentence in product.not_searched),
                 "What was not searched", (), (0,))


def _objective(product, brake):
    return "not computed" if brake < 0 else number(product.objective[brake], 4)
