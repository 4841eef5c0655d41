"""The chapter on measured friction beside the map."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.views.chapters.bench import measured_friction
from pipeline.views.chapters.chapter import Look
from pipeline.views.figures.bench.measured_friction import varied
from pipeline.views.figures.number_format import percent
from pipeline.views.pages.summary import verdict
from tests.views import products_for_views as small

TOLD = small.friction_update()


@pytest.mark.parametrize("kind, words", [
    ("values", "Measured friction differs from the map in its level"), ("chance", "by no more than other patches"),
    ("tie", "these samples do not tell in what"), ("consistent", "Measured friction agrees with the map")])
def test_the_headline_answers(kind, words):
    assert words in measured_friction.headline(replace(TOLD, verdict=np.array(kind)))[0]


def test_errors_are_of_samples_that_were_not_fitted():
    said = measured_friction.errors(TOLD)
    expected = percent(np.sqrt(np.mean(np.log(TOLD.unseen / TOLD.friction) ** 2)), 2)
    assert f"with level changed by {expected} on samples that were not fitted" in said
    assert f"Tests scatter by {percent(0.02)}" in said


def test_settings_are_told_with_their_error_and_what_none_can_say():
    assert "micro_friction.third_body_factor 0.1 to 0.08 ± 0.003" in measured_friction.asked(TOLD)
    steeper = replace(TOLD, needed=np.array([0, 1, 0, 0, 0]), setting=np.empty(0, str), setting_before=[],
                      setting_after=[], setting_std=[])
    assert "No single setting changes friction over pressure" in measured_friction.asked(steeper)
    falling = replace(TOLD, setting=np.array(["rate_coefficient"]), setting_after=np.array([-0.01]))
    assert "another physics makes friction fall" in measured_friction.asked(falling)
    assert "state a higher disc_strength" in measured_friction.asked(replace(TOLD, setting_after=np.array([1.2])))


def test_what_is_beyond_the_map_and_what_does_not_vary_is_told():
    assert measured_friction.beyond(TOLD).startswith("1 of 12 samples lie beyond the map")
    assert measured_friction.would_tell(TOLD).endswith("hardly vary it: distance, temperature.")
    assert varied(TOLD) == ["pressure", "speed"]


def test_the_chapter_and_the_first_screen_hold_it():
    chapter = measured_friction.chapter(TOLD, Look())
    assert len(chapter.figures) == 2 and [row[2] for row in chapter.tables[0].rows] == ["yes", "no", "no", "not tested",
                                                                                       "not tested"]
    told = verdict({"friction_update": TOLD}, ())
    assert told.headline == measured_friction.headline(TOLD)[0] and "What to change" in dict(told.answers)
