"""Large sparse matrices put together from their blocks."""

import numpy as np
import scipy


def on_diagonal(blocks):
    """CSR with the ``blocks`` [(n_k, m_k)], sparse or dense, on its diagonal; row by row, where scipy.sparse.block_diag
    sorts all entries anew."""
    blocks = [scipy.sparse.csr_matrix(block) for block in blocks]
    rows, columns = np.cumsum([(0, 0), *(block.shape for block in blocks)], axis=0).T
    before = np.cumsum([0, *(block.nnz for block in blocks)])
    return scipy.sparse.csr_matrix((
        np.concatenate([block.data for block in blocks]),
        np.concatenate([block.indices + first for block, first in zip(blocks, columns, strict=False)]),
        np.concatenate([[0], *(block.indptr[1:] + first for block, first in zip(blocks, before, strict=False))])),
        shape=(rows[-1], columns[-1]))
