"""Which root of a refined model is which of the coarse one's."""

import numpy as np

from pipeline.physics.stability.refinement import moved_roots


def test_roots_are_paired_closest_first_and_the_rest_is_told():
    unstable = np.array([100 + 1000j, 20 + 1010j, 5 + 3000j])
    refined = np.array([90 + 1002j, 90 - 1002j, 15 + 1009j, -300 + 1000j, 40 + 5000j, 3 + 6000j, -1 + 3500j])
    moved = moved_roots(unstable, refined, 10.0)
    np.testing.assert_array_equal(moved.root[:2], [90 + 1002j, 15 + 1009j])
    assert np.isnan(moved.root[2])      # the nearest is 17 % away
    np.testing.assert_array_equal(moved.added, [40 + 5000j])    # 3 1/s is neutral


def test_a_root_that_now_decays_is_the_same_mode():
    moved = moved_roots([5 + 3000j], [-2 + 3001j, 50 + 3500j], 10.0)
    assert moved.root[0] == -2 + 3001j and list(moved.added) == [50 + 3500j]


def test_no_unstable_root_at_all():
    moved = moved_roots([], [-2 + 3001j], 10.0)
    assert not len(moved.root) and not len(moved.added)
