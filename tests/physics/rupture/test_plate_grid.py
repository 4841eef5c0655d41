"""The plate's stiffness, masses, edges and stability limit."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.closed_form.wave_speeds import Solid
from pipeline.physics.rupture.plate_grid import (
    ABSORBING,
    FIXED,
    FREE,
    dilatational_speed,
    edge_impedance,
    elastic_force,
    element_stiffness,
    held,
    kinetic_energy,
    largest_step,
    lumped_mass,
    plate,
    strain_energy,
)

SOLID = Solid(5.3e9, 0.25, 1246.0)
FREE_EDGES = [(FREE, FREE)] * 4


def small(edges=FREE_EDGES, damping=0.0):
    return plate(SOLID, 1e-3, 5e-4, 1e-4, damping, edges)


@pytest.mark.exact
def test_the_element_is_the_fully_integrated_bilinear_one():
    """Against two-point Gauss integration of B^T D B."""
    first, shear = SOLID.first_modulus, SOLID.shear_modulus
    law = np.array([[first + 2 * shear, first, 0], [first, first + 2 * shear, 0], [0, 0, shear]])
    expected = np.zeros((8, 8))
    for x in (0.5 - 0.5 / np.sqrt(3), 0.5 + 0.5 / np.sqrt(3)):
        for y in (0.5 - 0.5 / np.sqrt(3), 0.5 + 0.5 / np.sqrt(3)):
            strain = np.zeros((3, 8))
            strain[0, :4] = strain[2, 4:] = [y - 1, 1 - y, -y, y]
            strain[1, 4:] = strain[2, :4] = [x - 1, -x, 1 - x, x]
            expected += 0.25 * strain.T @ law @ strain
    np.testing.assert_allclose(element_stiffness(first, shear), expected, atol=1e-12 * expected.max())


@pytest.mark.exact
def test_uniform_strain_is_exact():
    """u_x = e x, u_y = g x: energy = ((lambda + 2 G) e^2 + G g^2) / 2 * area; no force inside."""
    grid, strain, turn = small(), 1e-3, 2e-3
    x = 1e-4 * np.arange(grid.columns) * np.ones((grid.rows, 1))
    field = np.stack([strain * x, turn * x])
    density = 0.5 * ((SOLID.first_modulus + 2 * SOLID.shear_modulus) * strain**2 + SOLID.shear_modulus * turn**2)
    assert strain_energy(grid, field) == pytest.approx(density * 1e-3 * 5e-4)
    assert np.abs(elastic_force(grid, field)[:, 1:-1, 1:-1]).max() < 1e-9 * np.abs(elastic_force(grid, field)).max()


@pytest.mark.exact
def test_mass_and_edges_add_up():
    grid = small([(ABSORBING, ABSORBING), (FREE, FREE), (FIXED, FREE), (FREE, FREE)])
    assert lumped_mass(grid).sum() == pytest.approx(1246.0 * 1e-3 * 5e-4)
    assert edge_impedance(grid)[0].sum() == pytest.approx(1246.0 * SOLID.dilatational_speed * 5e-4)
    assert edge_impedance(grid)[1].sum() == pytest.approx(1246.0 * SOLID.shear_speed * 5e-4)
    assert held(grid)[0].sum() == grid.columns and held(grid)[1].sum() == 0
    assert kinetic_energy(grid, np.ones((2, grid.rows, grid.columns))) == pytest.approx(1246.0 * 1e-3 * 5e-4)


@pytest.mark.exact
def test_the_stability_limit_lies_below_that_of_the_assembled_plate_by_less_than_a_fifth():
    grid = small()
    size = 2 * grid.rows * grid.columns
    stiffness = np.array([elastic_force(grid, unit.reshape(2, grid.rows, grid.columns)).ravel()
                          for unit in np.eye(size)])
    mass = np.tile(lumped_mass(grid).ravel(), 2)
    highest = np.sqrt(np.linalg.eigvalsh(stiffness / np.sqrt(np.outer(mass, mass)))[-1])
    assert 0.8 * 2 / highest < largest_step(grid) <= 2 / highest


def test_damping_shortens_the_step():
    assert largest_step(small(damping=0.1)) < largest_step(small())
    assert small(damping=0.1).stiffness_damping == pytest.approx(0.1 * 1e-4 / dilatational_speed(small()))


def test_a_side_that_is_no_whole_number_of_elements_is_refused():
    with pytest.raises(ConfigError, match="whole elements"):
        plate(SOLID, 1.05e-3, 5e-4, 1e-4, 0.0, FREE_EDGES)


def test_an_incompressible_solid_is_refused():
    with pytest.raises(ConfigError, match="poisson_ratio.*between -1 and 0.5"):
        plate(Solid(1e9, 0.5, 1e3), 1e-3, 5e-4, 1e-4, 0.0, FREE_EDGES)
