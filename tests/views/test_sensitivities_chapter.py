"""The chapter of what matters: its sentence, ranks and remedies are those of the product."""

from dataclasses import replace
from types import SimpleNamespace

import pytest

from pipeline.views.chapters.chapter import Look
from pipeline.views.chapters.models.sensitivities import chapter, in_words, statement
from tests.views import products_for_views as small

LOOK = Look(dpi=50, shapes=0)


def plain(text):
    return text.replace("\u202f", " ")


def test_the_sentence_says_what_matters_most_and_what_makes_it_stable():
    said = plain(statement(small.sensitivities()))
    assert said.startswith("What matters most for the mode at 10.9 kHz (growth rate 300 1/s at 2 MPa and 10.25 rad/s)"
                           " is the shim stiffness: one standard deviation more of it (30 %) adds 120 1/s, then the"
                           " lining loss factor (50 % takes away 60 1/s) and friction (2 % adds 30 1/s).")
    assert said.endswith("It becomes stable with friction 30 % lower (0.6 to 0.42); other modes are to be computed anew"
                         " then.")


def test_what_was_tried_in_vain_is_not_called_a_remedy():
    product = small.sensitivities()
    grows = replace(product, remedy_root=abs(product.remedy_root.real) + 1j * product.remedy_root.imag)
    assert statement(grows).endswith("No single value that was tried makes it stable.")
    assert "changed as far as parts usually can be" in statement(small.sensitivities(stable=True))


def test_the_table_follows_the_ranks_and_tells_assumed_scatter(words_only):
    table = chapter(small.sensitivities(), None, LOOK).tables[0]
    rows = [tuple(map(plain, row)) for row in table.rows]
    assert rows[0][:6] == ("shim stiffness", "50 N/µm", "30 %", "+120 ± 6", "+4", "−76 %")
    assert rows[0][6] == "structure.joints.shim_stiffness"
    assert rows[3][2] == "5 %, assumed" and rows[4][2] == "0.004" and rows[4][5] == "—"
    assert [row[0] for row in rows] == ["shim stiffness", "lining loss factor", "friction", "disc density",
                                        "friction over pressure"]


def test_values_that_are_not_known_of_a_mode_are_left_out_of_its_ranks():
    product = small.sensitivities()
    known, rank = product.known.copy(), product.rank.copy()
    known[0, 0], rank[0] = 0, [0, 1, 2, 3, 4]
    lost = chapter(replace(product, known=known, rank=rank), None, LOOK)
    assert lost.tables[0].rows[0][0] == "lining loss factor" and len(lost.tables[0].rows) == 4
    assert next(row for row in lost.tables[2].rows if row[0] == "shim stiffness")[1] == "—"


def test_remedies_that_were_tried_and_values_without_a_derivative_have_tables(words_only):
    _, tried, every, missing = chapter(small.sensitivities(), None, LOOK).tables
    assert [tuple(map(plain, row[:4])) for row in tried.rows] == [("friction", "0.6", "0.42", "−3"),
                                                                 ("lining loss factor", "0.03", "0.09", "+40")]
    assert every.folded and len(every.rows) == 5 and missing.rows[0][0] == "structure.*.poisson"
    assert len(chapter(small.sensitivities(stable=True), None, LOOK).tables) == 3


def test_each_of_the_strongest_modes_has_a_figure_and_finer_meshes_are_told():
    made = chapter(small.sensitivities(), SimpleNamespace(root=[1j], growth_share=0.08), LOOK)
    assert len(made.figures) == 2 and "3.2" in made.figures[1].caption
    assert "growth rates by up to 8\u202f%" in made.see


def test_nothing_unstable_says_so():
    none = small.filled(type(small.sensitivities()), mode=[], parameter=[], remedy_mode=[], left_out=[])
    assert chapter(none, None, LOOK).conclude == "No sensitivities." and statement(none) == ""


@pytest.mark.parametrize(("name", "words"), [
    ("structure.joints.abutment_stiffness", "abutment stiffness"), ("structure.disc.young", "disc Young's modulus"),
    ("structure.piston.fluid.bulk_modulus", "fluid bulk modulus"), ("friction_over_speed", "friction over speed"),
    ("structure.disc.ring_thickness", "disc ring thickness"), ("joints.spring.stiffness", "spring stiffness")])
def test_names_are_words(name, words):
    assert in_words(name) == words
