"""Forms of a term: each against the matrix that it stands for."""

import numpy as np
import pytest
import scipy

from pipeline.physics.system.forms import Block, ByBody, Rows, product, spread, weighted


def _random(*shape):
    return np.random.default_rng(sum(shape)).normal(size=shape)


def _forms():
    rows, others, whole = _random(4, 7), _random(4, 7)[::-1], _random(7, 7)
    parts = np.array([np.where(np.arange(7)[:, None] < 3, whole, 0.0), np.where(np.arange(7)[:, None] < 3, 0.0, whole)])
    return {
        "rows": (Rows(rows, np.array([1.0, -2.0, 0.0, 3.0]), others), rows.T @ np.diag([1.0, -2.0, 0.0, 3.0]) @ others),
        "squares": (Rows(rows, np.arange(4.0), rows), rows.T @ np.diag(np.arange(4.0)) @ rows),
        "negative squares": (Rows(rows, -np.arange(4.0), rows), -rows.T @ np.diag(np.arange(4.0)) @ rows),
        "mixed squares": (Rows(rows, np.array([1.0, -1.0, 2.0, 0.0]), rows),
                          rows.T @ np.diag([1.0, -1.0, 2.0, 0.0]) @ rows),
        "complex squares": (Rows(rows, 1j * np.arange(4.0), rows), 1j * rows.T @ np.diag(np.arange(4.0)) @ rows),
        "block": (Block(whole, 3.0), 3.0 * whole),
        "block by coordinate": (Block(whole, np.arange(7.0)), np.diag(np.arange(7.0)) @ whole),
        "bodies": (ByBody(parts, whole, np.array([2.0, 5.0])), 2.0 * parts[0] + 5.0 * parts[1]),
        "one for all bodies": (ByBody(parts, whole, 2.0), 2.0 * whole)}


@pytest.mark.exact
@pytest.mark.parametrize("name", list(_forms()))
def test_a_form_is_its_matrix(name):
    form, expected = _forms()[name]
    x, y, basis = _random(7) + 1j * _random(7)[::-1], _random(7) - 2j, _random(7, 3)
    assert form.acts
    np.testing.assert_allclose(form.matrix(), expected, rtol=0, atol=1e-13)
    np.testing.assert_allclose(form.apply(x), expected @ x, rtol=0, atol=1e-12)
    np.testing.assert_allclose(form.apply(basis), expected @ basis, rtol=0, atol=1e-12)
    np.testing.assert_allclose(form.shares(y, x).sum(), y.conj() @ expected @ x, rtol=1e-12)
    if name != "block by coordinate":
        np.testing.assert_allclose(form.adjoint().apply(x), expected.T @ x, rtol=0, atol=1e-12)


def test_sparse_rows_stay_sparse():
    rows = scipy.sparse.csr_matrix(_random(4, 7))
    found = Rows(rows, np.arange(4.0), rows)
    assert scipy.sparse.issparse(found.matrix()) and scipy.sparse.issparse(weighted(2.0, rows))
    np.testing.assert_allclose(found.matrix().toarray(), spread(rows.toarray(), np.arange(4.0), rows.toarray()))
    np.testing.assert_allclose(found.apply(np.ones(7) + 1j), found.matrix() @ (np.ones(7) + 1j))


def test_products_with_complex_motions():
    matrix, motion = _random(4, 7), _random(7, 2) + 1j * _random(7, 2)[::-1]
    np.testing.assert_allclose(product(matrix, motion), matrix @ motion)


def test_nothing_acts_without_weights_or_rows():
    assert not Rows(_random(4, 7), 0.0, _random(4, 7)).acts and not Block(_random(7, 7), 0.0).acts
    assert not Rows(np.empty((0, 7)), np.empty(0), np.empty((0, 7))).acts and not ByBody(_random(2, 7, 7), 0, 0.0).acts


def test_weights_by_coordinate_have_no_adjoint_block():
    with pytest.raises(ValueError, match="one weight"):
        Block(_random(7, 7), np.arange(7.0)).adjoint()
