"""Chapter: the paper's numbers beside ours."""

from pipeline.views.chapters.chapter import Chapter, Figure, Table
from pipeline.views.figures.agreement import agreement, comparable, judged
from pipeline.views.figures.number_format import MINUS, THIN, number, plural

HEAD = ("quantity", "paper", "ours", "tolerance", "verdict", "tuned", "doubt", "source", "how our value was obtained")
WIDE = (0, 6, 8)


def chapter(comparison, look):
    """Chapter of the product Comparison."""
    outside = [str(comparison.row[row]) for row in judged(comparison, "outside")]
    caption = ("Deviation from the paper, in tolerances: blue within, red outside, hollow where the model was tuned to"
               " match; arrows mark values beyond the axis.")
    figures = (Figure(agreement(comparison), caption),) if len(comparable(comparison)) else ()
    return Chapter(
        "comparison", "Comparison with the paper",
        f"{len(comparison.row)} published facts, of which {len(judged(comparison))} are testable with this chain.",
        f"Outside tolerance: {'; '.join(outside)}." if outside else "Every testable fact is met within tolerance.",
        figures)


def tables(comparison):
    """Tables paper / ours / tolerance / verdict / tuned / doubt: testable facts, then all others, folded.

    Below each quantity stand its fact key and the product field that our value comes from.
    """
    rows, summary = judged(comparison), _summary(comparison)
    others = [row for row in range(len(comparison.row)) if row not in rows]
    parts = ((rows, f"{plural(len(rows), 'testable fact')}", False),
             (others, f"{plural(len(others), 'published fact')} that this chain cannot test", True))
    return summary + tuple(
        Table(HEAD, tuple(_row(comparison, r) for r in selected), title, (1, 2, 3), WIDE, folded,
              tuple(address(comparison, r) for r in selected)) for selected, title, folded in parts if selected)


def address(comparison, row):
    """Fact key and product field of a row: 'real_area_start ← micro_friction.real_area'."""
    key, field = str(comparison.key[row]), str(comparison.field[row])
    return f"{key} ← {field}" if field else key


def _summary(comparison):
    """How many facts of each part of the paper are testable, met, and tuned on."""
    rows = []
    for part in dict.fromkeys(map(str, comparison.section)):
        testable = [row for row in judged(comparison) if comparison.section[row] == part]
        met = [row for row in testable if comparison.verdict[row] == "within"]
        tuned = sum(bool(comparison.tuned[row]) for row in met)
        if testable:
            rows.append((part, *map(str, (len(testable), len(met), tuned, len(met) - tuned))))
    head = ("part", "testable", "met", "of which tuned", "independent evidence")
    return (Table(head, tuple(rows), "Summary", (1, 2, 3, 4)),) if rows else ()


def _row(comparison, row):
    unit = unit_text(comparison.unit[row])

    def write(value, known):
        return f"{number(value)}{unit}" if known else "—"

    return (str(comparison.row[row]), write(comparison.published[row], comparison.published_known[row]),
            write(comparison.ours[row], comparison.ours_known[row]),
            tolerance(comparison, row),
            str(comparison.verdict[row]), str(comparison.tuned[row]), str(comparison.doubt[row]),
            str(comparison.source[row]), str(comparison.note[row]))


def tolerance(comparison, row):
    """Tolerance or bounds of a row as text: '± 13 Hz', 'at least 0.005'; '—' where neither is stated."""
    unit = unit_text(comparison.unit[row])
    if comparison.tolerance[row] > 0:
        return f"± {number(comparison.tolerance[row], 3)}{unit}"
    bounds = str(comparison.bounds[row]).replace("-", MINUS)
    return f"{bounds}{unit}" if bounds else "—"


def unit_text(unit):
    """Unit as it follows a number."""
    return {"1": "", "um": f"{THIN}µm"}.get(str(unit), f"{THIN}{unit}")
