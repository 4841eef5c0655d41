"""Pairs of measured and computed modes: by frequency, by shape, and in doubt."""

import numpy as np
import pytest

from pipeline.physics.modal.mode_pairing import CLEAR, assurance, grouped, nearest_mixture, paired, real

ANGLE = 2 * np.pi * np.arange(9) / 9
PAIR = np.column_stack((np.cos(2 * ANGLE), np.sin(2 * ANGLE)))
OTHER = np.column_stack((np.cos(3 * ANGLE), np.sin(3 * ANGLE)))


def by(distance, spread=0.01, places=(1, 1), likeness=None, dimensions=(1, 1), points=9):
    distance = np.asarray(distance, float)
    return paired(distance, np.full(distance.shape, spread), list(places), 2.0, likeness, np.array(dimensions), points)


def test_modes_close_in_frequency_are_one_group():
    assert [g.tolist() for g in grouped(np.array([100.0, 100.1, 200.0, 300.0, 300.0]), 2e-3)] == [[0, 1], [2], [3, 4]]
    assert grouped(np.zeros(0), 1e-3) == []


def test_the_likeness_with_a_pair_is_that_with_its_nearest_mixture():
    turned = PAIR @ (0.6, -0.8)
    np.testing.assert_allclose(nearest_mixture(turned, PAIR), turned, atol=1e-12)
    np.testing.assert_allclose(assurance(np.array([turned, PAIR[:, 0] + OTHER[:, 0]]), [PAIR, OTHER]),
                               [[1, 0], [0.5, 0.5]], atol=1e-12)


def test_a_complex_shape_is_turned_to_where_it_moves():
    shape = PAIR[:, 0] * np.exp(1.1j)
    assert abs(real(shape) @ PAIR[:, 0]) == pytest.approx(PAIR[:, 0] @ PAIR[:, 0])


def test_frequencies_far_apart_are_clear_without_shapes():
    found = by([[0.005, 0.3], [-0.3, -0.002]])
    assert found.group.tolist() == [0, 1] and found.clear.all()


def test_two_modes_within_the_spread_are_in_doubt_until_shapes_tell():
    distance = [[0.005, -0.004], [0.004, -0.005]]
    doubt = by(distance)
    assert sorted(doubt.group) == [0, 1] and not doubt.clear.any() and (doubt.odds < CLEAR).all()
    told = by(distance, likeness=np.array([[0.05, 0.99], [0.98, 0.1]]))
    assert told.group.tolist() == [1, 0] and told.clear.all()


def test_a_mode_that_the_model_lacks_has_no_pair():
    found = by([[0.4, -0.4], [0.002, -0.8]])
    assert found.group.tolist() == [-1, 0] and found.clear.tolist() == [False, True]
    unlike = by([[0.001, -0.8]], likeness=np.array([[0.03, 0.02]]))
    assert unlike.group.tolist() == [-1]


def test_a_pair_of_a_disc_has_room_for_two():
    likeness = np.array([[0.99, 0.01], [0.98, 0.02], [0.01, 0.99]])
    found = by([[0.001, 0.2], [-0.001, 0.2], [-0.2, 0.0]], places=(2, 2), likeness=likeness, dimensions=(2, 2))
    assert found.group.tolist() == [0, 0, 1] and found.clear.all()


def test_shapes_at_fewer_points_than_mixtures_tell_nothing():
    distance = [[0.001, -0.001]]
    assert not by(distance, likeness=np.ones((1, 2)), dimensions=(2, 2), points=2).clear.any()
