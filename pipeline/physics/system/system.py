"""A system as the sum of its terms: its matrices, products with motions, shares of its terms, projections."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Protocol, Self

import numpy as np
import scipy

from pipeline.physics.system.forms import Array, Matrix, Rows, spread, weighted
from pipeline.physics.system.terms import Kind, Term

#: coordinates of a body, on average, from which on matrices are worked on body by body
_SHORT = 20


class Memory(Protocol):
    """What settles beside a motion, and pushes it: F(s) x is subtracted from T(s) x."""

    def answers(self, s: complex, x: Array | None = None) -> tuple[Array, Array | None]:
        """(F(s) x, F'(s) x), each (n,), at ``s`` 1/s; without ``x`` (F(s) (n, n), None)."""
        ...


@dataclass(frozen=True)
class System:
    """The sum of ``terms`` in as many coordinates as ``body`` (n,) has, which says whose each is; ``beside`` a Memory,
    or None."""

    terms: tuple[Term, ...]
    body: Array
    beside: Memory | None = None

    @property
    def size(self) -> int:
        """Number of coordinates n."""
        return len(self.body)

    def where(self, chosen: Callable[[Term], bool]) -> Self:
        """The sum of those terms alone that are ``chosen``, without memory."""
        return replace(self, terms=tuple(filter(chosen, self.terms)), beside=None)

    def and_(self, terms: Iterable[Term]) -> Self:
        """The same with more ``terms``."""
        return replace(self, terms=(*self.terms, *terms))

    def matrices(self) -> tuple[Matrix, Matrix, Matrix]:
        """(M, C, K), each (n, n), without memory; losses are the imaginary part of K."""
        stiffness, lossy = self.matrix(Kind.STIFFNESS), [t for t in self.terms if t.kind is Kind.LOSS and t.form.acts]
        if lossy:
            stiffness = stiffness + 1j * self.matrix(Kind.LOSS)
        return self.matrix(Kind.MASS), self.matrix(Kind.DAMPING), stiffness

    def matrix(self, kind: Kind) -> Matrix:
        """Sum (n, n) of the terms of a Kind; rows onto the same ones are added before they are multiplied out."""
        parts, rows = [], {}
        for form in (term.form for term in self.terms if term.kind is kind and term.form.acts):
            if isinstance(form, Rows):
                rows.setdefault(id(form.right), []).append(form)
            else:
                parts.append(form.matrix())
        blocks = runs(self.body)
        parts += [_spread(forms, blocks) for forms in rows.values()]
        return _total(parts, self.size, any(_sparse(term.form) for term in self.terms))

    def apply(self, s: complex, motion: Array) -> Array:
        """T(``s``) x (n,) of a motion x, memory included."""
        found = np.zeros(np.shape(motion), complex)
        for term in self.terms:
            if term.form.acts:
                found += term.kind.factor(s) * term.form.apply(motion)
        return found if self.beside is None else found - self.beside.answers(s, motion)[0]

    def slope(self, s: complex, motion: Array) -> Array:
        """T'(``s``) x (n,) of a motion x, memory included."""
        found = np.zeros(np.shape(motion), complex)
        for term in self.terms:
            if term.kind.order and term.form.acts:
                found += term.kind.order * s ** (term.kind.order - 1) * term.form.apply(motion)
        return found if self.beside is None else found - self.beside.answers(s, motion)[1]

    def beyond(self, other: Self, s: complex, motion: Array) -> Array:
        """T(``s``) x less that of an ``other`` system of the same terms, memory included; terms that are the same in
        both are not applied."""
        found = np.zeros(np.shape(motion), complex)
        for term, before in zip(self.terms, other.terms, strict=True):
            if not term.form.same(before.form):
                found += term.kind.factor(s) * (term.form.apply(motion) - before.form.apply(motion))
        for memory, sign in ((self.beside, -1.0), (other.beside, 1.0)):
            if memory is not None:
                found += sign * memory.answers(s, motion)[0]
        return found

    def of_kind(self, kind: Kind, motion: Array) -> Array:
        """Sum of the terms of a Kind times ``motion``, (n,) or (n, m)."""
        parts = [term.form.apply(motion) for term in self.terms if term.kind is kind and term.form.acts]
        return sum(parts[1:], parts[0]) if parts else np.zeros_like(motion)

    def adjoint(self) -> Self:
        """The transposed system, without memory."""
        return replace(self, terms=tuple(replace(t, form=t.form.adjoint()) for t in self.terms), beside=None)


def runs(body: Array) -> list[slice]:
    """Slices of coordinates that follow each other on one ``body`` (n,); one of all where they would be short."""
    ends = [0, *(np.flatnonzero(np.diff(body)) + 1), len(body)]
    if len(body) < _SHORT * (len(ends) - 1):
        return [slice(0, len(body))]
    return [slice(int(first), int(last)) for first, last in pairwise(ends) if last > first]


def _spread(forms: list[Rows], parts: list[slice]) -> Matrix:
    """Sum (n, n) of Rows with one ``right``, body by body, as most rows move two of them alone."""
    form = forms[0]
    if len(forms) > 1:
        left = [weighted(each.weight, each.left) for each in forms]
        form = Rows(sum(left[1:], left[0]), 1.0, form.right)
    if scipy.sparse.issparse(form.left) or len(parts) == 1:
        return form.matrix()
    weight = np.broadcast_to(form.weight, len(form.left))
    onto, of = ([(weight != 0) & rows[:, part].any(axis=1) for part in parts] for rows in (form.left, form.right))
    out = np.zeros((form.left.shape[1], form.right.shape[1]), np.result_type(form.left, weight, form.right))
    for a, left_acts in zip(parts, onto, strict=True):
        for b, right_acts in zip(parts, of, strict=True):
            both = np.flatnonzero(left_acts & right_acts)
            if len(both):
                out[a, b] = spread(form.left[both, a], weight[both], form.right[both, b])
    return out


def _sparse(form) -> bool:
    return scipy.sparse.issparse(form.left if isinstance(form, Rows) else form.whole)


def _total(parts: list, size: int, sparse: bool) -> Matrix:
    """Sum of matrices (n, n); of sparse ones the emptiest first, so that large ones are copied once."""
    if not parts:
        return scipy.sparse.csr_matrix((size, size)) if sparse else np.zeros((size, size))
    if len(parts) == 1:
        return parts[0]
    if scipy.sparse.issparse(parts[0]):
        parts = sorted(parts, key=lambda part: part.nnz)
        return sum(parts[1:], parts[0])
    whole = np.array(parts[0], np.result_type(*parts))
    for part in parts[1:]:
        whole += part
    return whole
