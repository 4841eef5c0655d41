"""Planted facts judge what is read: right, told, left out aloud, or wrong without a word."""

import numpy as np
import pytest

from tests.fuzz.semantics.labels import ASKED_BACK, LABELS
from tests.fuzz.semantics.planted import Meant, Planted
from tests.fuzz.targets import meanings
from tests.fuzz.targets.plain import channel
from tests.fuzz.trial import Told

TRUE = np.array([1.0, np.nan, -3.0])


def judged(found, remarks=(), **planted):
    """What is made of a channel ``x`` that is ``found``, None of none, where TRUE was planted in Pa at 100 Hz."""
    meant = Meant({"a": {"x": Planted(TRUE, "Pa", 100.0, 0.5, **planted)}})
    return meant({"runs": {"a": {"channels": {} if found is None else {"x": found}}}, "remarks": list(remarks)})


def test_what_is_as_planted_is_right():
    assert judged(channel(TRUE, "Pa", 100.0, 0.5)) == ""


@pytest.mark.parametrize("found, said", [
    (channel(-TRUE, "Pa", 100.0, 0.5), "samples"), (channel(TRUE, "N", 100.0, 0.5), "in N for Pa"),
    (channel(TRUE, "Pa", 0.1, 0.5), "0.1 Hz for 100"), (channel(TRUE, "Pa", 100.0), "from 0 s for 0.5"),
    (channel(np.nan_to_num(TRUE), "Pa", 100.0, 0.5), "samples"), (None, "no x, and no word of it")])
def test_sign_unit_rate_begin_gaps_and_what_is_missing_count(found, said):
    wrong = judged(found, remarks=["a.csv: y: a remark of something else"])
    assert said in wrong and not isinstance(wrong, Told)


def test_a_remark_counts_for_what_it_tells_alone():
    slow, assumed = channel(TRUE, "Pa", 0.1, 0.5), (("rate", "states no unit"),)
    assert isinstance(judged(slow, ["t states no unit: read in s"], assumed=assumed), Told)
    assert not isinstance(judged(slow, ["t is rounded"], assumed=assumed), Told)
    turned = channel(-TRUE, "Pa", 0.1, 0.5)
    assert not isinstance(judged(turned, ["t states no unit: read in s"], assumed=assumed), Told)
    assert isinstance(judged(None, ["a.tdms: x left out: no unit"]), Told)
    assert "although its unit is none" in judged(channel(TRUE, "Pa", 100.0, 0.5), asked=True)


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")      # pyuff leaves its file open
def test_an_input_is_the_same_whenever_it_is_made():
    for target in meanings.TARGETS:
        one, two = (target.trial(3, 2) for _ in range(2))
        assert (one.name, one.how, one.must, repr(one.given)) == (two.name, two.how, two.must, repr(two.given))


def test_a_label_has_one_meaning():
    texts = [(one.text, one.measured) for one in LABELS]
    assert len(set(texts)) == len(texts) > 200 and not {one.text for one in LABELS} & set(ASKED_BACK)
