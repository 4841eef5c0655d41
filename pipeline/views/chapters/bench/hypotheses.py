"""Effects and hypotheses in words, and tables of these and of the combinations that were tried."""

import numpy as np

from pipeline.views.chapters.chapter import Table
from pipeline.views.figures.number_format import number, percent

#: rows of the table of hypotheses that are shown unfolded
ROWS = 12


def effect_at(product, k):
    """Hypothesis ``k`` of the product in words: 'coulomb at guide'."""
    if not product.effect[k]:
        return "nothing"
    contacts = f" ({product.contacts[k]})" if product.contacts[k] else ""
    return f"{words(product.effect[k])} at {product.place[k]}{contacts}"


def of_one_family(product, rows):
    """'dry friction at guide, of a form that is open: coulomb or dahl' of the hypotheses ``rows`` that are named or
    lead; '' where they are of no family."""
    if not (product.family.item() and len(rows)):
        return ""
    forms = " or ".join(words(product.effect[k]) for k in rows)
    return f"{product.family.item()} at {product.place[rows[0]]}, of a form that is open: {forms}"


def named_effects(product):
    """Effects already known, and the one named in addition, or the alternatives for it."""
    parts = [effect_at(product, k) for k in product.known]
    named = of_one_family(product, product.named) or " or ".join(effect_at(product, k) for k in product.named)
    return (", and " if len(product.named) > 1 else " and ").join(filter(None, (*parts, named)))


def judged_by(product):
    """Of what the shares are that a law takes, in words."""
    return "of the excess error" + " on held-out runs" * any(r.held_out for r in product.runs.values())


def leading_set(product, whole=False):
    """The laws that lead together, and what they leave; ``whole``: as sentences with their values and why they are not
    named."""
    k = product.leading_set[0]
    laws, stays = words(product.combination[k]).replace(" + ", " and "), percent(product.combination_left[k], 2)
    if not whole:
        return f"{laws} together; {stays} of the excess error stays"
    return (f"{laws} leave {stays} of the excess error of the fitted runs: {words(product.combination_values[k])}. They"
            f" are not named: {words(product.combination_outcome[k])}.")


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
                  percent(product.combination_left[k], 2) if product.combination_refitted[k] else "—",
                  _error(product.combination_held_out[k]), words(product.combination_outcome[k]),
                  words(product.combination_values[k])) for k in range(len(product.combination)))
    head = ("effects together", "ln evidence", "objective", "leaves", "held-out error in noise floors", "outcome",
            "values")
    return Table(head, rows, "Combinations of effects that were tried", (1, 2, 3, 4), (5, 6),
                 folded=True) if rows else None


def _error(floors):
    """An error in noise floors; a dash where it is not known."""
    return number(floors, 3) if floors else "—"


def words(text):
    """A name of the product in words."""
    return str(text).replace("_", " ")
