"""Stage friction_descriptions: counts that fit together, and its chapter."""

import numpy as np
import pytest

from pipeline.products import InterfaceLaw
from pipeline.views.chapters.chapter import Look
from pipeline.views.chapters.friction_descriptions import chapter
from stages.friction_descriptions import Settings, friction_descriptions
from tests.views.products_for_views import filled

QUICK = {"feet": 2, "steps": 60, "modulations": [0.3, 1.2]}


@pytest.fixture(scope="module")
def counted():
    law = filled(InterfaceLaw, friction=[0.3, 0.4, 0.5])
    return friction_descriptions(law, settings=Settings.model_validate(QUICK))


def test_every_description_is_counted_with_and_without_the_unsymmetric_term(counted):
    assert list(counted.description) == ["rigid", "elastic", "evolution"] and counted.iterations.shape == (2, 2, 3)
    assert (counted.worst >= counted.iterations).all() and counted.cost.min() == 1.0
    assert (counted.iterations[0, 0] > counted.iterations[1, 0]).all(), "steady sliding without the term costs more"
    assert counted.curve_error[2] < 1e-12 < counted.curve_error[1] < counted.curve_error[0]


def test_friction_of_the_interface_moves_the_block(counted):
    other = friction_descriptions(filled(InterfaceLaw, friction=[0.2]), settings=Settings.model_validate(QUICK))
    assert np.abs(other.mean_shift[1, 0]).max() < 0.7 * np.abs(counted.mean_shift[1, 0]).min()


def test_the_chapter_sets_the_claims_beside_the_counts(counted):
    made = chapter(counted, Look())
    assert len(made.tables[0].rows) == 12 and "Closest to the curve of a single contact: evolution" in made.conclude
    assert "Steady sliding differs by" in made.conclude and "loses contact by" in made.conclude
