"""Archard's volume is exact; the slider returns."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.physics.rough.archard_wear import WornPair, archard, run_in
from pipeline.physics.rough.contact.normal_contact import solve_normal_contact
from pipeline.physics.rough.generator import self_affine
from pipeline.physics.rough.layered_solid import half_space_compliance

PAD, DISC = (1e-6 * self_affine(np.random.default_rng(seed), 32, 1e-3, 2.5e-4, 5e-4, 0.8) for seed in (1, 2))
COMPLIANCE = half_space_compliance((32, 32), (1e-3 / 32,) * 2, 1e9, 0.3).normal


def states(stroke=3, pad=2e-12, disc=1e-13, cycles=8):
    return list(run_in(PAD, DISC, COMPLIANCE, 1e6, cycles=cycles, distance=1e-4, stroke=stroke, pad_coefficient=pad,
                       disc_coefficient=disc, tolerance=1e-6, max_iterations=500))


@pytest.mark.exact
def test_worn_volume_is_coefficient_times_load_times_distance():
    last = states()[-1]
    assert last.pad_wear.mean() == pytest.approx(archard(1e6, 8e-4, 2e-12), rel=1e-12)
    assert last.disc_wear.mean() == pytest.approx(archard(1e6, 8e-4, 1e-13), rel=1e-12)


def test_nothing_wears_without_a_coefficient():
    last = states(pad=0.0, disc=0.0)[-1]
    assert not last.pad_wear.any() and not last.disc_wear.any()
    np.testing.assert_array_equal(last.gap(0), -PAD - DISC)


def test_the_gap_follows_the_slider():
    worn = states()[-1]
    disc = DISC - worn.disc_wear
    np.testing.assert_array_equal(worn.gap(2), -(PAD - worn.pad_wear) - np.roll(disc, 2, axis=1))


def test_the_disc_wears_where_it_touched():
    """One cycle at position 0, then one at position 1: the second mark of the disc is shifted back."""
    first, second = states(pad=0.0, disc=1e-20, cycles=2)[1:]
    disc_mark = (second.disc_wear - first.disc_wear) / 1e-24
    gap = -PAD - np.roll(DISC, 1, axis=1)
    touched = np.roll(disc_mark > 0, 1, axis=1)
    assert gap[touched].mean() < gap[~touched].mean() - gap.std()


@pytest.mark.exact
def test_a_disc_yields_where_it_touches_wherever_the_slider_is():
    """What is flattened at a position comes off the gap there, node by node."""
    pair, flattened = WornPair(PAD, DISC, 0 * PAD, 0 * DISC), np.zeros_like(PAD)
    flattened[3, 5] = 1e-6
    for body in ("pad", "disc"):
        after = pair.after(SimpleNamespace(flattened=flattened), 2, body)
        np.testing.assert_allclose(after.gap(2) - pair.gap(2), flattened, atol=1e-18)


def test_wear_flattens_what_touches():
    pairs = states(cycles=40)
    assert np.std(pairs[-1].gap(0)) < np.std(pairs[0].gap(0))


@pytest.mark.parametrize("yielding, other", [("pad", "disc"), ("disc", "pad")])
def test_the_softer_body_stays_flattened(yielding, other):
    """Without wear a second pass over what has yielded flattens next to nothing more."""
    hard = solve_normal_contact(-PAD - DISC, COMPLIANCE, 1e6).pressure.max()
    new, *passed = run_in(PAD, DISC, COMPLIANCE, 1e6, cycles=3, distance=1e-4, stroke=0, pad_coefficient=0.0,
                          disc_coefficient=0.0, tolerance=1e-7, max_iterations=2000, hardness=hard / 4,
                          yielding=yielding)
    sunk = [getattr(state, f"{yielding}_height") - getattr(new, f"{yielding}_height") for state in passed]
    assert sunk[0].max() == 0.0 and -sunk[0].min() > 0.1 * PAD.std()
    np.testing.assert_allclose(sunk[2], sunk[0], atol=1e-3 * abs(sunk[0]).max())
    np.testing.assert_array_equal(getattr(passed[2], f"{other}_height"), getattr(new, f"{other}_height"))


def test_what_the_disc_yields_moves_with_it():
    hard = solve_normal_contact(-PAD - DISC, COMPLIANCE, 1e6).pressure.max()
    new, first, second = run_in(PAD, DISC, COMPLIANCE, 1e6, cycles=2, distance=1e-4, stroke=1, pad_coefficient=0.0,
                                disc_coefficient=0.0, tolerance=1e-6, max_iterations=2000, hardness=hard / 4,
                                yielding="disc")
    mark = np.roll(first.disc_height - second.disc_height, 1, axis=1) > 0
    gap = -PAD - np.roll(first.disc_height, 1, axis=1)
    assert mark.any() and gap[mark].mean() < gap[~mark].mean() - gap.std()
    assert new.disc_height is DISC


def test_expected_pressure_is_nearer_than_the_last_one():
    pair, later = states(cycles=41)[-2:]
    position = 40 % 4
    found, last = later.met[position][1], pair.met[position][1]
    assert np.linalg.norm(pair.expected(position) - found) < 0.5 * np.linalg.norm(last - found)
    assert later.met[position][0] == 40 and states(cycles=1)[0].expected(0) is None


@pytest.mark.exact
def test_expected_pressure_goes_on_as_it_changed():
    pair = states(cycles=0)[0]
    for position, cycle, pressure in ((0, 0, 4.0), (1, 1, 5.0), (0, 2, 7.0), (1, 3, 5.0)):
        pair = replace(pair, met=pair.meeting(position, cycle, np.full((1, 1), pressure)))
    assert (pair.expected(0), pair.expected(1)) == (10.0, 5.0)
