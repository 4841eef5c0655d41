"""Chapter: the paper's numbers beside ours."""

from pipeline.views.chapters.chapter import Chapter, Figure, Table
from pipeline.views.figures.agreement import agreement, comparable, judged
from pipeline.views.figures.number_format import THIN, number, plural

HEAD = ("quantity", "paper", "ours", "tolerance", "verdict", "tuned", "doubt", "source", "how ours was formed")
WIDE = (0, 6, 8)


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


def tables(comparison):
    """The tables paper / ours / tolerance / verdict / tuned / doubt: what is judged, then folded all the rest."""
    rows, summary = judged(comparison), _summary(comparison)
    others = [row for row in range(len(comparison.row)) if row not in rows]
    parts = ((rows, f"{plural(len(rows), 'fact')} judged", False),
             (others, f"{plural(len(others), 'published fact')} that cannot be judged", True))
    return summary + tuple(Table(HEAD, tuple(_row(comparison, r) for r in chosen), title, (1, 2, 3), WIDE, folded)
                 for chosen, title, folded in parts if chosen)


def _summary(comparison):
    """How many facts of each part of the paper are judged, hold, and were tuned on."""
    rows = []
    for part in dict.fromkeys(map(str, comparison.section)):
        here = [row for row in judged(comparison) if comparison.section[row] == part]
        held = [row for row in here if comparison.verdict[row] == "within"]
        tuned = sum(bool(comparison.tuned[row]) for row in held)
        if here:
            rows.append((part, *map(str, (len(here), len(held), tuned, len(held) - tuned))))
    head = ("part", "judged", "hold", "tuned", "evidence")
    return (Table(head, tuple(rows), "In short", (1, 2, 3, 4)),) if rows else ()


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
