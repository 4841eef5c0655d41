"""The chapter of a design search: what the best design does, where it lies, and what was not searched."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.products import DesignSearch
from pipeline.views.chapters.chapter import Look
from pipeline.views.chapters.models.design_search import chapter, shares, statement
from pipeline.views.figures.models import design_search as pictures
from pipeline.views.pages.report import CHAPTERS

LOOK = Look(dpi=50)


def plain(text):
    return text.replace("\N{NARROW NO-BREAK SPACE}", " ").replace("\N{MINUS SIGN}", "-")


def searched(best=2):
    growth, cost = np.array([78.0, 80.0, 34.8, 50.0]), np.array([0.0, 0.0, 1.0, 0.5])
    written = [["0.03", "400 MN/m", "ground"], ["0.03", "408 MN/m", "ground"], ["0.11", "800 MN/m", "ground"],
               ["0.05", "300 MN/m", "body"]]
    return DesignSearch(
        parameter=["structure.pad.lining_loss_factor", "structure.joints.finger_stiffness", "structure.bracket.kind"],
        unit=["", "N/m", ""], lower=[0.01, 1e8, 0.0], upper=[0.15, 8e8, 0.0], choices=["", "", "ground | body"],
        slope=["analytic", "analytic", "list"], case_value=written[0], case_inside=1,
        brake=["case", "design_search.1", "design_search.2", "design_search.3"],
        value=[[0.03, 4e8, 0], [0.03, 4.08e8, 0], [0.11, 8e8, 0], [0.05, 3e8, 1]], written=written,
        start=[0, 0, 0, 1], round=[-1, 0, 1, 0], role=["case", "difference", "line search", "start"],
        unstable=[4, 3, 1, 2], growth=growth, cost=cost, objective=growth + cost, kind="largest", budget=10, computed=3,
        start_first=[0, 3], start_best=[best, -1], start_ended=["the budget was used up", "no step"], best=best,
        cost_name=["price"], cost_unit=["EUR"], best_cost=[1.14], pressure=[1e6, 3e6], speed=[8.5, 8.5],
        growth_before=[78.0, 0.6], growth_after=[34.8, 0.0], unstable_before=[4, 1], unstable_after=[1, 0],
        not_searched=["168 settings stayed.", "Local minima."])


def test_the_sentence_says_what_the_best_design_does_and_is():
    assert plain(statement(searched())) == (
        "The best of 3 brakes lowers the largest growth rate from 78 to 34.8 1/s (1 unstable mode is left) with lining"
        " loss factor 0.11 instead of 0.03, finger stiffness 800 N/µm instead of 400 N/µm, at price 1.14 EUR. That no"
        " better design exists is not shown: see what was not searched.")


@pytest.mark.parametrize("best", [0, -1])
def test_that_nothing_is_better_is_said(best):
    product = searched(max(best, 0))
    assert plain(statement(product)) == ("None of the 3 brakes that were tried is better than the case (largest growth"
                                         " rate 78 1/s).")
    assert len(chapter(product, LOOK).tables) == 4


def test_tables_hold_values_operating_points_starts_and_what_is_open():
    made = chapter(searched(), LOOK)
    values, points, starts, left = ([list(map(plain, row)) for row in table.rows] for table in made.tables)
    assert values[0][:5] == ["lining loss factor", "0.01 to 0.15", "0.03", "0.11", "analytic"]
    assert values[2][1] == "ground | body" and values[2][3] == "ground"
    assert points[1] == ["3 MPa", "8.5 rad/s", "0.6", "0", "1", "0"]
    assert starts[0][1:3] == ["78", "35.8"] and starts[1][2] == "not computed"
    assert left == [["168 settings stayed."], ["Local minima."]]
    assert all(len(row) == len(table.head) for table in made.tables for row in table.rows)
    assert "with weighted costs" in made.see and len(made.figures) == 2


def test_pictures_change_with_what_they_show():
    product = searched()
    assert pictures.course(product) == pictures.course(product)
    other = replace(product, objective=product.objective * 0.5)
    assert pictures.course(product) != pictures.course(other)
    both = shares(product)[:, :2]
    np.testing.assert_allclose(both[[0, 2]], [[0.02 / 0.14, 3 / 7], [0.1 / 0.14, 1.0]])
    assert pictures.spread(product, ["a", "b"], both) != pictures.spread(product, ["a", "b"], 0.5 * both)


def test_lists_alone_have_no_picture_of_ranges():
    product = searched()
    lists = replace(product, choices=["a | b", "c | d", "e | f"])
    assert len(chapter(lists, LOOK).figures) == 1


def test_a_case_without_a_space_has_no_chapter():
    none = replace(searched(), parameter=[], unit=[], lower=[], upper=[], choices=[], slope=[], case_value=[],
                   value=np.zeros((4, 0)), written=np.zeros((4, 0), str))
    assert chapter(none, LOOK) is None and statement(none) == "" and CHAPTERS["design_search"][0] is chapter
