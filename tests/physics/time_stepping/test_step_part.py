"""Parts of a step against the matrices of whole steps, in all limits of a pair."""

import numpy as np
import pytest

from pipeline.physics.time_stepping.modal_integrator import modal_system, step_matrices
from pipeline.physics.time_stepping.step_part import part_of_step
from tests.physics.lumps import lumps, random_structure

MODELS = {"oscillator": lumps([1.0], [[1.0]], [400.0], [1.2]), "free": lumps([2.0]),
          "free with drag": lumps([2.0], [[1.0]], [0.0], [3.0]), "over-damped": lumps([1.0], [[1.0]], [1.0], [5e3]),
          "coupled": lumps([1.0, 0.6], [[1, 0], [-1, 1]], [900.0, 500.0], [2.0, 30.0]),
          "many modes": random_structure(12, 4e3)}


@pytest.mark.exact
@pytest.mark.parametrize("name", MODELS)
def test_a_part_of_a_step_is_the_exact_step_over_its_length(name):
    model = MODELS[name]
    system = modal_system(model)
    driven = np.ascontiguousarray(system.driven(model.input_rows))
    for length in (1e-9, 1e-4, 2.0 / max(system.highest, 1.0)):
        step, first, last = np.zeros((2, 2, len(system.squared))), np.zeros_like(driven), np.zeros_like(driven)
        part_of_step(system.blocks, driven, length, step, first, last)
        exact = step_matrices(system, length)
        np.testing.assert_allclose(step, np.moveaxis(exact[0], 0, 2), rtol=1e-11, atol=1e-14)
        for columns, matrix in zip((first, last), exact[1:], strict=True):
            expected = np.einsum("bxy,ryb->rxb", matrix, driven)
            np.testing.assert_allclose(columns, expected, rtol=1e-9, atol=1e-13 * abs(expected).max())
