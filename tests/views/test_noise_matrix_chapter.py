"""Chapter of a noise matrix: how likely, where, whether the bench agrees, and what the schedule is made of."""

import json
from dataclasses import replace

import numpy as np

from pipeline.products import NoiseMatrix
from pipeline.views.chapters.chapter import Look
from pipeline.views.chapters.models.noise_matrix import bench, chapter, headline, where
from pipeline.views.chapters.models.noise_matrix_tables import differing
from pipeline.views.figures.models import noise_matrix as pictures
from pipeline.views.pages.summary import verdict
from pipeline.views.pages.verdict_file import verdict_text
from tests.views.products_for_views import filled

LOOK = Look(dpi=50)
PLAIN = {"condition_stops": [0, 0, 0, 0], "condition_noisy": [0, 0, 0, 0], "band_noisy": [0, 0], "run": [],
         "run_condition": [], "run_reason": [], "run_noisy": [], "tests": 0, "condition_expected": np.zeros(4),
         "condition_p_value": np.ones(4), "condition_least_p": np.ones(4), "condition_difference": [0, 0, 0, 0],
         "band_expected": [0.0, 0.0], "band_p_value": [1.0, 1.0], "band_least_p": [1.0, 1.0],
         "band_difference": [0, 0], "all_p_value": 1.0, "all_difference": 0, "all_expected": 0.0}
BENCH = {"condition_stops": [10, 5, 0, 0], "condition_noisy": [9, 1, 0, 0], "band_noisy": [10, 0],
         "run": ["one", "two"], "run_condition": [0, -1], "run_reason": ["", "no condition is near"],
         "run_noisy": [1, 0], "tests": 4, "condition_expected": [1.0, 1.5, 0.0, 0.0],
         "condition_p_value": [0.002, 1.0, 1.0, 1.0], "condition_least_p": [1e-4, 0.3, 1.0, 1.0],
         "condition_difference": [-1, 0, 0, 0], "band_expected": [2.5, 0.1], "band_p_value": [0.01, 1.0],
         "band_least_p": [1e-4, 0.3], "band_difference": [-1, 0], "all_p_value": 0.3, "all_difference": 0,
         "all_expected": 2.5}


def product(**more):
    """Two drags, one in reverse, and a stop, over two brakes; a bench where asked for."""
    return filled(NoiseMatrix, **{
        "title": "in the manner of SAE J2521", "published_sections": 25, "published_applications": 1917,
        "published_source": "foreword", "not_available": "Its values.", "origin_module": ["drag"],
        "origin_setting": ["speeds"], "origin_value": ["3 km/h"], "origin": ["inferred"], "origin_source": ["custom"],
        "module": ["drag", "stop"], "applications": [[6, 6, 6, 0], [0, 0, 0, 2]],
        "kind": ["drag", "drag", "drag", "stop"], "pressure": [5e5, 1e6, 5e5, 1e6],
        "speed": np.array([3, 3, -3, 50]) / 3.6, "end": np.array([3, 3, -3, 0]) / 3.6, "temperature": np.zeros(4),
        "outside": [1, 0, 0, 0], "limits": [2e3, 16e3], "source": ["friction"], "source_law": ["normal"],
        "source_varies": [1], "value": np.zeros((4, 1)), "repeats": 2, "probability": [0.1, 0.3, 0.0, 0.6],
        "interval": np.array([[0.05, 0.2]] * 4), "band": [1995.3, 2511.9], "band_occurrence": [0.2, 0.01],
        "band_probability": np.zeros((4, 2)), "module_occurrence": [0.13, 0.6], "module_interval": [[0.1, 0.2]] * 2,
        "occurrence": 0.18, "occurrence_interval": [0.12, 0.26], "brake_occurrence": [0.0, 0.36], "level": 0.05,
        "refined_stops": 20, "refined_changed": 1, "checked_draws": 0, "missed": 0, "wheel_radius": 0.3,
        **PLAIN, **more})


def plain(text):
    return text.replace("\N{NARROW NO-BREAK SPACE}", " ")


