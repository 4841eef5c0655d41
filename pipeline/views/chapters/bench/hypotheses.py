"""Effects and hypotheses in words, and tables of these and of the combinations that were tried."""

import numpy as np

from pipeline.views.chapters.chapter import Table
from pipeline.views.figures.number_format import number, percent

#: rows of the table of hypotheses that are shown unfolded
ROWS = 12
#: headlines where a sentence of the product stands in place of what leads
_INSTEAD = {"failure": "The diagnosis failed: nothing could be judged",
            "other_machine": "The recordings do not fit this model: are they of another machine?",
            "runs_differ": "The model fits each run alone, at values that differ from run to run"}


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


def unnamed(product, where):
    """Headline where nothing is named: what leads, or that the catalogue, or the machine, is another one; ``where``:
    ' at the place', as far as it is known."""
    if instead := _instead(product):
        return _INSTEAD[instead]
    if len(product.leading_set):
        return f"Leading explanation, not confirmed: {leading_set(product)}"
    if not len(product.leading):
        doubted = _doubted(product)
        return f"Unmodelled physics{where}, outside the catalogue" if doubted is None else \
            f"Unmodelled physics{where}; the fit of {effect_at(product, doubted)} cannot be relied on"
    leading, takes = product.leading, percent(product.leading_takes[0], 2)
    what = of_one_family(product, leading) or effect_at(product, leading[0])
    return f"Leading explanation, not confirmed: {what}; takes {takes} {judged_by(product)}"


def led_by(product):
    """What leads where nothing is named, with its values, and what stays."""
    if instead := _instead(product):
        return sentence(getattr(product, instead).item())
    if len(product.leading_set):
        return f"No law alone explains as much. Together {leading_set(product, True)}"
    if not len(product.leading):
        doubted = _doubted(product)
        return "No effect of the catalogue helps beyond chance: the physics lies outside it." if doubted is None else (
            f"The most probable explanation, {effect_at(product, doubted)}, cannot be relied on:"
            f" {product.objection[doubted]}.")
    k, *family = product.leading
    values = f", with {product.leading_values[0]}" if product.leading_values[0] else ""
    return (f"The leading explanation is {effect_at(product, k)} ({percent(min(product.posterior[k], 0.999), 3)} of the"
            f" probability){values}: it takes {percent(product.leading_takes[0], 2)} {judged_by(product)}, and"
            f" {percent(product.leading_stays[0], 2)} stays beyond the doubt about noise."
            + (f" Of its family, {listed([effect_at(product, each) for each in family])} would take nearly as much:"
               " the form of the law is open." if family else ""))


def _instead(product):
    return next((name for name in _INSTEAD if getattr(product, name).item()), None)


def _doubted(product):
    """Row of the most probable hypothesis if its fit is doubted, else None."""
    first = int(np.argmax(product.posterior))
    return first if first and str(product.objection[first]) else None


def of_no_law(product):
    """The reasons that are about no single law."""
    return [str(reason) for reason in product.reason if _about(product, reason) is None]


def all_refused(product):
    """How many laws were refused, in a sentence; '' of none."""
    laws = dict.fromkeys(filter(None, (_about(product, reason) for reason in product.reason)))
    return f"{len(laws)} laws were refused: the table of refusals tells why." if len(laws) > 1 else " ".join(
        sentence(reason) for reason in product.reason if _about(product, reason))


def refusal_table(product):
    """Why each law that matters was refused, or None where none was."""
    why = {}
    for reason in product.reason:
        if law := _about(product, reason):
            why.setdefault(law, []).append(str(reason)[len(law) + 2:])
    rows = tuple((words(law), words("; ".join(each))) for law, each in why.items())
    return Table(("law", "why it is not named"), rows, "Refusals", (), (1,), folded=True) if rows else None


def _about(product, reason):
    """The hypothesis that a reason is about, or None."""
    name, mark, _ = str(reason).partition(": ")
    return name if mark and name in {str(h) for h in product.hypothesis} else None


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


def listed(items):
    """'a, b and c'."""
    return items[0] if len(items) == 1 else f"{', '.join(items[:-1])} and {items[-1]}"


def first_up(text):
    """A text with a capital letter."""
    return text[:1].upper() + text[1:]


def sentence(text):
    """A text with a capital letter and a full stop."""
    text = first_up(str(text).strip())
    return text if text.endswith(".") else f"{text}."


def words(text):
    """A name of the product in words."""
    return str(text).replace("_", " ")
