"""Roots of a draw without common bases, beside a direct solution of all coordinates."""

import numpy as np
import pytest
import scipy

from pipeline.physics.sliding.equilibrium import closure_response, model_about, steady_sliding
from pipeline.physics.stability.scatter import NOMINAL
from pipeline.physics.stability.whole_roots import whole_roots
from tests.physics.stability.scattered_block import draws, family


@pytest.mark.exact
@pytest.mark.parametrize("factors", [NOMINAL, *draws(2, 12)])
def test_roots_are_those_of_all_coordinates(factors):
    drawn = family().varied(factors)
    state = steady_sliding(drawn.model, closure_response(drawn.model), drawn.input_force, drawn.law_closure,
                           drawn.law_pressure, drawn.friction)
    mass, damping, stiffness = model_about(drawn.model, state.contact, drawn.damping_speed).linearised(state.friction)
    size, inverse = len(mass), np.linalg.inv(mass)
    stiffness = stiffness + 1j * drawn.imaginary_stiffness()
    companion = np.block([[np.zeros((size, size)), np.eye(size)], [-inverse @ stiffness, -inverse @ damping]])
    direct = scipy.linalg.eigvals(companion)
    roots = whole_roots(family(), factors, 2.0, 20e3)
    growing = direct[(direct.imag > abs(direct.real)) & (direct.real > 1.0) & (abs(direct) < 2 * np.pi * 20e3)]
    assert len(growing) or factors is not NOMINAL
    assert len(growing) == np.sum(roots.real > 1.0)
    for root in growing:
        assert abs(roots - root).min() < 1e-5 * abs(root)
