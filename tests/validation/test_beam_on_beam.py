"""Rows of the beam on beam from products whose numbers are known."""

import numpy as np

from pipeline.products import ComplexModes
from pipeline.validation.beam_on_beam import coalescence_rows, motion_rows, stability_rows
from tests.views.products_for_views import filled
from tests.views.test_beam_on_beam_chapter import beams, scatter

KNOWN = {"coalescence_low": 400.0, "coalescence_middle": 2700.0, "coalescence_high": 7700.0, "friction_drawn": 0.15}


def test_each_coalescence_is_the_nearest_or_none():
    rows = coalescence_rows(beams(), KNOWN)
    assert rows["coalescence_middle"].value == 2800 and rows["coalescence_middle_friction"].value == 0.12
    assert rows["coalescence_high"].value is None
    assert rows["coalescence_count"].value == 1, "one lies below a friction of 0.15"
    assert rows["mode_5"].value is None


def test_unstable_modes_below_10_khz_at_the_first_point():
    root = 2j * np.pi * np.array([400.0, 2800.0, 12e3, 400.0]) + 5.0
    modes = filled(ComplexModes, unstable_operating=[0, 0, 0, 1], unstable_root=root)
    row = stability_rows(modes, {})["unstable_at_friction"]
    assert row.value == 2 and "2800 Hz" in row.note


def test_motion_is_told_by_its_median_and_range():
    rows = motion_rows(scatter(), {})
    assert rows["simulated_fundamental"].value == 2695 and "2680 to 2700" in rows["simulated_fundamental"].note
    assert "means over the sampling interval" in rows["peak_force"].note, "what a force over a step means is told"
    assert rows["measured_third"].value == 3 * 2695 and rows["second_harmonic"].value == 20
