"""Which eigenvalue a recorded pole belongs to."""

import numpy as np
import pytest

from pipeline.diagnosis.features.pairing import assigned, merged, nearer
from pipeline.physics.signals.pole_identification import Poles


def test_roots_that_have_to_pass_each_other_are_told_by_their_shapes():
    """The peaks of two motions whose roots stated values put in the other order: the nearest is the other's."""
    shape = np.array([[1.0, 0.0], [1.0, 0.7]], complex)
    seen = Poles(np.array([1362j, 1543j]), np.ones(2), shape)
    assert list(assigned(seen, np.array([1378j, 1426j]), shape[::-1])) == [1, 0]
    assert list(assigned(seen, np.array([1378j, 1426j]), shape)) == [0, 1]


def test_a_peak_that_is_no_mode_does_not_move_the_others_by_one():
    """Of one shape all: by distance alone five steps of one cost what one step of five does."""
    root = 2j * np.pi * np.array([600.0, 700, 800, 900, 1000, 1100])
    one = Poles(np.sort_complex(np.append(root[:5], 500j * 2 * np.pi)), np.ones(6), np.ones((6, 2), complex))
    assert list(assigned(one, root, np.ones((6, 2)))) == [5, 0, 1, 2, 3, 4]


def test_two_roots_that_a_record_cannot_tell_apart_show_as_one_between_them():
    root = np.array([-17 + 13960j, -140 + 14030j, -20 + 14400j])
    peak, away = -34 + 13970j, -34 + 13990j
    near = merged(np.array([peak]), root, [1], 150.0).item()
    assert abs(near - peak) < 1.0 and abs(merged(np.array([away]), root, [1], 150.0).item() - away) > 5
    assert merged(np.array([peak]), root, [1], 100.0) == root[1], "roots that are told apart"
    assert np.array_equal(merged(np.array([peak, root[1]]), root, [0, 1], 150.0), root[:2]), "each with a peak"
    assert merged(np.array([-200 + 14040j]), root, [1], 150.0) == root[1], "never beyond the root itself"


def test_far_roots_count_less_and_less():
    seen = np.array([-5 + 2000j, -5 + 2000j])
    near, far = nearer(seen, seen + np.array([0.2j, 1e6j]))
    assert near - seen[0] == pytest.approx(0.2j, rel=1e-6) and abs(far - seen[1]) == pytest.approx(200.0, rel=1e-3)
