"""Computed numbers of published facts: a record of what the runs of a case gave, and the table of a document.

A record is the JSON text of data/reference/computed/<case>.json. It holds every testable fact of the case with its
product field and the range of our value over the runs that it was made from, e.g. one per processor kernel, and for
each run the commits and kernels of its products. The tables of README.md and docs/ are rendered from records; tests
hold them together.
"""

from math import floor, log10

from pipeline.views.chapters.comparison import tolerance as tolerance_text
from pipeline.views.chapters.comparison import unit_text
from pipeline.views.figures.agreement import judged
from pipeline.views.figures.number_format import MINUS, RANGE, number

#: columns of the table
HEAD = ("fact", "paper", "ours", "tolerance", "verdict", "product field")
#: significant digits of a value without a tolerance
_DIGITS = 3


def record(comparisons, runs):
    """The record of ``comparisons``, one per run of the same case; ``runs`` say how each was computed."""
    first = comparisons[0]
    return {"runs": runs, "facts": {str(first.key[row]): _fact(comparisons, row) for row in testable(comparisons)}}


def testable(comparisons):
    """Rows that have a verdict in any of the comparisons."""
    return sorted({row for comparison in comparisons for row in judged(comparison)})


def _fact(comparisons, row):
    """One fact of the record; ``ours`` is [lowest, highest] over the comparisons that have the number."""
    first = next(c for c in comparisons if row in judged(c))
    values = [float(c.ours[row]) for c in comparisons if c.ours_known[row]]
    return {"quantity": str(first.row[row]), "field": str(first.field[row]), "unit": str(first.unit[row]),
            "paper": float(first.published[row]) if first.published_known[row] else None,
            "tolerance": float(first.tolerance[row]), "allowed": tolerance_text(first, row),
            "ours": [float(f"{value:.8g}") for value in (min(values), max(values))],
            "verdict": _verdict([str(c.verdict[row]) for c in comparisons]), "tuned": str(first.tuned[row])}


def _verdict(verdicts):
    """'within' or 'outside' where all runs agree; else 'outside', since the fact is not met on every processor."""
    return "within" if set(verdicts) == {"within"} else "outside"


def table(facts, keys=()):
    """Head and rows of the facts of a record, of those in ``keys`` if any, in their order."""
    return HEAD, [_cells(facts[key]) for key in keys or facts]


def _cells(fact):
    unit, digit = unit_text(fact["unit"]), last_digit(fact)
    paper = "—" if fact["paper"] is None else f"{number(fact['paper'])}{unit}"
    tuned = f", tuned: {fact['tuned']}" if fact["tuned"] else ""
    return (fact["quantity"], paper, f"{_ours(fact['ours'], digit)}{unit}", fact["allowed"],
            f"{fact['verdict']}{tuned}", fact["field"])


def markdown(facts, keys=()):
    """The table as Markdown."""
    head, rows = table(facts, keys)
    lines = [head, ["---"] * len(head), *([*row[:-1], ", ".join(f"`{name}`" for name in row[-1].split(", "))]
                                          for row in rows)]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def last_digit(fact):
    """Size of the last printed digit of our value: a tenth of the tolerance or less, three digits without one."""
    largest = max(map(abs, fact["ours"]))
    if fact["unit"] == "1" and all(value.is_integer() for value in map(float, fact["ours"])):
        return 1.0      # a count
    if fact["tolerance"] > 0:
        return 10.0 ** floor(log10(fact["tolerance"] / 10) + 1e-9)
    return 10.0 ** (floor(log10(largest)) + 1 - _DIGITS) if largest else 1.0


def _ours(limits, digit):
    """'259', or '29.8–30.2' where the runs differ in the printed digits."""
    low, high = (_rounded(value, digit) for value in limits)
    between = RANGE if limits[0] >= 0 else " to "
    return low if low == high else f"{low}{between}{high}"


def _rounded(value, digit):
    decimals = max(0, -floor(log10(digit) + 1e-9))
    text = f"{round(value / digit) * digit:.{decimals}f}"
    return text.replace("-", MINUS) if float(text) else text.removeprefix("-")


def deviations(facts, fresh):
    """Facts of ``fresh`` (one more run) that the record does not cover, as {key: sentence}.

    A further processor kernel may lie beyond the recorded range by as much as that range is wide, or by one printed
    digit.
    """
    differing = {}
    for key, fact in facts.items():
        if key not in fresh:
            differing[key] = f"{fact['quantity']}: recorded, and no longer computed"
            continue
        low, high = fact["ours"]
        margin = max(high - low, last_digit(fact))
        new = fresh[key]["ours"]
        if not (low - margin <= new[0] and new[1] <= high + margin):
            differing[key] = f"{fact['quantity']}: recorded {low:.6g} to {high:.6g}, now {new[0]:.6g} {fact['unit']}"
    return differing | {key: f"{fact['quantity']}: not recorded" for key, fact in fresh.items() if key not in facts}
