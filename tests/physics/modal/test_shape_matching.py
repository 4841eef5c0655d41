"""Modes of two models by MAC: permuted and perturbed ones are found again, ambiguous ones are not forced."""

import numpy as np
import pytest

from pipeline.physics.modal.shape_matching import assurance, common_points, counterparts


def ring(count, waves, phase=0.0):
    """Points (n, 3) of a ring and, for each number of waves, its axial shape (w, n, 3)."""
    angle = np.linspace(0, 2 * np.pi, count, endpoint=False) + phase
    position = np.stack([0.12 * np.cos(angle), 0.12 * np.sin(angle), 0 * angle], axis=1)
    shape = np.zeros((len(waves), count, 3), complex)
    shape[:, :, 2] = np.exp(1j * np.outer(waves, angle))
    return position, shape


def test_mac_is_one_of_a_scaled_shape_and_that_of_a_mixture():
    x, y = np.eye(4)[:2] + 0j
    mixed = np.cos(0.3) * x + 1j * np.sin(0.3) * y
    np.testing.assert_allclose(assurance(np.array([x, y]), np.array([(2 - 3j) * x, mixed])),
                               [[1, np.cos(0.3) ** 2], [0, np.sin(0.3) ** 2]], atol=1e-15)
    assert assurance(np.zeros((1, 4)), np.array([x])) == 0


def test_permuted_and_perturbed_modes_are_found_again():
    rng = np.random.default_rng(3)
    shape = np.linalg.qr(rng.normal(size=(60, 8)) + 1j * rng.normal(size=(60, 8)))[0].T
    order = rng.permutation(8)
    noise = 0.02 * (rng.normal(size=shape.shape) + 1j * rng.normal(size=shape.shape))
    match = counterparts(assurance(shape, (shape + noise)[order]))
    assert list(order[match.counterpart]) == list(range(8)) and all(map(match.clear, range(8)))
    size = np.sum(abs(shape + noise) ** 2, axis=1)         # 1 / MAC = |x + e|^2 / |1 + x^H e|^2
    along = abs(1 + np.sum(shape.conj() * noise, axis=1)) ** 2
    np.testing.assert_allclose([match.alike(k)[0] for k in range(8)], along / size, rtol=1e-12)


def test_a_mode_that_became_two_is_ambiguous_and_one_that_is_not_there_too():
    x, y, z = np.eye(3) + 0j
    both = (x + 1j * y) / np.sqrt(2)
    match = counterparts(assurance(np.array([both, z]), np.array([x, y])))
    assert match.alike(0) == pytest.approx((0.5, 0.5)) and not match.clear(0)
    assert not match.clear(1) and match.alike(1)[0] == 0


def test_a_mode_that_another_one_has_is_no_rival():
    near = np.array([[0.95, 0.90], [0.90, 0.97]])
    match = counterparts(near)
    assert list(match.counterpart) == [0, 1] and match.clear(0) and match.clear(1)
    alone = counterparts(near[:1])
    assert alone.counterpart == [0] and alone.rivals == ((1,),) and not alone.clear(0)


def test_fewer_modes_than_before_leave_one_without():
    match = counterparts(np.array([[0.99], [0.3]]))
    assert list(match.counterpart) == [0, -1] and match.clear(0) and not match.clear(1) and match.alike(1) == (0, 0)
    assert list(counterparts(np.empty((2, 0))).counterpart) == [-1, -1]


@pytest.mark.parametrize("other, least", [(72, 1 - 1e-12), (54, 0.99), (144, 0.99)])
def test_shapes_on_other_meshes_are_alike(other, least):
    waves = [2, 3, 5, 6]
    first, second = ring(72, waves), ring(other, waves, phase=0.0 if other == 72 else 0.02)
    points = common_points(first[0], np.full(72, "disc"), second[0], np.full(other, "disc"))
    mac = points.mac(first[1], second[1])
    assert (np.diag(mac) > least).all() and abs(mac - np.diag(np.diag(mac))).max() < 2e-3


def test_a_linear_shape_on_a_plane_is_interpolated_exactly():
    rng = np.random.default_rng(0)
    nodes, points = rng.uniform(size=(400, 3)), rng.uniform(0.2, 0.8, size=(50, 3))
    nodes[:, 2] = points[:, 2] = 0.01
    points = np.vstack((points, [[0.5, 0.5, 3.0]]))         # far away from the others: left out
    made = common_points(points, np.full(51, "pad"), nodes, np.full(400, "pad"))
    assert 50 not in made.index and len(made.index) > 10
    np.testing.assert_allclose(made.weight @ (2 + nodes @ [1.0, -3.0, 0.0]),
                               2 + points[made.index] @ [1.0, -3.0, 0.0], rtol=1e-9)


def test_bodies_that_only_one_model_has_are_left_out():
    position = np.eye(3)
    made = common_points(position, np.array(["disc", "shim", "disc"]), position, np.array(["disc", "pad", "disc"]))
    assert list(made.index) == [0, 2]
