"""Spectral Timoshenko beams against Timoshenko's own equation, and how fast they converge."""

import numpy as np
import pytest
from scipy.linalg import eigh

from pipeline.physics.closed_form.timoshenko_cantilever import cantilever_frequencies
from pipeline.physics.fem.timoshenko_beam import BeamSection, beam

SECTION = BeamSection(height=18e-3, width=12e-3, young=210e9, poisson=0.3, density=7800.0)
LENGTH, LEAN = 0.37, 0.3
LIMIT = 12e3


def cantilever(degree, segments=1):
    """Frequencies (Hz) of a leaning cantilever, bending and axial ones."""
    stations = np.outer(np.linspace(0, LENGTH, segments + 1), (np.cos(LEAN), np.sin(LEAN)))
    line = beam(stations, degree, SECTION)
    return np.sqrt(eigh(line.stiffness[3:, 3:], line.mass[3:, 3:], eigvals_only=True)) / (2 * np.pi)


def exact():
    s = SECTION
    bending = cantilever_frequencies(LENGTH, s.area, s.inertia, s.young, s.shear_stiffness, s.density, LIMIT)
    axial = np.sqrt(s.young / s.density) / LENGTH * (2 * np.arange(3) + 1) / 4
    return np.sort(np.concatenate((bending, axial[axial < LIMIT])))


@pytest.mark.exact
def test_cantilever_of_timoshenko():
    found = cantilever(20)
    wanted = exact()
    assert len(wanted) == 9
    np.testing.assert_allclose(found[:len(wanted)], wanted, rtol=1e-7)


@pytest.mark.exact
def test_thin_cantilever_is_bernoulli_s():
    """1.8751^2 / (2 pi) sqrt(EI / rho A) / L^2, whose relative error falls with (height / length)^2."""
    errors = []
    for height in (4e-3, 2e-3):
        s = BeamSection(height, 12e-3, 210e9, 0.3, 7800.0)
        found = cantilever_frequencies(LENGTH, s.area, s.inertia, s.young, s.shear_stiffness, s.density, 60.0)[0]
        errors.append(1 - found / (1.8751040687**2 / (2 * np.pi) * np.sqrt(s.young * s.inertia / (s.density * s.area))
                                   / LENGTH**2))
    assert errors[0] == pytest.approx(4 * errors[1], rel=1e-3) and 0 < errors[0] < 1e-3


@pytest.mark.exact
def test_error_falls_exponentially_with_the_degree():
    """Mode 3: from degree 8 on, two more degrees gain a factor of more than 30 each time."""
    wanted = exact()[2]
    error = np.array([abs(cantilever(degree)[2] / wanted - 1) for degree in (8, 10, 12)])
    assert np.all(error[:-1] / error[1:] > 30) and error[-1] < 1e-6


@pytest.mark.exact
def test_error_falls_with_segments_by_twice_the_degree():
    """Eigenvalues of quadratic segments with full shear: order 2 p = 4 once the segments resolve the section."""
    wanted = exact()[0]
    error = np.array([abs(cantilever(2, segments)[0] / wanted - 1) for segments in (16, 32, 64)])
    assert np.all(np.abs(np.log2(error[:-1] / error[1:]) - 4) < 0.3)


def test_motion_of_the_whole_costs_no_energy_and_has_the_mass():
    line = beam(np.array([[0.0, 0.0], [0.1, 0.2]]), 5, SECTION)
    moves = np.zeros((3, len(line.node), 3))
    moves[0, :, 0] = moves[1, :, 1] = moves[2, :, 2] = 1.0
    moves[2, :, 0], moves[2, :, 1] = -line.node[:, 1], line.node[:, 0]
    moves = moves.reshape(3, -1)
    assert np.abs(line.stiffness @ moves.T).max() < 1e-9 * np.abs(line.stiffness).max()
    mass = SECTION.density * SECTION.area * np.hypot(0.1, 0.2)
    np.testing.assert_allclose(np.diag(moves @ line.mass @ moves.T)[:2], mass, rtol=1e-12)
