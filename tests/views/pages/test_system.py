"""What was computed, on the first screen."""

from pipeline.views.pages.system import system
from tests.views import products_for_views as small

THIN = "\N{NARROW NO-BREAK SPACE}"


def test_bodies_contacts_operating_points_and_what_is_linear_are_named():
    told = system({"complex_modes": small.complex_modes()}).replace(THIN, " ")
    assert told.startswith("Disc, outer pad, inner pad and caliper in steady sliding on 12 contacts, at 1–3 MPa,"
                           " 8.5–12 rad/s and friction 0.43–0.49; vibration linear about it. What the model leaves out")
    followed = system({"complex_modes": small.complex_modes(), "transient": small.transient()})
    assert "about it, and time integration with contact." in followed


def test_without_modes_there_is_nothing_to_say():
    assert system({"surface": small.surface()}) == ""


def test_the_page_says_it(html):
    assert "<dt>What was computed</dt><dd>Disc, outer pad, inner pad and caliper" in html
