"""Chapter on what made a brake squeal: factors with their errors, what it takes, and what cannot be known."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.views.chapters.bench import line_evidence, line_fit
from pipeline.views.chapters.chapter import Look
from pipeline.views.figures.bench import line_fit as line_fit_pictures
from pipeline.views.figures.number_format import number, quantity
from pipeline.views.pages.summary import verdict
from tests.views import diagnosis_for_views
from tests.views import products_for_views as small

WEIGHED = small.line_evidence()


def test_the_statement_has_the_factor_with_its_error_and_the_better_alternative():
    said = line_evidence.statement(WEIGHED)
    assert number(np.exp(4.3), 2) in said and "4.3 ± 0.5" in said and "flexible less damping" in said
    assert f"{number(np.exp(4.5), 2)} times as probable as lines that no hypothesis explains" in said


def test_lines_that_nothing_explains_are_said_to_be_so():
    better = replace(WEIGHED, evidence=WEIGHED.evidence + [0, 0, 0, 10.0])
    assert f"Neither explains it: that all lines come from something else is {number(np.exp(5.5), 2)}" in \
        line_evidence.statement(better)


def test_what_it_takes_names_values_that_differ_only():
    said = line_evidence.needed(WEIGHED)
    assert "joint loss of 0.3 (all draws: 0.6)" in said and "falling friction" not in said
    assert "50" in said and "flexible less damping" in said


def test_the_chapter_says_what_two_numbers_cannot_carry():
    chapter = line_evidence.chapter(WEIGHED, Look())
    notes = " ".join(chapter.notes)
    assert "2 heard lines and 1 silent test are all the data" in notes and "assumed" in notes
    assert len(chapter.figures) == 5 and [len(t.rows) for t in chapter.tables] == [4, 2, 2, 3, 2, 4]
    assert "2 tests (cycle, constant load), silence in constant load" in chapter.see
    best = chapter.tables[0].rows[0]
    assert best[0] == "flexible less damping" and best[2].startswith("5 ±")


def test_the_share_of_misleading_lists_is_told():
    clear = np.where((WEIGHED.disc == "rigid")[:, None], -5.0, 5.0) * np.ones((1, 20))
    clear[0, :5] = 5.0
    assert any("rigid disc 25" in note for note in line_evidence.limits(replace(WEIGHED, simulated=clear)))


@pytest.mark.parametrize("there", [True, False])
@pytest.mark.parametrize("diagnosed", [True, False])
def test_the_first_screen_answers_where_it_was_weighed(there, diagnosed):
    products = ({"diagnosis": diagnosis_for_views.diagnosis()} if diagnosed else {}) | (
        {"line_evidence": WEIGHED} if there else {})
    answer = verdict(products, ())
    assert ("What made it squeal" in dict(answer.answers)) is there
    assert ("speak for a disc that is flexible" in answer.headline) is there


def test_the_headline_is_that_of_the_verdict():
    for kind, words in (("undecided", "do not decide"), ("rigid", "against a flexible"), ("none", "No tone")):
        assert words in line_evidence.headline(replace(WEIGHED, verdict=np.array(kind)))[0]


def test_a_completed_case_is_named_or_it_is_said_why_none_is_written():
    assert "two_way.yaml" in line_fit.written(WEIGHED)
    said = line_fit.written(replace(WEIGHED, verdict=np.array("undecided")))
    flexible = np.log((np.exp(-23.0) + np.exp(-19.0)) / 2)
    assert f"{number(np.exp(flexible + 24), 2)} times as probable as a rigid one and" in said
    assert f"{number(np.exp(flexible + 23.5), 2)} times as probable as lines that nothing explains" in said


def test_the_fit_has_the_nearest_tone_before_and_after():
    """One way, the nearest of 2 kHz + k 0.8 kHz; the flexible tones lie about 16.6 kHz."""
    first, second = line_fit.fit(WEIGHED, [str(h) for h in WEIGHED.hypothesis]).rows
    assert first[:2] == (quantity(16.6e3, "Hz"), "cycle") and first[2].startswith("16.4")
    assert first[3].startswith("16.6") and second[2].startswith("18") and second[3].startswith("17.1")


def test_of_the_cycle_it_is_said_what_has_time_to_be_heard():
    said, figures, tables = line_fit.cycle(WEIGHED, [str(h) for h in WEIGHED.hypothesis])
    assert "10.9" in said and "Near the heard lines: 16.6" in said and len(figures) == 1
    rows = tables[0].rows
    assert rows[0][1].startswith("10.9") and rows[0][5] == "yes" and rows[-1][5] == "no"
    assert rows[0][4] == number(20.0 * 20 / np.log(10), 3)
    assert "1.5" in tables[1].rows[0][2] and tables[1].rows[1][2] == "none"
    assert line_fit.cycle(replace(WEIGHED, cycle_time=np.empty(0), cycle_pressure=np.empty(0),
                                  cycle_speed=np.empty(0)), []) == ("", (), ())


def test_a_hypothesis_without_any_tone_is_drawn():
    silent = replace(WEIGHED, tone_hypothesis=np.full(len(WEIGHED.tone), 2))
    assert line_fit_pictures.before_after(silent, list(silent.hypothesis)).image.startswith("<?xml")
