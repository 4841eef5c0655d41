"""Pages of a run under way say what they stand on and what is to come; the last page says nothing of it."""

import json
import re
from dataclasses import replace

import pytest

from pipeline.views.chapters.chapter import Look
from pipeline.views.pages.early import first_page, later_page, unfinished_page
from pipeline.views.pages.report import page
from stages.report import Settings
from tests.views import products_for_views as small

AHEAD = ["convergence", "limit_cycle", "probability", "comparison"]


def text_of(html):
    return re.sub(r"\s+", " ", re.sub(r"<[^>]+>", " ", html.partition("<body>")[2]))


def test_a_first_look_is_marked_and_says_its_load_and_friction():
    modes = small.complex_modes()
    sentence, html = first_page(modes, small.case(), ["surface", "complex_modes"])
    assert sentence.startswith("First look, not converged: squeal can start, most strongly at 16.6")
    assert "coarse meshes" in sentence and "1\u202fMPa and 8.5\u202frad/s" in sentence
    text = text_of(html)
    assert "None of it has been checked" in text and "Being computed: surface, complex modes." in text
    assert "<figure" not in html and 'id="methods"' not in html


@pytest.mark.parametrize(("modes", "expected"), [
    (small.complex_modes(stable=True), "First look, not converged: steady sliding is stable ("),
    (replace(small.complex_modes(), squeal_from=20e3), "First look, not converged: no squeal, but groan or moan at")])
def test_a_first_look_without_squeal(modes, expected):
    assert first_page(modes, small.case(), ["surface"])[0].startswith(expected)


def test_what_is_known_replaces_what_is_to_come():
    products = {"complex_modes": small.complex_modes()}
    sentence, html = later_page(products, small.case(), AHEAD)
    assert "(convergence: being computed). Being computed: convergence, limit cycle" in sentence
    text = text_of(html)
    assert "How likely Being computed." in text and "How certain Being computed." in text
    assert "There is no published result" not in text, "the comparison is to come"
    sentence, html = later_page({**products, "convergence": small.convergence()}, small.case(), AHEAD[1:])
    assert "convergence" not in sentence and "where it was tried: the same modes" in text_of(html)
    assert "This page is not complete. Being computed: limit cycle, probability, comparison." in text_of(html)


def test_the_last_page_is_not_marked():
    products = {"complex_modes": small.complex_modes(), "convergence": small.convergence()}
    text = text_of(page((), products, small.case(), Look()))
    assert "eing computed" not in text and "not complete" not in text


def test_what_failed_stands_above_the_chapters_of_the_rest():
    products = {"complex_modes": small.complex_modes(), "convergence": small.convergence()}
    errors = {"limit_cycle": "limit_cycle: expected a mode, found <none>"}
    html, verdict = unfinished_page(products, small.case(), errors, ["probability"], Settings(mode_pictures=0))
    text = text_of(html)
    assert "This report is not complete. The stage limit cycle could not be finished: limit_cycle: expected a mode," \
        " found &lt;none&gt;. Not computed: probability." in text
    assert 'id="convergence"' in html and 'id="complex_modes"' in html
    assert json.loads(verdict)["warnings"][:2] == [
        "The stage limit cycle could not be finished: limit_cycle: expected a mode, found <none>.",
        "Not computed: probability."]
