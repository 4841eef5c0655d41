"""Chapter of the limit cycle: the loudest can be heard."""

from dataclasses import replace

from pipeline.views.chapters.chapter import Look
from pipeline.views.chapters.limit_cycle import chapter
from tests.views import products_for_views as small


def test_the_loudest_cycle_can_be_heard_and_says_what_it_is():
    (sound,) = chapter(small.limit_cycle(), Look(dpi=50)).sounds
    assert sound.data[:4] == b"RIFF" and "not the sound at an ear" in sound.caption
    assert "strongest line of the velocity at sensor a" in sound.caption
    assert not chapter(replace(small.limit_cycle(), listen={}), Look(dpi=50)).sounds
