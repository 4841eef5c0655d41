"""Roots on full matrices against dense algebra: families of one subspace, and what is not there."""

from dataclasses import replace

import numpy as np
import pytest
import scipy

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.numerics.sparse_solver import Successive
from pipeline.physics.sliding.model import Contacts, Joints, SlidingModel
from pipeline.physics.sliding.shared_operator import SharedOperator, SlidingPoint
from pipeline.physics.stability import full_roots as module
from pipeline.physics.stability.full_roots import Guess, families, full_roots, sliding_as

pytestmark = pytest.mark.exact
SIZE, CONTACTS = 120, 12
FRICTION = (0.50, 0.51, 0.52)


@pytest.fixture(scope="module")
def full():
    """A chain of masses with a loss factor; friction of every third of the first ones turns its neighbour by an arm."""
    chain = scipy.sparse.diags([-1.0, 2.05, -1.0], [-1, 0, 1], shape=(SIZE, SIZE), format="csr")
    normal, tangent = (scipy.sparse.csr_matrix((np.full(CONTACTS, arm), (range(CONTACTS), 3 * np.arange(CONTACTS) + k)),
                                               (CONTACTS, SIZE)) for k, arm in ((0, 1.0), (1, 10.0)))
    zero = scipy.sparse.csr_matrix((SIZE, SIZE))
    each = np.ones(CONTACTS)
    contacts = Contacts(normal, tangent, 0 * normal, np.zeros((CONTACTS, 3)), each, each, 100 * each, 3e5 * each,
                        0.5 * each)
    joints = Joints((), scipy.sparse.csr_matrix((0, SIZE)), np.empty(0), np.empty(0))
    return SlidingModel(("chain",), np.zeros(SIZE, int), scipy.sparse.identity(SIZE, format="csr"), zero, zero,
                        1e6 * (1 + 0.002j) * chain, zero, joints, contacts, (), normal[:0], (), normal[:0], 1.0)


def matrices(model, friction):
    return model.linearised(friction, friction_damping=False)


def dense_modes(mass, damping, stiffness):
    """Roots and vectors of the companion matrix; unit masses."""
    zero, one = np.zeros((SIZE, SIZE)), np.eye(SIZE)
    root, vector = np.linalg.eig(np.block([[zero, one], [-stiffness.toarray(), -damping.toarray()]]))
    return root, vector[:SIZE]


@pytest.fixture(scope="module")
def growing(full):
    """(root, contact motion) of the mode with the largest growth rate, and of the same one with more friction."""
    modes = [dense_modes(*matrices(full, mu)) for mu in FRICTION]
    first = max((r for r in modes[0][0] if r.imag > 0), key=lambda r: r.real)
    assert first.real > 10.0
    contacts = full.contacts
    rows = scipy.sparse.vstack((contacts.normal, contacts.tangent, contacts.lateral))
    motions = [rows @ vector for _, vector in modes]
    before, followed = motions[0][:, modes[0][0] == first][:, 0], []
    for (roots, _), motion in zip(modes, motions, strict=True):
        alike = abs(before.conj() @ motion) / np.linalg.norm(motion, axis=0)
        k = np.argmax(alike / (1 + abs(roots - first)))
        followed.append((roots[k], motion[:, k]))
    return followed


def guessed(full, growing, error=1e-4):
    """Guesses whose roots and motions are a little wrong."""
    random = np.random.default_rng(0)
    return [Guess(root * (1 + error), motion * (1 + 0.05 * random.standard_normal(len(motion))), point(full, mu))
            for (root, motion), mu in zip(growing, FRICTION, strict=True)]


def point(full, friction):
    return SlidingPoint.of(full, friction, friction_damping=False)


class Counted(Successive):
    """Counts the factors that are made."""

    def __init__(self):
        super().__init__("superlu")
        self.made = 0

    def factor(self, matrix):
        self.made += 1
        return super().factor(matrix)


def test_roots_of_a_family_are_those_of_dense_algebra(full, growing):
    """One factor serves operating points with different friction."""
    factors = Counted()
    solved = full_roots(guessed(full, growing), SharedOperator.of(full), factors, 1e-9)
    np.testing.assert_allclose([mode.root for mode in solved], [root for root, _ in growing], rtol=1e-9)
    assert factors.made == 1
    for mode, mu in zip(solved, FRICTION, strict=True):
        mass, damping, stiffness = matrices(full, mu)
        force = stiffness @ mode.vector
        missed = mode.root**2 * (mass @ mode.vector) + mode.root * (damping @ mode.vector) + force
        assert mode.residual == pytest.approx(np.linalg.norm(missed) / np.linalg.norm(force), rel=1e-3)
        assert mode.residual <= 1e-9 and mode.likeness > 0.95


def test_a_root_that_finds_no_room_beside_the_others_gets_a_factor_of_its_own(full, growing, monkeypatch):
    monkeypatch.setattr(module, "_MOST", 20)
    factors = Counted()
    solved = full_roots(guessed(full, growing), SharedOperator.of(full), factors, 1e-9)
    np.testing.assert_allclose([mode.root for mode in solved], [root for root, _ in growing], rtol=1e-9)
    assert 1 < factors.made <= 1 + len(FRICTION)


@pytest.mark.parametrize("wrong", ["root", "motion"])
def test_a_guess_far_from_every_root_is_refused(full, growing, wrong):
    guess = guessed(full, growing)[0]
    far = {"root": 3 * guess.root, "motion": np.roll(guess.motion, 5) * (-1) ** np.arange(len(guess.motion))}[wrong]
    with pytest.raises(ConvergenceError, match="full finite-element matrices: expected the mode of the reduced model"):
        full_roots([replace(guess, **{wrong: far})], SharedOperator.of(full), Successive("superlu"), 1e-9)


def test_families_are_of_one_state_and_nearly_one_frequency_from_the_middle_out():
    roots = 10 + 1j * np.array([1000.0, 1003.0, 1500.0, 1015.0, 1502.0, 1007.0, 1021.0, 1002.0])
    state = np.array([0, 0, 0, 0, 0, 0, 0, 1])
    assert [group.tolist() for group in families(roots, state)] == [[1, 3, 0, 5], [6], [2, 4], [7]]


def test_the_full_model_slides_as_the_reduced_one(full):
    basis = np.linalg.qr(np.random.default_rng(1).standard_normal((SIZE, 20)))[0]
    contacts = replace(full.contacts, normal=full.contacts.normal @ basis, stiffness=np.arange(1.0, CONTACTS + 1))
    reduced = replace(full, contacts=contacts, speed=7.0)
    about = sliding_as(full, reduced)
    assert about.speed == 7.0 and about.contacts.stiffness[-1] == CONTACTS
    assert about.contacts.normal is full.contacts.normal and about.mass is full.mass
