"""Why a case is not right: in one phrase, then in the words of the diagnosis."""

import pytest

from pipeline.blind_trial.metrics.criteria import judged
from pipeline.blind_trial.metrics.failure_reasons import why

COULOMB, CUBIC = {"name": "coulomb", "place": "a"}, {"name": "cubic_stiffness", "place": "b"}


def told(kind, hidden, verdict, named, *reasons):
    truth, answer = {"class": kind, "effects": hidden}, {"verdict": verdict, "effects": named, "reasons": reasons}
    return why(truth, answer, judged(truth, answer))


@pytest.mark.parametrize("kind, hidden, verdict, named, phrase", [
    ("control", [], "missing", [COULOMB], "something was named where nothing is missing"),
    ("control", [], "unknown", [], "no model was found to fit"),
    ("effect", [COULOMB], "unknown", [], "it was seen and not named"),
    ("effect", [COULOMB], "parameters", [], "it was not seen"), ("effect", [COULOMB], "refused", [], "no answer"),
    ("effect", [COULOMB], "missing", [CUBIC], "another effect was named"),
    ("effect", [COULOMB], "missing", [{**COULOMB, "place": "b"}], "the right effect at another place"),
    ("effect", [COULOMB], "tie", [COULOMB, CUBIC], "named among others"),
    ("sensor", [COULOMB], "missing", [COULOMB], "named under the verdict missing"),
    ("pair", [COULOMB, CUBIC], "missing", [CUBIC], "one of two was named")])
def test_one_phrase_says_what_happened(kind, hidden, verdict, named, phrase):
    assert told(kind, hidden, verdict, named)["why"] == [phrase]


def test_what_was_said_of_the_hidden_effect_comes_before_the_rest():
    found = told("effect", [COULOMB], "unknown", [], "something else", "coulomb at a: too small a gain")
    assert found["why"][1:] == ["coulomb at a: too small a gain"]
    assert told("effect", [COULOMB], "unknown", [], "one", "two", "three", "four")["why"][1:] == ["one", "two", "three"]
    assert told("effect", [COULOMB], "missing", [COULOMB]) == {}
