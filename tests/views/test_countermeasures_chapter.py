"""Chapter of countermeasures: which one helps, by how much, at what cost, and what it makes worse."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.views.chapters.chapter import Look
from pipeline.views.chapters.models.countermeasure_modes import distinct
from pipeline.views.chapters.models.countermeasures import best_variant, chapter, statement
from pipeline.views.figures.models import countermeasures as pictures
from pipeline.views.pages.summary import verdict
from tests.views import products_for_views as small
from tests.views.countermeasures_for_views import countermeasures

LOOK = Look(dpi=50)


def plain(text):
    return text.replace("\N{NARROW NO-BREAK SPACE}", " ").replace("\N{MINUS SIGN}", "-")


def test_the_sentence_says_what_helps_most_by_how_much_and_at_what_cost():
    assert plain(statement(countermeasures())) == (
        "Shim lowers the probability of squeal most: 85 % of the draws squeal without it at any operating point, 55 %"
        " with it, 30 percentage points fewer (95 %: 22 to 38), at mass 0.1 kg, price 2. Shim makes no"
        " other mode worse beyond the error that refinement shows.")


def test_a_mode_that_is_made_worse_is_named():
    told = plain(statement(countermeasures(variants=("shim", "shorter_lining"))))
    assert "worse" in told
    alone = countermeasures(variants=("shorter_lining",))
    helps = replace(alone, variant_band_probability=[[0.0, 0.8, 0.3]],
                    band_change_interval=[[[-0.1, 0.1], [-0.1, 0.1], [0.1, 0.3]]], overall_change=[-0.2],
                    overall_change_interval=[[-0.3, -0.1]])
    assert ("Shorter lining makes other modes worse: a new unstable mode, 4.934 kHz, from a growth rate not known to"
            " 75 1/s at 3 MPa and 12 rad/s. Unstable modes become more likely in the 1/3 octaves of 10 kHz (10 % to"
            " 30 % of the draws). Ambiguous matches, which say nothing: 1.") in plain(statement(helps))


def test_nothing_that_helps_is_said_plainly():
    product = countermeasures()
    none = replace(product, overall_change_interval=np.array([[-0.4, 0.1], [-0.1, 0.1]]))
    assert best_variant(none) is None
    assert plain(statement(none)).startswith("No variant lowers the probability of squeal, 85 % of the draws")
    quiet = replace(none, overall=0.0)
    assert statement(quiet).startswith("No draw of the case squeals")


def test_without_draws_the_largest_growth_rate_decides():
    product = countermeasures(draws=0)
    assert plain(statement(product)).startswith(
        "Shim lowers the largest growth rate most, from 120 to 20 1/s (no probabilities were computed)")
    unsure = replace(product, error=np.full(len(product.error), 500.0))
    assert statement(unsure).startswith("No variant lowers the largest growth rate beyond the error")


def test_each_frequency_stands_once_where_it_is_worst():
    product = countermeasures()
    rows = distinct(product, 1)
    assert [round(product.mac[row], 2) for row in rows] == [0.97, 0.2, 0.97, 0.5]
    assert list(product.state[rows]) == ["weaker", "new", "unchanged", "ambiguous"]


@pytest.mark.parametrize("draws", [100, 0])
def test_tables_show_modes_probabilities_and_costs(draws):
    made = chapter(countermeasures(draws=draws), LOOK)
    summary, modes, *bands = made.tables
    if draws:
        shown = {plain(row[0]): list(map(plain, row[1:])) for row in bands[0].rows}
        assert shown == {"8 kHz": ["80 %", "50 % (less)", "80 %"], "10 kHz": ["10 %", "10 %", "30 % (more)"]}
    assert len(summary.rows) == 2 and "mass / kg" in summary.head
    assert dict(zip(summary.head, summary.rows[1], strict=True))["price"] == ""
    assert ("beyond interval" in summary.head) == bool(draws) and len(made.figures) == (2 if draws else 1)
    shown = [dict(zip(modes.head, row, strict=True)) for row in modes.rows]
    assert plain(shown[-1]["MAC"]) == "0.5 (also 0.45)" and shown[-1]["state"] == "ambiguous"
    assert shown[0]["at all operating points"] == "2 gone" and all(len(row) == len(modes.head) for row in modes.rows)
    assert all(len(row) == len(summary.head) for row in summary.rows)


def test_pictures_change_with_what_they_show():
    product = countermeasures()
    rows = distinct(product, 0)
    drawn = [pictures.dumbbells(product, rows, [(120.0, after)] * len(rows)) for after in (-20.0, -20.0, 30.0, None)]
    assert drawn[0] == drawn[1] and len(set(drawn)) == 3 and drawn[0].image.startswith("<?xml")
    assert pictures.probabilities(product) != pictures.probabilities(replace(product, overall=0.5))


def test_a_case_without_variants_has_no_chapter():
    assert chapter(countermeasures(variants=()), LOOK) is None


def test_the_first_screen_says_what_helps():
    given = {"complex_modes": small.complex_modes(), "convergence": small.convergence()}
    answers = dict(verdict({**given, "countermeasures": countermeasures()}, ()).answers)
    assert answers["What helps"] == statement(countermeasures())
    assert "What helps" not in dict(verdict({**given, "countermeasures": countermeasures(variants=())}, ()).answers)
