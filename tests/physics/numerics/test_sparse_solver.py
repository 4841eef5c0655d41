"""Both solvers against one another, dense algebra and inertia; singular matrices are refused."""

import numpy as np
import pytest
import scipy.sparse as sp

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.numerics import memory
from pipeline.physics.numerics.sparse_solver import Successive, Upper, available, factorise

pytestmark = pytest.mark.exact


def laplacian(side=8):
    line = sp.diags([-1.0, 2.0, -1.0], [-1, 0, 1], shape=(side, side))
    one = sp.identity(side)
    plane = sp.kron(line, one) + sp.kron(one, line)
    return (sp.kron(plane, one) + sp.kron(sp.kron(one, one), line)).tocsr()


@pytest.fixture(params=available())
def solver(request):
    return request.param


@pytest.mark.parametrize("shift", [0.0, 1.03])
def test_symmetric_indefinite_and_its_inertia(solver, shift):
    matrix = laplacian() - shift * sp.identity(512)
    rhs = np.random.default_rng(0).standard_normal((512, 3))
    factor = factorise(matrix, solver)
    assert np.allclose(factor.solve(rhs), np.linalg.solve(matrix.toarray(), rhs), rtol=1e-9, atol=1e-9)
    assert np.array_equal(factor.solve(rhs[:, 0]).shape, (512,))
    assert factor.negative == (np.linalg.eigvalsh(matrix.toarray()) < 0).sum()


def test_unsymmetric_and_complex(solver):
    random = np.random.default_rng(1)
    matrix = laplacian() + sp.random(512, 512, 0.01, random_state=2)
    rhs = random.standard_normal(512) + 1j * random.standard_normal(512)
    for a, symmetric in ((matrix, False), (laplacian() + 0.3j * sp.identity(512), True), (matrix * (1 + 0.1j), False)):
        factor = factorise(a, solver, symmetric)
        for operator, adjoint in ((a, False), (a.conj().T, True), (a, False)):
            assert np.linalg.norm(operator @ factor.solve(rhs, adjoint) - rhs) < 1e-10 * np.linalg.norm(rhs)


def test_single_precision_holds_its_digits_and_no_more(solver):
    rhs = np.random.default_rng(1).standard_normal((512, 2)) * (1 + 0.5j)
    for a, symmetric in ((laplacian() + 0.3j * sp.identity(512), True), (laplacian() * (1 + 0.1j), False)):
        factor = factorise(a, solver, symmetric, single=True)
        missed = np.linalg.norm(a @ factor.solve(rhs) - rhs) / np.linalg.norm(rhs)
        assert 1e-10 < missed < 1e-4 and factor.negative is None


@pytest.mark.parametrize("turn", [0, 7], ids=["by its diagonal", "by matched rows"])
def test_single_precision_solves_unsymmetric_matrices_whatever_their_diagonal(solver, turn):
    matrix = (laplacian() + sp.random(512, 512, 0.01, random_state=2)).tocsr()[np.roll(np.arange(512), turn)]
    rhs = np.random.default_rng(1).standard_normal(512)
    missed = matrix @ factorise(matrix, solver, symmetric=False, single=True).solve(rhs) - rhs
    assert np.linalg.norm(missed) < 1e-2 * np.linalg.norm(rhs)


@pytest.mark.parametrize("single", [False, True])
def test_the_upper_triangle_alone_says_all_of_a_symmetric_matrix(solver, single):
    """Complex, with a diagonal entry that is not stored; then of others with entries at the same places, and not."""
    body, row = laplacian(4) + 0.1j * sp.identity(64), np.ones((1, 64))
    matrix, rhs = sp.block_array([[None, row], [row.T, body]], format="csr"), np.arange(1.0, 66.0) + 1j
    upper, near = Upper(sp.triu(matrix, format="csr")), {"rtol": 1e-3 if single else 1e-10}
    np.testing.assert_array_equal(upper.whole().toarray(), matrix.toarray())
    np.testing.assert_allclose(upper @ rhs, matrix @ rhs, rtol=1e-14)
    expected = np.linalg.solve(matrix.toarray(), rhs)
    np.testing.assert_allclose(factorise(upper, solver, single=single).solve(rhs), expected, **near)
    if single:
        successive = Successive(solver)
        for factor in (1, 2, 3j):
            found = successive.factor(Upper(factor * upper.part)).solve(rhs)
            np.testing.assert_allclose(found, expected / factor, **near)
        other = laplacian(4) + 1j * sp.identity(64) + sp.diags([1.0, 1.0], [40, -40], shape=(64, 64))
        found = successive.factor(Upper(sp.triu(other, format="csr"))).solve(rhs[1:])   # with entries at other places
        np.testing.assert_allclose(found, np.linalg.solve(other.toarray(), rhs[1:]), **near)


def test_saddle_point_with_empty_diagonal(solver):
    matrix = sp.bmat([[sp.identity(3), np.ones((3, 1))], [np.ones((1, 3)), None]])
    rhs = np.arange(4.0)
    assert np.allclose(factorise(matrix, solver).solve(rhs), np.linalg.solve(matrix.toarray(), rhs))


@pytest.mark.parametrize("broken", ["floating", "empty row", "not finite"])
def test_singular_matrix_is_refused(solver, broken):
    matrix = laplacian()
    if broken == "floating":
        matrix = matrix - sp.diags(np.asarray(matrix.sum(axis=1)).ravel())
    elif broken == "empty row":
        matrix = sp.diags(np.r_[1.0, 0.0, 1.0]).tocsr()
        matrix.eliminate_zeros()
    else:
        matrix.data[3] = np.nan
    with pytest.raises(ConvergenceError, match="factorisation"):
        factorise(matrix, solver)


def test_unknown_solver():
    with pytest.raises(ConfigError, match="superlu"):
        factorise(laplacian(), "abacus")


def test_a_factor_beyond_the_memory_is_refused_before_it_is_computed(monkeypatch):
    if "pypardiso" not in available():
        pytest.skip("PARDISO alone knows what its factor needs")
    monkeypatch.setattr(memory, "available_memory", lambda: 1000)
    with pytest.raises(ConfigError, match="a factor of 512 degrees of freedom"):
        factorise(laplacian(), "pypardiso")
