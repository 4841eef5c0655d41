"""Parts that operating points share against the matrices of each of them."""

from dataclasses import replace

import numpy as np
import pytest
import scipy

from pipeline.physics.sliding.model import Contacts, FrictionState, Joints, SlidingModel
from pipeline.physics.sliding.shared_operator import SharedOperator, SlidingPoint, Subspace

pytestmark = pytest.mark.exact
SIZE, CONTACTS, ROOT = 12, 3, 20.0 + 300.0j
FRICTION = FrictionState(np.array([0.4, 0.5, 0.6]), np.array([1e-3, 0.0, 2e-3]), np.array([-0.1, 0.0, 0.2]))


def sparse(values):
    return scipy.sparse.csr_matrix(values)


def symmetric(random):
    half = random.standard_normal((SIZE, SIZE))
    return half + half.T


@pytest.fixture(scope="module")
def model():
    """Every term of a SlidingModel is there, and none is small."""
    random = np.random.default_rng(0)
    normal, tangent, lateral = (sparse(random.standard_normal((CONTACTS, SIZE))) for _ in range(3))
    half, each = random.standard_normal((SIZE, SIZE)), np.arange(1.0, CONTACTS + 1)
    contacts = Contacts(normal, tangent, lateral, np.zeros((CONTACTS, 3)), each, 0.1 * each, 50 * each, 2e4 * each,
                        30 * each)
    joints = Joints(("pin",), sparse(random.standard_normal((1, SIZE))), np.array([4e3 + 50j]), np.array([7.0]))
    stiffness = 1e5 * np.eye(SIZE) + 1e3 * (symmetric(random) + 0.1j * symmetric(random))
    return SlidingModel(("body",), np.zeros(SIZE, int), sparse(10 * np.eye(SIZE) + symmetric(random)),
                        sparse(symmetric(random)), sparse(half - half.T), sparse(stiffness), sparse(symmetric(random)),
                        joints, contacts, (), normal[:0], (), normal[:0], 9.0)


def dense(model, root, friction=FRICTION):
    mass, damping, stiffness = (part.toarray() for part in model.linearised(friction))
    return root**2 * mass + root * damping + stiffness, stiffness


@pytest.fixture(scope="module", params=[9.0, -5.0])
def point(request, model):
    """The model at a speed, and its SlidingPoint."""
    there = model.at_speed(request.param)
    return there, SlidingPoint.of(there, FRICTION)


def test_forces_are_those_of_the_linearised_matrices(model, point):
    """Of two motions at once, at different points and roots."""
    vectors, other = np.random.default_rng(1).standard_normal((SIZE, 2)) * (1 + 0.3j), model.at_speed(2.0)
    points, roots = [point[1], SlidingPoint.of(other, 0.1)], np.array([ROOT, -2 * ROOT])
    missed, elastic = SharedOperator.of(model).forces(points, roots, vectors)
    for k, (there, friction) in enumerate(((point[0], FRICTION), (other, 0.1))):
        whole, stiffness = dense(there, roots[k], friction)
        np.testing.assert_allclose(missed[:, k], whole @ vectors[:, k], rtol=1e-12)
        np.testing.assert_allclose(elastic[:, k], stiffness @ vectors[:, k], rtol=1e-12)


def test_the_symmetric_part_and_what_friction_draws_beside_it_are_all_that_does_not_turn(model, point):
    there, at = point
    operator = SharedOperator.of(model)
    part = operator.symmetric(at, ROOT).whole().toarray()
    vector = np.random.default_rng(2).standard_normal(SIZE)
    drawn = operator.drawn(at, ROOT, operator.rows @ vector)
    still = dense(replace(there, gyroscopic=0 * there.gyroscopic, centrifugal=0 * there.centrifugal), ROOT)[0]
    np.testing.assert_allclose(part @ vector + drawn, still @ vector, rtol=1e-6)


def test_the_symmetric_part_has_entries_at_the_same_places_where_contacts_are_open(model):
    point, operator = SlidingPoint.of(model, FRICTION), SharedOperator.of(model)
    closed = operator.symmetric(point, ROOT).part
    opened = operator.symmetric(replace(point, by_place=0 * point.by_place, by_speed=0 * point.by_speed), ROOT).part
    np.testing.assert_array_equal(closed.indices, opened.indices)
    np.testing.assert_array_equal(closed.indptr, opened.indptr)


def test_a_subspace_of_all_motions_has_the_matrices_of_the_model(model, point):
    """Of vectors that are there already, it takes the other parts alone."""
    random = np.random.default_rng(3)
    space, given = Subspace(SharedOperator.of(model), SIZE), random.standard_normal((SIZE, SIZE)) * (1 + 0.5j)
    for k, count in ((0, 5), (5, SIZE - 1), (3, 4), (SIZE - 1, SIZE)):
        space.add(given[:, k:count] + random.standard_normal() * 1j * given[:, :1])
    assert len(space) == SIZE and space.room == 0
    basis = space.vectors(np.eye(SIZE))
    np.testing.assert_allclose(basis.conj().T @ basis, np.eye(SIZE), atol=1e-12)
    for ours, exact in zip(space.matrices(point[1]), point[0].linearised(FRICTION), strict=True):
        np.testing.assert_allclose(ours, basis.conj().T @ exact @ basis, rtol=1e-10, atol=1e-8)
    contacts = model.contacts
    rows = scipy.sparse.vstack((contacts.normal, contacts.tangent, contacts.lateral))
    np.testing.assert_allclose(space.motion(np.ones(SIZE)), rows @ basis.sum(axis=1), rtol=1e-11)


def test_without_gyroscopic_and_centrifugal_terms(model, point):
    vector, there = np.ones((SIZE, 1), complex), point[0]
    bare = replace(there, gyroscopic=0 * there.gyroscopic, centrifugal=0 * there.centrifugal)
    operator = SharedOperator.of(model, gyroscopic=False, centrifugal=False)
    missed, _ = operator.forces([point[1]], np.array([ROOT]), vector)
    np.testing.assert_allclose(missed, dense(bare, ROOT)[0] @ vector, rtol=1e-12)
