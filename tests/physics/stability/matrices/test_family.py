"""Families of matrices: their factors, and derivatives of roots against differences."""

from dataclasses import replace

import numpy as np
import pytest
import scipy

from pipeline.physics.modal.quadratic_eigenproblem import quadratic_modes
from pipeline.physics.stability.matrices.family import MatrixFamily, Term
from pipeline.physics.stability.matrices.roots import Mode


def family(random, size=6):
    def square(symmetric):
        raw = random.standard_normal((size, size))
        return scipy.sparse.csr_matrix(raw @ raw.T + size * np.eye(size) if symmetric else raw)

    return MatrixFamily((Term("mass", "mass", square(True), ((1.0, 0, 0),)),
                         Term("damping", "damping", 0.02 * square(True), ((1.0, 0, 0),)),
                         Term("gyroscopic", "damping", 0.1 * square(False), ((1.0, 1, 0),)),
                         Term("friction damping", "damping", 0.1 * square(False), ((1.0, -1, 1), (-1.0, 0, 0))),
                         Term("stiffness", "stiffness", 50 * square(True), ((1.0, 0, 0),)),
                         Term("circulatory", "stiffness", 5 * square(False), ((2.0, 0, 1), (0.5, 2, 0))),
                         Term("loss", "loss", 0.5 * square(True), ((1.0, 0, 0),))))


def modes(of, speed, friction):
    found = quadratic_modes(*(m.toarray() for m in of.at(speed, friction)), left=True)
    return [Mode(s, x, y, 0.0) for s, x, y in zip(found.value, found.right.T, found.left.T, strict=True) if s.imag > 0]


def test_matrices_are_the_sums_of_their_terms():
    of = family(np.random.default_rng(0))
    mass, damping, stiffness = of.at(2.0, 0.5)
    parts = {term.name: term.matrix for term in of.terms}
    assert abs(mass - parts["mass"]).max() == 0
    expected = parts["damping"] + 2 * parts["gyroscopic"] - 0.75 * parts["friction damping"]
    assert abs(damping - expected).max() < 1e-12
    assert abs(stiffness.real - parts["stiffness"] - 3 * parts["circulatory"]).max() < 1e-12
    assert abs(stiffness.imag - parts["loss"]).max() < 1e-12
    lossless = MatrixFamily(of.terms[:-1])
    assert all(np.isrealobj(matrix.data) for matrix in lossless.at(2.0, 0.5))


@pytest.mark.exact
def test_derivatives_are_those_of_differences():
    of, speed, friction, step = MatrixFamily(family(np.random.default_rng(1)).terms[:-1]), 1.3, 0.7, 1e-6
    found = modes(of, speed, friction)
    assert len(found) == 6
    for number, mode in enumerate(found):
        per_term, (per_speed, per_friction) = of.derivatives(mode, speed, friction)

        def slope(*both, number=number):
            ahead, behind = (modes(*each)[number].root for each in both)
            return (ahead - behind) / (2 * step)

        near = {"rel": 1e-5, "abs": 1e-6 * abs(mode.root)}
        assert per_speed == pytest.approx(slope((of, speed * (1 + step), friction), (of, speed * (1 - step), friction)),
                                          **near)
        assert per_friction == pytest.approx(slope((of, speed, friction * (1 + step)),
                                                   (of, speed, friction * (1 - step))), **near)
        for k, term in enumerate(of.terms):
            both = [(MatrixFamily((*of.terms[:k], replace(term, matrix=(1 + side * step) * term.matrix),
                                   *of.terms[k + 1:])), speed, friction) for side in (1, -1)]
            assert per_term[k] == pytest.approx(slope(*both), **near)


@pytest.mark.exact
def test_derivative_to_a_loss():
    """m s^2 + k + i h = 0, so that ds / d ln h = -i h / (2 m s)."""
    mass, stiffness, loss = 2.0, 5e5, 3e4
    one = scipy.sparse.eye_array(1, format="csr")
    of = MatrixFamily(tuple(Term(kind, kind, value * one, ((1.0, 0, 0),)) for kind, value in
                            (("mass", mass), ("stiffness", stiffness), ("loss", loss))))
    root = 1j * np.sqrt((stiffness + 1j * loss) / mass)
    per_term, _ = of.derivatives(Mode(root, np.ones(1), np.ones(1), 0.0), 1.0, 1.0)
    assert per_term[2] == pytest.approx(-1j * loss / (2 * mass * root))
