"""What of an answer is right, case by case. Truth as ``generators.systems`` writes it, answer as diagnosis.json."""

import numpy as np

#: verdicts by what they say: nothing is missing, or this is
NOTHING, NAMING = ("consistent", "parameters"), ("missing", "tie", "sensor", "numerics")
#: classes in which nothing is missing; class -> verdict that names what it hides
EMPTY = ("control", "wrong_value")
NAMED_BY = {"effect": "missing", "pair": "missing", "below": "missing", "foreign": "missing", "sensor": "sensor"}
#: every class that a truth may state
CLASSES = (*EMPTY, *NAMED_BY, "solver")
#: standard deviations of the noise that something must leave beside the nominal values to count as visible: one that is
#: alone in an ideal linear case is named in 95 % of draws then, at 4 in hardly any
VISIBLE = 7.0
#: the same where a truth states no ``visible``
_UNSTATED = 4.0
#: hypotheses among which the truth counts as near
_TOP = 3


def judged(truth, answer):
    """{what: bool} of one case; which of them depends on its class (``class_of``):

    right       the verdict of the class; with exactly what is hidden, at its place, where something is
    false_alarm something named where nothing is missing
    named       exactly what is hidden, at its place, under its verdict; a tie with laws of the same force counts
    type        exactly what is hidden, at whatever place; called: the verdict of the class, whatever it names
    among_tied, top      the truth among several told, or among the first three hypotheses
    """
    verdict, kind = answer["verdict"], class_of(truth)
    if kind in EMPTY:
        return {"right": verdict in NOTHING, "false_alarm": verdict in NAMING}
    if kind == "foreign":
        return {"right": verdict == "unknown"}
    if kind == "solver":
        return {"right": verdict == "numerics", "called": verdict == "numerics"}
    named, wanted = answer["effects"], truth["effects"]
    called = verdict == NAMED_BY[truth["class"]]
    alone = called and len(named) == len(wanted)
    tied = verdict == "tie" or (called and verdict == "sensor")
    exactly = (alone and _all_in(wanted, named)) or (tied and _same_forces(wanted, named))
    judgement = {"right": exactly, "named": exactly, "called": called,
             "type": alone and sorted(e["name"] for e in named) == sorted(e["name"] for e in wanted),
             "among_tied": verdict in ("tie", "sensor") and len(named) > len(wanted) and _all_in(wanted, named),
             "top": _all_in(wanted, [*named, *answer.get("alternatives", ())][:max(_TOP, len(wanted))])}
    if kind == "below":     # to abstain is right, or to name what is there or comes nearest; to name another is not
        near = (called or verdict == "tie") and all(any(_like(w, [effect]) for w in wanted) for effect in named)
        judgement["right"] = judgement["right"] or verdict in (*NOTHING, "unknown") or judgement["among_tied"] or near
    return judgement


def _same_forces(wanted, named):
    """Whether a tie holds the one effect that is hidden, and beside it only laws of the same force, or channels whose
    fault shows the same."""
    return (len(wanted) == 1 and _all_in(wanted, named)
            and all(_like(wanted[0], [effect]) for effect in named))


def _like(true, answered):
    return any(same(effect, other) for effect in (true, *true.get("alike", ())) for other in answered)


def class_of(truth):
    """The class as which a case is scored: what leaves less than ``threshold`` is below it."""
    shown = truth.get("left", np.inf) >= threshold(truth)
    return truth["class"] if shown or truth["class"] not in NAMED_BY else "below"


def threshold(truth):
    """Standard deviations of the noise that what is hidden must leave to count as visible."""
    return truth.get("visible", _UNSTATED)


def _all_in(wanted, named):
    return all(any(same(effect, other) for other in named) for effect in wanted)


def same(true, answered):
    """Whether an effect that was told is the true one; a truth without a place asks for none."""
    return true["name"] == answered["name"] and true["place"] in ("", answered["place"])
