"""Why an answer is not right, in the words of its own reasons."""

_MOST, _LONGEST = 3, 300


def why(truth, answer, judgement):
    """{why: sentences} of a case that is not right, {} of one that is.

    What the diagnosis says of the hidden effect itself comes first, then what it says at all.
    """
    if judgement["right"]:
        return {}
    reasons = [str(reason)[:_LONGEST] for reason in answer.get("reasons", ())]
    hidden = [f"{e['name']} at {e['place']}" for e in truth["effects"]]
    on_hidden = [reason for reason in reasons if any(reason.startswith(name) for name in hidden)]
    return {"why": [_plainly(truth, answer), *(on_hidden or reasons)[:_MOST]]}


def _plainly(truth, answer):
    """What happened in one phrase."""
    verdict, named = answer["verdict"], answer["effects"]
    if verdict == "refused":
        return "no answer"
    if truth["class"] in ("control", "wrong_value"):
        return "something was named where nothing is missing" if named else "no model was found to fit"
    if not named:
        return "it was seen and not named" if verdict == "unknown" else "it was not seen"
    hidden, places = {e["name"] for e in truth["effects"]}, {(e["name"], e["place"]) for e in truth["effects"]}
    if {(e["name"], e["place"]) for e in named} & places:
        return "named among others" if len(named) > len(places) else "one of two was named" if len(places) > 1 else (
            f"named under the verdict {verdict}")
    if {e["name"] for e in named} & hidden:
        return "the right effect at another place"
    return "another effect was named"
