"""How the matrix of a term is written: rows with weights, a whole matrix, or one matrix for each body.

Rows keep the rank of what they stand for, so that a product with a vector, a projection and the part of each row cost
no matrix of all coordinates.
"""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Protocol, Self

import numpy as np
import scipy

Array = np.ndarray
Weight = np.ndarray | float
if TYPE_CHECKING:
    Matrix = np.ndarray | scipy.sparse.sparray | scipy.sparse.spmatrix
else:
    Matrix = Any        # whose module is loaded at its first use


class Form(Protocol):
    """A matrix A (n, n) that is not written out before it is asked for."""

    @property
    def acts(self) -> bool:
        """Whether any weight differs from 0."""
        ...

    def matrix(self) -> Matrix:
        """A (n, n), dense or sparse as what it is made of."""
        ...

    def apply(self, motion: Array) -> Array:
        """A x of motions x, (n,) or (n, m)."""
        ...

    def same(self, other: "Form") -> bool:
        """Whether it is made of the same arrays as the ``other``, with the same weights."""
        ...

    def adjoint(self) -> "Form":
        """A^T, real parts being all that it is made of."""
        ...

    def shares(self, left: Array, right: Array) -> Array:
        """What the rows, coordinates or bodies contribute to y^H A x, for y = ``left`` and x = ``right``, each (n,)."""
        ...


@dataclass(frozen=True)
class Rows:
    """A = sum_i ``left``_i^T ``weight``_i ``right``_i, of rows (r, n), dense or sparse."""

    left: Matrix
    weight: Weight
    right: Matrix

    @property
    def acts(self) -> bool:
        """Whether any weight differs from 0."""
        return bool(self.left.shape[0] and np.any(self.weight))

    def matrix(self) -> Matrix:
        """A (n, n); half the work where both rows are one and no two weights differ in sign."""
        if self.left is not self.right or scipy.sparse.issparse(self.left) or np.iscomplexobj(self.weight):
            return spread(self.left, self.weight, self.right)
        weight = np.broadcast_to(self.weight, len(self.left))
        if np.any(weight < 0) and np.any(weight > 0):
            return spread(self.left, weight, self.right)
        half = np.sqrt(abs(weight))[:, None] * self.left
        return -(half.T @ half) if np.any(weight < 0) else half.T @ half

    def apply(self, motion: Array) -> Array:
        """A x of motions x, (n,) or (n, m)."""
        return self.left.T @ _scaled(self.weight, product(self.right, motion))

    def same(self, other: Form) -> bool:
        """Whether it has the rows and the weights of the ``other``."""
        return (isinstance(other, Rows) and self.left is other.left and self.right is other.right
                and np.array_equal(self.weight, other.weight))

    def adjoint(self) -> Self:
        """A^T."""
        return replace(self, left=self.right, right=self.left)

    def shares(self, left: Array, right: Array) -> Array:
        """(r,) what each row contributes to y^H A x."""
        return product(self.left, left).conj() * self.weight * product(self.right, right)


@dataclass(frozen=True)
class Block:
    """A = diag(``weight``) ``whole``, of a matrix (n, n), dense or sparse; the weight one number, or (n,) one for each
    coordinate."""

    whole: Matrix
    weight: Weight = 1.0

    @property
    def acts(self) -> bool:
        """Whether any weight differs from 0."""
        return bool(np.any(self.weight))

    def matrix(self) -> Matrix:
        """A (n, n); ``whole`` itself where its weight is 1."""
        if np.ndim(self.weight) == 0:
            return self.whole if self.weight == 1 else self.weight * self.whole
        return weighted(self.weight, self.whole)

    def apply(self, motion: Array) -> Array:
        """A x of motions x, (n,) or (n, m)."""
        return _scaled(self.weight, product(self.whole, motion))

    def same(self, other: Form) -> bool:
        """Whether it has the matrix and the weights of the ``other``."""
        return (isinstance(other, Block) and self.whole is other.whole
                and np.array_equal(self.weight, other.weight))

    def adjoint(self) -> Self:
        """A^T of one weight for all."""
        if np.ndim(self.weight):
            raise ValueError("the adjoint of a block asks for one weight")
        return replace(self, whole=self.whole.T)

    def shares(self, left: Array, right: Array) -> Array:
        """(n,) what each coordinate contributes to y^H A x."""
        return np.conj(left) * self.weight * product(self.whole, right)


@dataclass(frozen=True)
class ByBody:
    """A = sum_b ``weight``_b ``part``_b, of matrices (b, n, n) whose sum is ``whole`` (n, n); weights () or (b,)."""

    part: Array
    whole: Array
    weight: Weight

    @property
    def acts(self) -> bool:
        """Whether any weight differs from 0."""
        return bool(np.any(self.weight))

    def matrix(self) -> Array:
        """A (n, n)."""
        weight = np.broadcast_to(self.weight, len(self.part))
        if len(weight) and (weight == weight[0]).all():
            return weight[0] * self.whole
        return np.tensordot(weight, self.part, 1)

    def apply(self, motion: Array) -> Array:
        """A x of motions x, (n,) or (n, m)."""
        return product(self.matrix(), motion)

    def same(self, other: Form) -> bool:
        """Whether it has the matrices and the weights of the ``other``."""
        return isinstance(other, ByBody) and self.part is other.part and np.array_equal(self.weight, other.weight)

    def adjoint(self) -> Self:
        """A^T."""
        return replace(self, part=self.part.transpose(0, 2, 1), whole=self.whole.T)

    def shares(self, left: Array, right: Array) -> Array:
        """(b,) what each body contributes to y^H A x."""
        return np.broadcast_to(self.weight, len(self.part)) * ((self.part @ right) @ np.conj(left))


def spread(left: Matrix, weight: Weight, right: Matrix) -> Matrix:
    """sum_i weight_i left_i^T right_i, (n, n), of rows (r, n), dense or sparse."""
    if scipy.sparse.issparse(left):
        return (left.T @ (scipy.sparse.diags(np.broadcast_to(weight, left.shape[0])) @ right)).tocsr()
    return (left.T * np.broadcast_to(weight, len(left))) @ right


def weighted(weight: Weight, rows: Matrix) -> Matrix:
    """Rows (r, n), dense or sparse, each times its ``weight``, () or (r,)."""
    weight = np.broadcast_to(weight, rows.shape[0])
    return scipy.sparse.diags(weight) @ rows if scipy.sparse.issparse(rows) else weight[:, None] * rows


def product(matrix: Matrix, motion: Array) -> Array:
    """A matrix (r, n) times ``motion``, (n,) or (n, m); a real one is not made complex for complex motions."""
    if scipy.sparse.issparse(matrix) or np.iscomplexobj(matrix) or not np.iscomplexobj(motion):
        return matrix @ motion
    return matrix @ motion.real + 1j * (matrix @ motion.imag)


def _scaled(weight, values):
    """``values`` (r,) or (r, m) times ``weight``, () or (r,)."""
    return np.reshape(weight, (-1, *(1,) * (values.ndim - 1))) * values if np.ndim(weight) else weight * values
