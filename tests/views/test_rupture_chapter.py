"""The chapter of a rupture and the head of its page."""

from dataclasses import replace

import numpy as np

from pipeline.contract.context import CaseSummary
from pipeline.views.chapters.chapter import Look
from pipeline.views.chapters.models.rupture import CLAIM, INFERRED, TABLE_2, chapter, headline
from pipeline.views.pages.report import page, plan
from tests.views import products_for_views as small

LOOK = Look(dpi=50, shapes=0)


def test_the_chapter_tells_fronts_waves_and_doubts():
    written = chapter(small.rupture(), LOOK)
    assert written.conclude.startswith("The left front stops, the right one runs on. Left: 1650")
    assert "1.65" not in written.conclude and "8.75\u202fmm" in written.conclude
    assert written.notes == (CLAIM, INFERRED, TABLE_2)
    assert "The slip of the right pulse grows: 1.4 mm from the centre it is 140\u202f% of that" in written.conclude
    assert "(uniform pre-stress: 40\u202f% at a spacing of 50\u202fµm and 60\u202f% at a spacing of 25\u202fµm; 30" in (
        written.conclude)
    assert "The Mach angles deviate by \u221211\u202f% and \u221210\u202f% from" in written.conclude
    fronts, waves = written.tables[:2]
    assert [row[0] for row in fronts.rows] == ["left", "right"] and "45.8°" in fronts.rows[0][7]
    assert waves.rows[3][1] == "1036" and written.tables[2].rows[0][2] == "100\u202f%"
    assert [t.title for t in written.tables[3:]] == ["Study: Mesh and memory", "Study: Shear over pressure",
                                                     "Study: Stiffness damping"]
    assert len(written.figures) == 10 and written.figures[0].picture.image.startswith(b"\x89PNG")


def test_what_did_not_happen_is_said():
    none = replace(small.rupture(), slip_growth=0.0, speed=[0.0, 0.0], phrase="both fronts die", interface_wave=0,
                   pulse_exists=0, study=["poisson"] * 10, shift=[0.0, 0.0], mach_known=np.zeros((2, 2), int))
    written = chapter(none, LOOK)
    assert written.conclude == "Both fronts die. No front leaves the run-in."
    assert "The pre-stress is uniform." in written.see
    assert written.tables[1].rows[3][1] == "none: solids too dissimilar" and written.tables[1].rows[4][1] == "none"
    assert len(written.figures) == 8


def test_the_page_opens_with_the_outcome():
    products = {"rupture": small.rupture()}
    html = page([build() for build in plan(products, LOOK).values()], products, CaseSummary(name="rupture"), LOOK)
    assert f"<h1>{headline(small.rupture())}</h1>" in html and '<section id="rupture">' in html
    assert "ill-posed" in html and "Table 2 of the paper contradicts itself" in html