def test_the_first_screen_answers_how_likely_where_and_whether_the_bench_agrees():
    told = verdict({"noise_matrix": product(**BENCH)}, ())
    assert plain(told.headline) == ("18 % (12 % to 26 %) of the brake applications of this schedule are predicted to"
                                    " squeal") and told.tone == "squeal"
    answers = {name: plain(answer) for name, answer in told.answers}
    assert answers["Schedule"] == ("One in the manner of SAE J2521: 20 brake applications, of 1917 published ones. Its"
                                   " values are not those of the standard, which were not available.")
    assert answers["Where"].startswith("Most likely in stops from 50 to 0 km/h, 10 bar, 60 % of the draws; most of it"
                                       " in the 1/3 octaves of 2 kHz (20 %), 2.5 kHz (1 %). 50 % of the drawn brakes"
                                       " are noisy under some condition in their 2 drawn stops of each.")
    assert answers["The bench"] == (
        "The bench squealed in 10 of 15 recorded stops, where 2.5 noisy ones are predicted (no difference beyond"
        " chance, p 0.3). Beyond chance: drags at 3 km/h, 5 bar (9 of 10 noisy, 1 predicted): the model squeals too"
        " little; 1/3 octave of 2 kHz (10 of 15 noisy, 2.5 predicted): the model squeals too little.")
    assert "At twice as many speeds along a stop, 1 of 20 drawn stops" in answers["How certain"]
    assert "1 of 4 conditions lie" in answers["How certain"]


def test_other_programs_read_the_same():
    given = {"noise_matrix": product(**BENCH)}
    made = json.loads(verdict_text(verdict(given, ()), given))["noise_matrix"]
    assert made["occurrence"] == 0.18 and made["applications"] == 20 and (made["recorded"], made["noisy"]) == (15, 10)
    assert made["differences"][0] == {"condition": "drags at 3 km/h, 5 bar", "recorded": 10, "noisy": 9,
                                      "predicted_noisy": 1.0, "family_wise_p": 0.002, "model_squeals_too": "little"}
    assert json.loads(verdict_text(verdict({}, ()), {}))["noise_matrix"] is None


def test_agreement_silence_and_no_bench_are_told():
    assert bench(product()) == "No stops were recorded: nothing says whether a bench agrees."
    agreeing = product(**{**BENCH, "condition_difference": [0] * 4, "band_difference": [0, 0]})
    assert not differing(agreeing) and bench(agreeing).endswith(
        "No pressure, speed or band differs by more than chance. In 1 of 2 conditions it could not have: so few stops"
        " of one brake, or so few draws, leave room for any result.")
    far = product(**{**BENCH, **{name: PLAIN[name] for name in ("condition_stops", "condition_noisy")}})
    assert bench(far) == "None of 2 recorded stops is near a condition of the schedule."
    quiet = product(occurrence=0.0, probability=np.zeros(4))
    assert headline(quiet) == ("No squeal is predicted in this schedule", "quiet") and where(quiet) == ""


def test_the_page_says_what_is_public_of_the_schedule_and_what_temperature_does():
    made = chapter(product(**BENCH), LOOK)
    assert "25 sections and 1917 applications (foreword). Not available: Its values." in made.see
    assert "The temperatures of the schedule do not act" in made.see and "How loud it gets is not predicted" in made.see
    titles = [table.title for table in made.tables]
    assert titles == ["Where the bench and the model differ by more than chance", "Occurrence by module",
                      "What scatters", "Recorded stops that are no condition of the schedule",
                      "Where the values of the schedule come from"]
    assert made.tables[1].rows[1][1] == "2" and made.tables[4].rows[0][3] == "inferred"
    acts = chapter(replace(product(), temperature=np.full(4, 300.0)), LOOK)
    assert "softening of the friction map" in acts.see and len(acts.tables) == 3


def test_tiles_join_temperatures_and_keep_the_strongest_difference():
    warm = product(**{**BENCH, "pressure": [5e5, 5e5, 5e5, 1e6], "applications": [[6, 2, 6, 0], [0, 0, 0, 2]]})
    first = pictures.tiles(warm)[0]
    assert (first.column, first.stops, first.noisy, first.difference) == ("3", 15, 10, -1)
    assert first.share == np.average([0.1, 0.3], weights=[6, 2])
    assert [tile.column for tile in pictures.tiles(warm)] == ["3", "R 3", "50\N{RIGHTWARDS ARROW}0"]


def test_pictures_are_drawn_the_same_twice_and_follow_the_data():
    for draw in (pictures.matrix, pictures.bands, pictures.brakes):
        for made in (product(), product(**BENCH)):
            assert draw(made) == draw(made)
    changed = product(probability=[0.9, 0.3, 0.0, 0.6], band_occurrence=[0.1, 0.1], brake_occurrence=[0.5, 0.6])
    for draw in (pictures.matrix, pictures.bands, pictures.brakes):
        assert draw(changed) != draw(product())
    assert pictures.matrix(product(**BENCH)) != pictures.matrix(product())
