"""Chapters of the pin on disc tell the numbers of their products."""

from dataclasses import replace

from pipeline.views.chapters.chapter import Look
from pipeline.views.chapters.models import lock_in as chapters
from pipeline.views.pages.report import plan
from tests.views import products_for_views as small


def test_chapters_stand_in_the_order_of_the_chain():
    products = {"interface_law": small.interface_law(), "pin_on_disc": small.pin_on_disc(), "lock_in": small.lock_in()}
    assert [build().anchor for build in plan(products, Look()).values()] == ["interface_law", "pin_on_disc", "lock_in"]


def test_interface_law_tells_friction_and_source():
    told = chapters.interface_law(small.interface_law(), Look())
    assert "given parameters" in told.see and "0.25" in told.conclude and len(told.figures) == 3


def test_pin_and_disc_tell_how_the_pin_leans():
    assert "upstream" in chapters.pin_on_disc(small.pin_on_disc(), Look()).see
    assert "the tip digs in" in chapters.pin_on_disc(replace(small.pin_on_disc(), tilt=-0.07), Look()).see
    disc, pin = chapters.pin_on_disc(small.pin_on_disc(), Look()).tables
    assert ("3", "2250", "93 %") in disc.rows and pin.rows == (("146.5", "362", "2245"),)


def test_lock_in_counts_kinds_over_length_and_lists_the_rest():
    told = chapters.lock_in(small.lock_in(), Look())
    assert "Over 5 pin lengths: 1 none, 1 classical, 1 intermediate, 1 multiple, 1 other" in told.conclude
    assert "2 points did not settle" in told.conclude
    length_map, case = told.figures
    assert "filled where" in length_map.caption and "151.5 mm" in case.caption and "(settled)" in case.caption
    table, = told.tables
    assert [row[0] for row in table.rows] == ["case", "tilt"] and table.rows[0][7:9] == ("classical", "2215")
