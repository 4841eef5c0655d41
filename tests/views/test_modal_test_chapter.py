"""Chapter of a modal test: how many modes, how well known, which make pairs."""

from dataclasses import replace

import numpy as np

from pipeline.products import ModalTest, Recording, Run
from pipeline.views.chapters.bench.modal_test import chapter, headline
from pipeline.views.chapters.chapter import Look
from pipeline.views.figures.bench import modal_test as pictures
from pipeline.views.pages.summary import verdict
from tests.views import products_for_views as small

LOOK = Look(dpi=50)


def plain(text):
    return text.replace("\N{NARROW NO-BREAK SPACE}", " ")


def test_modes_errors_and_pairs_are_told():
    made = chapter(small.modal_test(), LOOK)
    told = plain(made.conclude)
    assert told.startswith("Run hammer: 3 modes, frequencies known to 0.001 %, damping ratios of 0.2 % to 0.5 % of"
                           " themselves")
    assert "leave 1.2 % of a response" in told and "1 pair of modes is split by 0.25 %" in told
    rows = made.tables[0].rows
    assert [row[3] for row in rows] == ["2", "1", ""] and plain(rows[0][1]) == "800 ± 0.008"
    assert len(made.figures) == 2 and "3 modes" in made.figures[0].caption


def test_damping_of_narrow_peaks_is_doubted():
    known = small.modal_test()
    assert "too large" not in chapter(known, LOOK).conclude
    modes = replace(known.runs["hammer"], narrow=np.array([1, 1, 0]))
    assert "The damping of 2 modes comes out too large: fewer than four lines" in chapter(
        ModalTest(runs={"shaker": modes}), LOOK).conclude


def test_no_mode_is_told():
    none = small.modal_test(empty=True)
    assert headline(none) == ("No mode in the frequency responses", "warning")
    assert "no mode stands out" in chapter(none, LOOK).conclude and len(chapter(none, LOOK).figures) == 1


def test_the_first_screen_answers():
    recording = Recording(source=["a.uff 0"], runs={"hammer": Run(description="", repeat_of="")})
    told = verdict({"recording": recording, "modal_test": small.modal_test()}, ())
    assert plain(told.headline) == "3 modes from 800 Hz to 1.5 kHz"


def test_pictures_show_poles_and_likeness():
    modes = small.modal_test().runs["hammer"]
    first = pictures.stabilisation(modes, 50)
    assert first == pictures.stabilisation(modes, 50)
    assert first != pictures.stabilisation(replace(modes, chosen=np.full(len(modes.chosen), -1)), 50)
    assert pictures.likeness(modes, 50) != pictures.likeness(replace(modes, likeness=np.ones((3, 3))), 50)
    assert ModalTest(runs={}).runs == {}
