"""Chapter: the paper's numbers beside ours."""

from pipeline.views.agreement import agreement, comparable, judged
from pipeline.views.chapter import Chapter, Figure, Table
from pipeline.views.readable import THIN, number

HEAD = ("quantity", "paper", "ours", "tolerance", "verdict", "tuned", "doubt", "source", "how ours was formed")


def chapter(comparison, look):
    """Chapter of the product Comparison."""
    outside = [str(comparison.row[row]) for row in judged(comparison, "outside")]
    caption = ("Deviation from the paper in tolerances: blue inside, red outside, hollow where something was tuned to"
               " reach it; an arrow lies beyond the frame.")
    figures = (Figure(agreement(comparison), caption),) if len(comparable(comparison)) else ()
    return Chapter(
        "comparison", "Paper against ours",
        f"{len(comparison.row)} published facts, {len(judged(comparison))} of them judged against this chain.",
        f"Outside tolerance: {'; '.join(outside)}." if outside else "Every fact judged holds within its tolerance.",
        figures)


def table(comparison):
    """The table paper / ours / tolerance / verdict / tuned / doubt."""
    return Table(HEAD, tuple(_row(comparison, r) for r in range(len(comparison.row))), "Paper / ours", (1, 2, 3))


def _row(comparison, row):
    unit = str(comparison.unit[row])
    unit = {"1": "", "um": f"{THIN}µm"}.get(unit, f"{THIN}{unit}")

    def write(value, known):
        return f"{number(value)}{unit}" if known else "—"

    return (str(comparison.row[row]), write(comparison.published[row], comparison.published_known[row]),
            write(comparison.ours[row], comparison.ours_known[row]),
            f"± {number(comparison.tolerance[row], 3)}{unit}" if comparison.tolerance[row] > 0 else "—",
            str(comparison.verdict[row]), str(comparison.tuned[row]), str(comparison.doubt[row]),
            str(comparison.source[row]), str(comparison.note[row]))
