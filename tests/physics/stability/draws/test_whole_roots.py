"""Roots of a draw without common bases, beside a direct solution of all coordinates."""

from types import SimpleNamespace

import numpy as np
import pytest
import scipy

from pipeline.physics.sliding.equilibrium import closure_response, model_about, steady_sliding
from pipeline.physics.stability.draws.scatter import NOMINAL
from pipeline.physics.stability.draws.whole_roots import accuracy, beside_whole, whole_roots
from tests.physics.stability.draws.scattered_block import draws, family


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


def test_roots_beside_those_of_the_whole_model_and_those_that_only_one_has():
    whole = whole_roots(family(), NOMINAL, 2.0, 20e3)
    growing = whole[whole.real > 10]
    assert len(growing)
    alike = SimpleNamespace(family=family(), roots=lambda factors, speed: whole)
    roots, same, missed = beside_whole(alike, NOMINAL, 2.0, 20e3)
    np.testing.assert_array_equal(roots, same)
    assert missed == 0 and set(growing) <= set(roots)
    without = SimpleNamespace(family=family(), roots=lambda factors, speed: whole[whole.real <= 0])
    assert beside_whole(without, NOMINAL, 2.0, 20e3)[2] == len(growing)
    beside = SimpleNamespace(family=family(), roots=lambda factors, speed: np.append(whole, 50 + 1234j))
    assert beside_whole(beside, NOMINAL, 2.0, 20e3)[2] == 1


def test_all_draws_are_told_together():
    one, other = (np.array([1 + 2j]), np.array([1 + 2.1j]), np.int64(1)), (np.empty(0), np.empty(0), np.int64(2))
    told = accuracy([one, other])
    assert told == {"checked_root": one[0], "whole_root": one[1], "checked_draws": 2, "missed": 3}
    assert accuracy([])["whole_root"].dtype == complex and accuracy([])["missed"] == 0
