"""Chapters of a system of matrices: the verdict, what moves it, how certain; a stable one."""

import numpy as np

from pipeline.products import Matrices, MatrixModes, MatrixTerm, RootsOfMatrices
from pipeline.views.chapters.chapter import Look
from pipeline.views.chapters.models import matrix_modes
from pipeline.views.pages.report import plan
from pipeline.views.pages.summary import verdict
from pipeline.views.pages.verdict_file import verdict_text

TWO_PI = 2.0 * np.pi


def modes(unstable=2):
    found = RootsOfMatrices(
        speed=[1.0, 2.0], searched=300.0, root_operating=[0, 0, 1, 1],
        root=TWO_PI * np.array([5 + 800j, -9 + 1500j, 2 + 810j, -9 + 1510j]),
        unstable_operating=[0, 1][:unstable], unstable_root=TWO_PI * np.array([5 + 800j, 2 + 810j])[:unstable],
        residual=np.full(unstable, 4e-9), per_term=np.tile([[-20.0 + 1j, 90.0, -3.0]], (unstable, 1)),
        per_speed=np.full(unstable, 4.0 + 0j), per_friction=np.full(unstable, 50.0 + 0j))
    grows = np.array([[-3.0, 31.4], [-3.0, 12.6]]) if unstable else np.full((2, 2), -3.0)
    return MatrixModes(friction=1.0, highest=3000.0, neutral=1e-6, term=["M", "Q", "K"], roots=found,
                       map_speed=[1.0, 2.0], map_friction=[0.5, 1.0], map_growth=grows,
                       map_frequency=np.full((2, 2), 800.0), map_unstable=(grows > 0).astype(int))


def test_the_first_screen_tells_where_what_matters_and_how_certain():
    told = verdict({"matrix_modes": modes()}, ())
    assert told.headline == ("Squeal can start at 2 of 2 speeds, most strongly at 800\u202fHz, which grows by"
                             " 31.4\u202f1/s") and told.tone == "squeal"
    answers = dict(told.answers)
    assert answers["Where"].endswith("On the map it is stable up to friction 0.5 times that of the matrices, whatever"
                                     " the speed.")
    assert "friction, everywhere +5, speed +0.4, Q +9, M \u22122, K \u22120.3" in answers["What matters"]
    assert "No root was missed up to 3\u202fkHz within 300\u202fHz" in answers["How certain"]


def test_a_stable_system_is_told_so():
    told = verdict({"matrix_modes": modes(0)}, ())
    assert told.headline == "No mode up to 3\u202fkHz grows at 2 speeds" and told.tone == "quiet"
    made = matrix_modes.chapter(modes(0), Look())
    assert not made.blocks and not made.tables[0].rows


def test_the_page_and_the_file_hold_both_chapters():
    term = MatrixTerm(kind="mass", times="1", source="m.mtx", row=[0], column=[0], value=[1.0], coefficient=[1.0],
                      speed_power=[0], friction_power=[0])
    products = {"matrices": Matrices(size=1, node=[], direction=[], reference_speed=1.0, constrained=[],
                                     remark=["matrices: 1 of 2 degrees of freedom (row 2): held"], terms={"M": term}),
                "matrix_modes": modes()}
    chapters = [write() for write in plan(products, Look(dpi=60)).values()]
    assert [c.anchor for c in chapters] == ["matrices", "matrix_modes"] and len(chapters[1].blocks) == 2
    assert chapters[0].notes == ("Matrices: 1 of 2 degrees of freedom (row 2): held.",)
    text = verdict_text(verdict(products, ()), products)
    assert '"squeal_can_start": true' in text and '"Q": 90.0' in text
