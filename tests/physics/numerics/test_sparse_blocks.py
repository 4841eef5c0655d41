"""Blocks on a diagonal, beside scipy's."""

import numpy as np
import pytest
import scipy

from pipeline.physics.numerics.sparse_blocks import on_diagonal


@pytest.mark.parametrize("kind", [float, complex])
def test_blocks_stand_where_scipy_puts_them(kind):
    rng = np.random.default_rng(2)
    blocks = [scipy.sparse.random(*shape, 0.4, "csr", rng=rng).astype(kind) * (1 + 1j if kind is complex else 1)
              for shape in ((3, 5), (0, 2), (4, 4))] + [np.diag([0.0, 2.0])]
    made, theirs = on_diagonal(blocks), scipy.sparse.block_diag(blocks, "csr")
    assert made.format == "csr" and made.dtype == theirs.dtype == kind
    np.testing.assert_array_equal(made.toarray(), theirs.toarray())
