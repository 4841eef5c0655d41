"""The page of a trial: every rate beside its interval, every failure with its reason, what is not proven."""

import json
import re
from pathlib import Path

import pytest

from pipeline.blind_trial.metrics.wording import rate_in_words
from pipeline.views.chapters.bench import trial as chapters
from pipeline.views.pages.trial import page
from tests.views.trial_for_views import ABOUT, drawn

PUBLISHED = sorted(Path(__file__).parents[2].glob("data/trial/*/result.json"))


@pytest.fixture(scope="module")
def result():
    return drawn()


@pytest.fixture(scope="module")
def html(result):
    return page(result)


def text_of(html):
    return re.sub(r"\s+", " ", re.sub(r"<[^>]+>", " ", html))


def test_the_first_screen_says_what_was_reached_missed_and_not_proven(result, html):
    first = text_of(html.partition("<nav")[0])
    one, alarms = (result["methods"]["diagnosis"]["rates"][n] for n in ("type and place, one effect", "false alarms"))
    assert f"{one['hits']} of {one['count']} hidden effects correctly named and located" in first
    assert f"false alarm in {alarms['count']} controls" in first and ABOUT["commitment"] in first
    assert "No recording of a real squealing brake was available" in first
    missed = [n for n, r in result["methods"]["diagnosis"]["rates"].items() if r["goal"] and not chapters.reached(r)]
    assert missed and all(rate_in_words(name) in first for name in missed)


def test_every_case_that_is_wrong_has_its_page_with_the_reason_and_no_other_has(result, html):
    wrong = {n for n, one in result["cases"].items() if "why" in one["answers"]["diagnosis"]}
    assert set(re.findall(r"<summary>Case (\d+):", html)) == wrong and wrong
    for number in wrong:
        assert result["cases"][number]["answers"]["diagnosis"]["why"][0] in text_of(html)


def test_the_table_sets_every_method_beside_the_goal(result, html):
    table = chapters.all_of(result)[0].tables[0]
    assert table.head == ("rate", "diagnosis", "largest residual", "best held out", "goal", "goal met")
    assert {row[0]: row[-1] for row in table.rows}["refused"] == "" and "outside" in {row[-1] for row in table.rows}
    assert "The best baseline for single effects is best held out" in text_of(html)


def test_the_same_result_gives_the_same_page(result, html):
    assert page(result) == html


def test_a_set_with_little_in_it_and_nothing_sealed_still_has_a_page():
    few = drawn(about={"name": "few", "kind": "open"})
    few["methods"] = {"diagnosis": {**few["methods"]["diagnosis"], "rates": {
        "refused": few["methods"]["diagnosis"]["rates"]["refused"]}, "detection": [], "visible": [], "names": {},
        "calibration": {"count": 0}, "parameters": {"nominal": {"count": 0}, "effects": {"count": 0}}}}
    few["cases"] = {n: {**one, "answers": {"diagnosis": {"verdict": "parameters", "effects": [], "judged": {}}}}
                    for n, one in few["cases"].items()}
    told = text_of(page(few))
    assert "No case of this set contains a single effect" in told and "It proves nothing by itself" in told
    assert "No baseline was run" in told and "Every case of this set was diagnosed correctly" in told


@pytest.mark.parametrize("goal, share, so", [(["at least", 0.5], 5, True), (["at least", 0.6], 5, False),
                                             (["at most", 0.5], 5, True), (["at most", 0.4], 5, False),
                                             (["interval around", 0.3], 5, True),
                                             (["interval around", 0.2], 5, False)])
def test_goals_are_reached_from_their_side(goal, share, so):
    assert chapters.reached({"goal": goal, "hits": share, "count": 10, "low": 0.24, "high": 0.76}) is so


def test_every_rate_of_a_published_result_is_shown_in_words():
    """But for the two whose names in the record are plain words already."""
    names = {name for path in PUBLISHED for name in json.loads(path.read_text())["methods"]["diagnosis"]["rates"]}
    assert {name for name in names if rate_in_words(name) == name} == {"false alarms", "refused"}
