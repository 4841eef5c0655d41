"""Chapter on what made a brake squeal: factors with their errors, what it takes, and what cannot be known."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.views.chapters.bench import line_evidence
from pipeline.views.chapters.chapter import Look
from pipeline.views.figures.number_format import number
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
    assert f"Neither explains it: that both lines come from something else is {number(np.exp(5.5), 2)}" in \
        line_evidence.statement(better)


def test_what_it_takes_names_values_that_differ_only():
    said = line_evidence.needed(WEIGHED)
    assert "joint loss of 0.3 (all draws: 0.6)" in said and "falling friction" not in said
    assert "50" in said and "flexible less damping" in said


def test_the_chapter_says_what_two_numbers_cannot_carry():
    chapter = line_evidence.chapter(WEIGHED, Look())
    notes = " ".join(chapter.notes)
    assert "2 heard lines and one silence are all the data" in notes and "substitutes" in notes
    assert len(chapter.figures) == 3 and [len(t.rows) for t in chapter.tables] == [4, 2, 4]
    best = chapter.tables[0].rows[0]
    assert best[0] == "flexible less damping" and best[2].startswith("5 ±")


def test_the_share_of_misleading_lists_is_told():
    clear = np.where((WEIGHED.disc == "rigid")[:, None], -5.0, 5.0) * np.ones((1, 20))
    clear[0, :5] = 5.0
    assert any("rigid disc 25" in note for note in line_evidence.limits(replace(WEIGHED, simulated=clear)))


@pytest.mark.parametrize("there", [True, False])
def test_the_first_screen_answers_where_it_was_weighed(there):
    products = {"diagnosis": diagnosis_for_views.diagnosis()} | ({"line_evidence": WEIGHED} if there else {})
    told = verdict(products, ())
    assert ("What made it squeal" in dict(told.answers)) is there
    assert ("speak for a disc that is flexible" in told.headline) is there


def test_less_than_tenfold_decides_nothing():
    for factor, word in ((2.0, "do not decide"), (-2.0, "do not decide"), (-5.0, "speak against")):
        assert word in line_evidence.headline(replace(WEIGHED, flexible=np.array(factor)))[0]
