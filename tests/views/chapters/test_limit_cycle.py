"""Chapter of the limit cycle: the loudest can be heard."""

from dataclasses import replace

import numpy as np

from pipeline.views.chapters.chapter import Look
from pipeline.views.chapters.limit_cycle import chapter
from tests.views import products_for_views as small


def test_the_loudest_cycle_can_be_heard_and_says_what_it_is(words_only):
    (sound,) = chapter(small.limit_cycle(), Look(dpi=50)).sounds
    assert sound.data[:4] == b"RIFF" and "not the sound at an ear" in sound.caption
    assert "strongest line of the velocity at sensor a" in sound.caption
    assert not chapter(replace(small.limit_cycle(), listen={}), Look(dpi=50)).sounds


def test_the_chapter_states_step_patches_and_balance():
    cycle = replace(small.limit_cycle(), step=np.array(2e-6), patches=np.array(7), imbalance=np.array([0.001, 0.004]))
    told = chapter(cycle, Look(dpi=50)).see
    assert "7 contact patches, steps of 2\u202fµs" in told and "closes within 0.4\u202f%" in told
