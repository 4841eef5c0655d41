"""Chapter: the paper's numbers beside ours."""

from pipeline.views.agreement import agreement, comparable
from pipeline.views.chapter import Chapter, Figure, Table
from pipeline.views.readable import THIN, number

HEAD = ("quantity", "paper", "ours", "tolerance", "verdict", "tuned", "doubt", "source", "how ours was formed")


def chapter(comparison, look):
    """Chapter of the product Comparison."""
    rows = comparable(comparison)
    outside = [str(comparison.row[r]) for r in rows if comparison.verdict[r] == "outside"]
    figures = (Figure(agreement(comparison), "Deviation from the paper in tolerances: blue inside, red outside, hollow"
                      " where something was tuned to reach it; an arrow lies beyond the frame."),) if len(rows) else ()
    return Chapter(
        "comparison", "Paper against ours",
        f"{int(comparison.published_known.sum())} published numbers, {len(rows)} of them computed by this chain.",
        f"Outside tolerance: {'; '.join(outside)}." if outside else "Every number compared lies within its tolerance.",
        figures)


def table(comparison):
    """The table paper / ours / tolerance / verdict / tuned / doubt."""
    return Table(HEAD, tuple(_row(comparison, r) for r in range(len(comparison.row))), "Paper / ours", (1, 2, 3))


def _row(comparison, row):
    unit = str(comparison.unit[row])
    unit = "" if unit == "1" else f"{THIN}{unit}"

    def write(value, known):
        return f"{number(value)}{unit}" if known else "—"

    return (str(comparison.row[row]), write(comparison.published[row], comparison.published_known[row]),
            write(comparison.ours[row], comparison.ours_known[row]),
            f"± {number(comparison.tolerance[row], 3)}{unit}" if comparison.tolerance[row] > 0 else "—",
            str(comparison.verdict[row]), str(comparison.tuned[row]), str(comparison.doubt[row]),
            str(comparison.source[row]), str(comparison.note[row]))
