"""Modes of a beam with residual shapes: a free beam, and the static response at the contact."""

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.linalg import eigh

from pipeline.physics.fem.timoshenko_beam import BeamSection, beam
from pipeline.physics.reduction.beam import beam_modes

SECTION = BeamSection(10e-3, 12e-3, 210e9, 0.3, 7800.0)


def line(held):
    full = beam(np.array([[0.0, 0.0], [0.08, 0.0], [0.3, 0.0]]), 10, SECTION)
    free = np.arange(held, len(full.stiffness))
    rows = np.zeros((2, len(free)))
    rows[0, 30 - held], rows[1, 31 - held] = 1.0, 1.0
    return full.stiffness[np.ix_(free, free)], full.mass[np.ix_(free, free)], rows


@pytest.mark.exact
def test_static_response_of_a_clamped_beam_is_kept():
    stiffness, mass, rows = line(held=3)
    squared, shape = beam_modes(sp.csr_matrix(stiffness), sp.csr_matrix(mass), rows, 10e3, 1e7, "superlu")
    reduced = (rows @ shape) / squared @ (rows @ shape).T
    np.testing.assert_allclose(reduced, rows @ np.linalg.solve(stiffness, rows.T), rtol=2e-3, atol=1e-14)
    modes = eigh(stiffness, mass, eigvals_only=True)
    below = modes[modes < (2e4 * np.pi) ** 2]
    np.testing.assert_allclose(squared[:len(below)], below, rtol=1e-8)
    np.testing.assert_allclose(shape.T @ mass @ shape, np.eye(len(squared)), atol=1e-8)


@pytest.mark.exact
def test_a_beam_without_supports_keeps_its_motion_as_a_whole():
    stiffness, mass, rows = line(held=0)
    squared, shape = beam_modes(sp.csr_matrix(stiffness), sp.csr_matrix(mass), rows, 10e3, 1e7, "superlu")
    assert np.sum(squared < 1.0) == 3
    across = np.zeros(len(mass))
    across[1::3] = 1.0
    weight = across @ mass @ across
    assert np.sum((shape[:, :3].T @ mass @ across) ** 2) == pytest.approx(weight, rel=1e-6)
