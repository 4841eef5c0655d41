"""Tables of the chapter on what is missing: all hypotheses, and the combinations that were tried."""

import numpy as np

from pipeline.views.chapters.chapter import Table
from pipeline.views.figures.number_format import number, percent

#: rows of the table of hypotheses that are shown unfolded
ROWS = 12


def hypothesis_table(product):
    """All hypotheses, the most probable first."""
    order = np.argsort(-product.posterior, kind="stable")
    rows = tuple((words(product.hypothesis[k]), str(product.kind[k]), percent(product.posterior[k], 3),
                  number(product.score[k], 3), number(product.p_value[k], 2), number(product.power[k], 3),
                  number(product.evidence_gain[k], 3) if product.refitted[k] else "—",
                  _error(product.held_out_error[k]), words(product.objection[k])) for k in order)
    head = ("hypothesis", "kind", "probability", "score", "family-wise p", "detectability", "ln evidence",
            "held-out error in noise floors", "objection")
    return Table(head, rows, "All hypotheses considered", (2, 3, 4, 5, 6, 7), (8,), folded=len(rows) > ROWS)


def combination_table(product):
    """Combinations of effects and what became of them, or None where none was tried."""
    rows = tuple((words(product.combination[k]), number(product.combination_gain[k], 3),
                  number(product.combination_objective[k], 3) if product.combination_refitted[k] else "—",
                  _error(product.combination_held_out[k]), words(product.combination_outcome[k]))
                 for k in range(len(product.combination)))
    head = ("effects together", "ln evidence", "objective", "held-out error in noise floors", "outcome")
    return Table(head, rows, "Combinations of effects that were tried", (1, 2, 3), (4,), folded=True) if rows else None


def _error(floors):
    """An error in noise floors; a dash where it is not known."""
    return number(floors, 3) if floors else "—"


def words(text):
    """A name of the product in words."""
    return str(text).replace("_", " ")
