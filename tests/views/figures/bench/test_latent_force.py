"""Pictures of the latent force, and what the page says of predictions with it."""

import pytest

from pipeline.products import LatentPrediction
from pipeline.views.chapters.bench.diagnosis import chapter
from pipeline.views.chapters.chapter import Look
from pipeline.views.figures.bench import latent_force as pictures
from tests.views.diagnosis_for_views import diagnosis

LABEL = "description, not identified physics"


@pytest.fixture(scope="module")
def predicted():
    """An unknown force that predicts the held-out run ``pulses``."""
    run = diagnosis().runs["pulses"]
    return diagnosis("unknown", latent_use=f"A function of v stands for it: {LABEL}.", latent_term=["constant", "v"],
                     latent_coefficient=[0.1, -2.0], latent_unit=["N", "N s/m"],
                     latent_predicted={"pulses": LatentPrediction(predicted=run.completed, error=0.02)})


def test_the_force_is_drawn_over_what_it_follows():
    assert "explains 80 %" in pictures.latent_force(diagnosis("unknown"), "bang").image


def test_the_prediction_is_drawn_beside_that_without_it(predicted):
    drawn = pictures.with_latent_force(predicted, "pulses").image
    assert "with the latent force" in drawn and "recalibrated" in drawn


def test_the_page_tells_the_errors_and_labels_them(predicted, words_only):
    told = chapter(predicted, Look())
    table, = (t for t in told.tables if LABEL in t.title)
    assert table.rows == (("pulses", "30\u202f%", "2\u202f%", "1.4\u202f%"),)
    assert any("Held-out run" in f.caption and "latent force" in f.caption and "A description" in f.caption
               for f in told.figures)
    assert predicted.latent_use.item() in told.notes and any("as requested" in n for n in told.notes)


def test_without_asking_the_page_says_that_no_prediction_uses_it(words_only):
    told = chapter(diagnosis("unknown"), Look())
    assert any("not used in any prediction" in n for n in told.notes) and not any(LABEL in t.title for t in told.tables)
