"""Blocks on unstable modes: who meets whom, from which friction on, what feeds and what dissipates."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.products.motion import COUPLING, FALLING, SINGLE
from pipeline.views.chapters import complex_modes as chapter
from pipeline.views.chapters.chapter import Look
from pipeline.views.chapters.unstable_modes import (
    blocks,
    budget,
    distinct_unstable,
    explanation,
    losses,
    mechanism,
    pair,
    summed,
)
from tests.views import products_for_views as small

NARROW = "\N{NARROW NO-BREAK SPACE}"


@pytest.fixture
def modes():
    return small.complex_modes()


def test_a_coupled_mode_says_whom_it_meets_and_from_when_on(modes):
    text = explanation(modes, 0).replace(NARROW, " ")
    assert mechanism(modes, 0) == COUPLING
    assert "16.6 kHz of the disc with 5 nodal diameters meets 16.4 kHz of the inner pad." in text
    assert "come within 3 Hz" in text and "MAC of 0.9" in text and "Unstable from friction 0.4 on" in text
    assert "frequencies become equal" in explanation(replace(modes, followed_nearest=[0.0]), 0)
    lost = replace(modes, pair_body=[[0, -1]])
    assert "could not be followed" in explanation(lost, 0) and len(pair(lost, 0)) == 1


def test_a_mode_that_meets_no_other_is_not_called_coupled(modes):
    alone = replace(modes, followed_alike=[0.3], followed_mechanism=[SINGLE])
    assert mechanism(alone, 0) == SINGLE and len(pair(alone, 0)) == 1
    assert explanation(alone, 0).startswith("Friction feeds a single mode")
    falls = replace(alone, followed_mechanism=[FALLING])
    assert mechanism(falls, 0) == FALLING and explanation(falls, 0).startswith("Friction that falls with slip speed")


def test_what_was_not_followed_has_no_mechanism(modes):
    assert mechanism(modes, 1) is None and pair(modes, 1) == ()


def test_parts_of_the_growth_rate_are_listed_largest_first(modes):
    assert budget(modes, 0) == (
        "Parts of the growth rate in 1/s, small ones left out: fed by friction at outer pad +300, friction at inner pad"
        " +100; dissipated by contact damping −150, friction turning with the slip −100, friction over slip speed −30,"
        " damping of inner pad −30.")
    names, values = summed(modes, 0)
    assert names[-1] == "bodies, joints" and values[-1] == pytest.approx(-42.6)
    assert sum(values) == pytest.approx(modes.unstable_growth[0].sum()) and len(names) == 6
    assert losses(modes, 0)["joints"] == {"abutment": -10.0}


def test_every_followed_mode_has_a_block_with_its_figures(modes):
    block, = blocks(modes, small.reduced_model(), {0: b"RIFF moving"}, Look(dpi=50))
    path, contacts, moving = block.figures
    assert path.uri.startswith("data:image/svg") and contacts.uri.startswith("data:image/png")
    assert moving.uri.startswith("data:image/webp") and "growth rate" in block.title
    assert len(blocks(modes, None, {}, Look(dpi=50))[0].figures) == 1      # no surface, no contacts
    assert blocks(small.complex_modes(stable=True), None, {}, Look(dpi=50)) == ()


def test_the_chapter_holds_the_blocks_and_each_frequency_once(modes):
    made = chapter.chapter(modes, None, (), Look(dpi=50))
    assert len(made.blocks) == 1 and len(made.figures) == 4
    assert distinct_unstable(modes, 5) == [0]
    two = replace(modes, unstable_first=np.arange(len(modes.unstable_root)) // 2 * 2)
    assert distinct_unstable(two, 2) == [0, 2]
