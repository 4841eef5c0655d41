"""Ladders of harmonics, unrelated tones, and the chance of a false match against its formula."""

import numpy as np
import pytest

from pipeline.physics.signals.harmonic_ladder import ladders


@pytest.mark.exact
def test_a_ladder_in_any_order_of_its_tones():
    order, fundamental = ladders(np.array([2400.0, 800.0, 4000.0, 1600.0, 3200.0]), 5.0, 0.1)
    assert list(order) == [3, 1, 5, 2, 4]
    assert (fundamental == 800.0).all()


@pytest.mark.exact
def test_two_ladders_at_once_keep_apart():
    order, fundamental = ladders(np.array([700.0, 1400.0, 2100.0, 1130.0, 2260.0, 3390.0]), 2.0, 0.1)
    assert list(order) == [1, 2, 3, 1, 2, 3]
    assert list(fundamental) == [700.0] * 3 + [1130.0] * 3


@pytest.mark.exact
def test_tones_without_a_fundamental_are_their_own():
    """2 g and 3 g are no multiples of each other; g itself is not there."""
    order, fundamental = ladders(np.array([1600.0, 2400.0]), 5.0, 0.1)
    assert list(order) == [1, 1] and list(fundamental) == [1600.0, 2400.0]
    assert ladders(np.array([]), 5.0, 0.1)[0].size == 0


@pytest.mark.exact
@pytest.mark.parametrize("ratio", [1.0, 1.5, 2.05, 2.757, 5.404])
def test_inharmonic_ratios_are_own_tones(ratio):
    """Among them the second and third mode of a free bar, 2.757 and 5.404 times its first."""
    assert list(ladders(np.array([800.0, 800.0 * ratio]), 5.0, 0.1)[0]) == [1, 1]


@pytest.mark.exact
def test_the_tolerance_is_that_of_both_frequencies():
    """Order 2: twice the error of the fundamental and once the error of the tone."""
    for sign in (-1, 1):
        assert ladders(np.array([800.0, 1600.0 + sign * 14.99]), 5.0, 0.1)[0][1] == 2
        assert ladders(np.array([800.0, 1600.0 + sign * 15.01]), 5.0, 0.1)[0][1] == 1


@pytest.mark.exact
def test_the_chance_of_a_false_match_is_the_one_that_is_told():
    arbitrary = 1200.0 + 800.0 * (np.arange(4000) + 0.5) / 4000
    share = np.mean([ladders(np.array([800.0, tone]), 5.0, 0.1)[0][1] > 1 for tone in arbitrary])
    assert share == pytest.approx(2 * 3 * 5.0 / 800.0, abs=1e-9)


@pytest.mark.exact
def test_a_high_order_counts_only_with_the_steps_below_it():
    """Order 8 alone: 2 * 9 * 5 / 800 = 11 % of all tones would match. After 2, 4 and 6: 2 * (8/6 + 1) * 5 / 800."""
    assert ladders(np.array([800.0, 6400.0]), 5.0, 0.1)[0][-1] == 1
    assert ladders(np.array([800.0, 6400.0]), 5.0, 0.12)[0][-1] == 8
    assert ladders(np.array([800.0, 1600.0, 3200.0, 4800.0, 6400.0]), 5.0, 0.1)[0][-1] == 8


@pytest.mark.exact
def test_steps_sharpen_the_fundamental():
    """The fundamental is read 4 Hz low: its tenth multiple would miss by 40 Hz, its ladder misses none."""
    ladder = 800.0 * np.arange(1, 11)
    ladder[0] -= 4.0
    assert list(ladders(ladder, 5.0, 0.1)[0]) == list(range(1, 11))
