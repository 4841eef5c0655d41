"""A system as the sum of its terms: matrices, products, slopes over s, shares, transposition, memory."""

import numpy as np
import pytest
import scipy

from pipeline.physics.sliding.model import FrictionState
from pipeline.physics.stability.linearisation import Settling
from pipeline.physics.system.system import System, runs
from pipeline.physics.system.terms import Kind, Term, What
from tests.physics.sliding.test_model import scattered

ROOT = 3.0 + 40.0j


def sliding():
    """A System with friction and a loss, and memory beside it."""
    random = np.random.default_rng(3)
    memory = Settling(*(random.normal(size=shape) for shape in ((12, 2), (2, 12), (2, 12))), np.array([5.0, 50.0]))
    system = scattered().system(FrictionState(0.4, 1e-3, -0.02))
    return System((*system.terms, Term.whole("loss", "loss", random.normal(size=(12, 12)))), system.body, memory)


def matrix(system, s):
    mass, damping, stiffness = system.matrices()
    return s**2 * mass + s * damping + stiffness - system.beside.answers(s)[0]


@pytest.mark.exact
def test_products_and_slopes_are_those_of_the_matrices():
    system, x = sliding(), np.random.default_rng(1).normal(size=12) + 1j
    np.testing.assert_allclose(system.apply(ROOT, x), matrix(system, ROOT) @ x, rtol=0, atol=1e-10)
    slope = (matrix(system, ROOT + 1e-4) - matrix(system, ROOT - 1e-4)) @ x / 2e-4
    np.testing.assert_allclose(system.slope(ROOT, x), slope, rtol=0, atol=1e-6 * abs(slope).max())


@pytest.mark.exact
def test_shares_add_up_and_the_adjoint_is_the_transpose():
    system, x = sliding(), np.random.default_rng(1).normal(size=12) + 1j
    system = system.where(lambda term: True)
    total = sum((term.kind.factor(ROOT) * term.form.shares(x, x)).sum() for term in system.terms)
    np.testing.assert_allclose(total, x.conj() @ system.apply(ROOT, x), rtol=1e-12)
    for found, given in zip(system.adjoint().matrices(), system.matrices(), strict=True):
        np.testing.assert_allclose(found, given.T, rtol=0, atol=1e-12 * abs(given).max())


def test_a_part_of_the_terms_and_more_of_them():
    system = sliding()
    drawn = system.where(lambda term: term.name == What.CIRCULATORY)
    assert [term.name for term in drawn.terms] == ["circulatory"] and drawn.beside is None
    twice = drawn.and_(drawn.terms)
    np.testing.assert_allclose(twice.matrix(Kind.STIFFNESS), 2 * drawn.matrix(Kind.STIFFNESS), rtol=1e-14)
    x = np.ones((12, 2))
    np.testing.assert_allclose(twice.of_kind(Kind.STIFFNESS, x), twice.matrix(Kind.STIFFNESS) @ x)
    assert not twice.of_kind(Kind.MASS, x).any() and not twice.matrix(Kind.MASS).any()


def test_what_is_not_there_is_empty_and_sparse_where_the_rest_is():
    none = System((Term.whole("k", "stiffness", scipy.sparse.identity(3, format="csr")),), np.zeros(3, int))
    assert none.matrix(Kind.MASS).nnz == 0 and none.matrix(Kind.STIFFNESS).nnz == 3
    assert runs(np.repeat([0, 1], 20)) == [slice(0, 20), slice(20, 40)]
