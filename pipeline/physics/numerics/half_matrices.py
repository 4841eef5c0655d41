"""Large sparse matrices, symmetric or skew, of which one half is kept, and their products with a few complex vectors:
memory that is read takes the time, not arithmetic."""

import numpy as np
import scipy

from pipeline.physics.numerics.compiled import njit

#: complex vectors that one pass over a matrix serves
_TOGETHER = 2


class Half:
    """The upper triangle of a sparse A (n, n), real or complex, with A^T = ``sign`` A."""

    def __init__(self, matrix, sign=1):
        matrix = matrix.tocsr()
        number = np.dtype(complex if np.iscomplexobj(matrix) else float)
        parts = np.ascontiguousarray(matrix.data, number).view(float).reshape(matrix.nnz, number.itemsize // 8)
        self._sign, self._indptr = sign, np.zeros(matrix.shape[0] + 1, np.int64)
        size = count_upper(matrix.indptr, matrix.indices, self._indptr)
        self._indices, self._parts = np.empty(size, np.int32), np.empty((parts.shape[1], size))
        take_upper(matrix.indptr, matrix.indices, parts, self._indices, self._parts)

    @property
    def size(self):
        """Number of entries of the triangle."""
        return len(self._indices)

    def upper(self, factor=1):
        """``factor`` times the triangle, sparse by rows, in single precision."""
        part, size = np.empty(self.size, np.complex64), len(self._indptr) - 1
        part.real, part.imag = self._parts[0], self._parts[1] if len(self._parts) > 1 else 0.0
        part *= np.complex64(factor)
        return scipy.sparse.csr_matrix((part, self._indices, self._indptr.astype(np.int32)), (size, size))

    def images(self, vectors):
        """(A x, A^H x), each (n, g), of complex ``vectors`` x (n, g)."""
        count = vectors.shape[1]
        padded = np.zeros((len(vectors), -(-count // _TOGETHER) * _TOGETHER), complex)
        padded[:, :count] = vectors
        real, *imaginary = (self._part(part, padded)[:, :count] for part in self._parts)
        if not imaginary:
            return real, real if self._sign == 1 else -real
        turned = 1j * imaginary[0]
        return real + turned, self._sign * (real - turned)

    def _part(self, part, vectors):
        """The product of one real part of A with ``vectors`` (n, g), in groups."""
        images = np.empty_like(vectors)
        for first in range(0, vectors.shape[1], _TOGETHER):
            group = slice(first, first + _TOGETHER)
            few = np.ascontiguousarray(vectors[:, group])
            image = np.zeros_like(few)
            add_product(self._indptr, self._indices, part, float(self._sign), few.view(float), image.view(float))
            images[:, group] = image
        return images


@njit
def count_upper(indptr, indices, upper):
    """Entries of the upper triangle, whose rows begin at ``upper`` (n + 1,)."""
    for i in range(len(indptr) - 1):
        upper[i + 1] = upper[i]
        for place in range(indptr[i], indptr[i + 1]):
            upper[i + 1] += indices[place] >= i
    return upper[-1]


@njit
def take_upper(indptr, indices, parts, columns, taken):
    """``columns`` (k,) and parts ``taken`` (p, k) of the upper triangle of a matrix with the ``parts`` (nnz, p)."""
    k = 0
    for i in range(len(indptr) - 1):
        for place in range(indptr[i], indptr[i + 1]):
            if indices[place] >= i:
                columns[k] = indices[place]
                for p in range(parts.shape[1]):
                    taken[p, k] = parts[place, p]
                k += 1


@njit
def add_product(indptr, indices, data, sign, vectors, images):
    """Add A x to ``images`` (n, 4), of real ``vectors`` x (n, 4) and the upper triangle of A."""
    for i in range(len(indptr) - 1):
        x, y, z, w = vectors[i, 0], vectors[i, 1], vectors[i, 2], vectors[i, 3]
        a, b, c, d = 0.0, 0.0, 0.0, 0.0
        for place in range(indptr[i], indptr[i + 1]):
            j, value = indices[place], data[place]
            a += value * vectors[j, 0]
            b += value * vectors[j, 1]
            c += value * vectors[j, 2]
            d += value * vectors[j, 3]
            if j != i:
                value *= sign
                images[j, 0] += value * x
                images[j, 1] += value * y
                images[j, 2] += value * z
                images[j, 3] += value * w
        images[i, 0] += a
        images[i, 1] += b
        images[i, 2] += c
        images[i, 3] += d
