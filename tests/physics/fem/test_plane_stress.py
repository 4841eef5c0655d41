"""Plane stress: rigid motion, patch test, a slender cantilever against Timoshenko, order of convergence."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.closed_form.timoshenko_cantilever import cantilever_frequencies
from pipeline.physics.fem.plane_stress import plane_elasticity, sheet
from pipeline.physics.fem.timoshenko_beam import BeamSection
from pipeline.physics.modal.natural_modes import lowest_modes

SECTION = BeamSection(height=10e-3, width=12e-3, young=210e9, poisson=0.3, density=7800.0)
LENGTH = 0.2
LEAN = np.array([np.cos(0.4), np.sin(0.4)])


def plate(cells, across=2):
    half = SECTION.height / 2
    return sheet(np.array([0.1, 0.2]), LEAN, np.linspace(0, LENGTH, cells + 1), np.linspace(-half, half, across + 1),
                 SECTION)


def clamped(cells, across=2, count=4):
    part = plate(cells, across)
    free = np.setdiff1d(np.arange(2 * len(part.node)), (2 * part.lattice[0][:, None] + np.arange(2)).ravel())
    return lowest_modes(part.stiffness[free][:, free], part.mass[free][:, free], "superlu", count=count)[0]


@pytest.mark.exact
def test_patch_of_constant_strain_and_total_mass():
    part = plate(5)
    strain = np.array([1e-3, -4e-4, 7e-4])
    x, y = part.node.T
    moved = np.column_stack((strain[0] * x + strain[2] / 2 * y, strain[2] / 2 * x + strain[1] * y)).ravel()
    energy = moved @ part.stiffness @ moved / 2
    volume = SECTION.area * LENGTH
    assert energy == pytest.approx(strain @ plane_elasticity(210e9, 0.3) @ strain / 2 * volume, rel=1e-10)
    shift = np.tile([1.0, 0.0], len(part.node))
    assert shift @ part.mass @ shift == pytest.approx(SECTION.density * volume, rel=1e-12)
    turn = np.column_stack((-y, x)).ravel()
    assert np.abs(part.stiffness @ turn).max() < 1e-9 * np.abs(part.stiffness).max()


@pytest.mark.exact
def test_slender_cantilever_agrees_with_timoshenko():
    """Bending modes within 0.5 %: the clamp that also holds the contraction across stiffens the plane beam a little."""
    s = SECTION
    wanted = cantilever_frequencies(LENGTH, s.area, s.inertia, s.young, s.shear_stiffness, s.density, 4e3)
    np.testing.assert_allclose(clamped(40)[:len(wanted)], wanted, rtol=5e-3)
    assert len(wanted) == 3


@pytest.mark.exact
def test_convergence_is_that_of_the_corner():
    """Frequencies fall as the mesh is refined; the singular corners of the clamp leave an order between 1 and 4."""
    found = [clamped(cells, across, count=1)[0] for cells, across in ((20, 1), (40, 2), (80, 4))]
    assert found[0] > found[1] > found[2]
    assert 1.0 < np.log2((found[0] - found[1]) / (found[1] - found[2])) < 4.0


@pytest.mark.exact
def test_free_beam_converges_by_the_fourth_power():
    """Without the corners of a clamp: eigenvalues of quadratic elements, order 2 p = 4."""
    found = [lowest_modes(part.stiffness, part.mass, "superlu", count=4, shift=300.0)[0][3]
             for part in (plate(c, a) for c, a in ((8, 1), (16, 2), (32, 4)))]
    assert np.log2((found[0] - found[1]) / (found[1] - found[2])) == pytest.approx(4.0, abs=0.35)


def test_lines_that_do_not_ascend_are_refused():
    with pytest.raises(ConfigError, match="plane mesh"):
        sheet(np.zeros(2), np.array([1.0, 0.0]), [0.0, 0.1, 0.1], [0.0, 1.0], SECTION)
