"""Chapter of a model updated by a modal test."""

from dataclasses import replace

import numpy as np

from pipeline.views.chapters.bench import model_update
from pipeline.views.chapters.chapter import Look
from tests.views import products_for_views as small


def test_values_pairs_doubts_and_points_are_told():
    product = small.model_update()
    made = model_update.chapter(product, Look())
    assert model_update.headline(product) == (
        "2 of 4 measured modes paired beyond doubt; the model is off by 3.8\u202f% as stated, by 0.11\u202f% updated",
        "warning")
    assert "disc.young 120\u202fGPa to 128.3\u202fGPa ± 0.4\u202f%" in model_update.values(product)
    assert "hardly tells disc.poisson: what was stated decides" in model_update.values(product)
    assert model_update.doubts(product) == ("No mode of the model: 1710 Hz; one of two modes of the model: 1500 Hz.")
    assert "Point node 2 direction 3 shows other shapes than the model (correlation of 0.5" in made.conclude
    values, modes, points = made.tables
    assert modes.rows[0][4:] == ("0.99", "2 nodal diameters") and modes.rows[2][5] == "in doubt: or 1512 Hz"
    assert modes.rows[3][5] == "no mode of the model" and points.rows[1][4] == "4"
    assert values.rows[0] == ("disc.young", "120\u202fGPa", "10\u202f%", "128.3\u202fGPa", "0.4\u202f%", "0.2\u202f%")


def test_without_points_the_page_says_so():
    made = model_update.chapter(small.model_update(points=False), Look())
    assert "by frequency alone, as no point of the test is stated" in made.see and len(made.tables) == 2
    assert made.tables[0].rows[0][5] == "not estimated" and "only a finer mesh shows" in made.notes[1]


def test_of_a_brake_the_page_names_the_bodies_that_move():
    product = replace(small.model_update(body="assembly"), parameter=["disc.young", "joints.finger_stiffness"])
    made = model_update.chapter(product, Look())
    assert "those of the assembled brake at rest" in made.see and "linear springs" in made.notes[-1]
    assert made.tables[1].rows[0][5] == "disc 93\u202f%" and made.tables[1].rows[2][5] == "in doubt: or 1512 Hz"
    assert made.tables[0].rows[1][0] == "joints.finger_stiffness"


def test_of_many_values_those_that_moved_most_are_listed():
    small_one = small.model_update()
    after = np.array([1.0, 1.3, 1.1, 1.0, 1.2, 1.05, 1.02, 0.9])
    product = replace(small_one, parameter=np.array([f"joints.j{k}" for k in range(8)]), unit=np.array(["N/m"] * 8),
                      before=np.ones(8), before_spread=np.full(8, 0.3), after=after, after_spread=np.full(8, 0.01),
                      correlation=np.eye(8), mesh_spread=np.zeros(8))
    told = model_update.values(product)
    assert "joints.j1 " in told and "joints.j7 " in told and "joints.j0 " not in told and "joints.j3 " not in told
    assert told.endswith("; others in the table.")


def test_another_brake_is_told_by_modes_without_a_pair_and_by_values_far_off():
    product = replace(small.model_update(body="assembly"), after=np.array([180e9, 0.272]))
    told = model_update.strange(product)
    assert told.startswith("No more than half of the measured modes are modes of this model beyond doubt")
    assert "another brake, and no completed case is written" in told
    assert told.endswith("More than 3 standard deviations from what was stated: disc.young.")
    assert told in dict(model_update.note(product))["In doubt"]
    assert model_update.strange(replace(small.model_update(), clear=np.ones(4, int))) == ""
