"""A block of elements of different moduli against the assembled one, columns, laminates and Eshelby's sphere."""

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.rough.composite.composite_block import composite_block
from pipeline.physics.rough.contact.normal_contact import apply
from pipeline.physics.rough.layered_solid import layered_compliance
from tests.physics.rough.test_layered_solid import DEPTH, SHAPE, SPACING, assembled


@pytest.fixture
def factor():
    return np.exp(np.random.default_rng(2).uniform(-1, 2, (DEPTH.size - 1, *SHAPE)))


@pytest.mark.exact
def test_forces_and_displacements_are_those_of_the_sparse_finite_elements(factor):
    random = np.random.default_rng(3)
    block, stiffness = composite_block(factor, SPACING, DEPTH, 2.0, 0.3), assembled(2.0, 0.3, factor)
    u = random.standard_normal((*factor.shape, 3))
    held = (stiffness @ u.ravel()).reshape(u.shape)
    np.testing.assert_allclose(block.forces(u), held, atol=1e-12 * np.abs(held).max())
    found = block.solved(u, tolerance=1e-11)
    reference = spsolve(stiffness, u.ravel()).reshape(u.shape)
    np.testing.assert_allclose(found, reference, atol=1e-9 * np.abs(reference).max())


@pytest.mark.exact
def test_of_one_modulus_the_preconditioner_is_the_solution(factor):
    block = composite_block(np.ones_like(factor), SPACING, DEPTH, 2.0, 0.3)
    pressure = np.random.default_rng(4).standard_normal(SHAPE)
    force = np.zeros((*factor.shape, 3))
    force[0, ..., 2] = block.area * pressure
    surface = apply(layered_compliance(SHAPE, SPACING, DEPTH, 2.0, 0.3).normal, pressure)
    np.testing.assert_allclose(block.of_one_modulus(force)[0, ..., 2], surface, atol=1e-12 * np.abs(surface).max())
    np.testing.assert_allclose(block.under(pressure)[0, ..., 2], surface, atol=1e-9 * np.abs(surface).max())


@pytest.mark.exact
def test_columns_without_lateral_strain_share_the_load_by_their_moduli():
    """Poisson ratio 0: pressed by one depth d, each column bears E d / h; a node the mean of its four columns."""
    columns = np.random.default_rng(5).uniform(0.5, 3.0, SHAPE)
    block = composite_block(np.tile(columns, (DEPTH.size - 1, 1, 1)), SPACING, DEPTH, 2.0, 0.0)
    u = np.zeros((*block.factor.shape, 3))
    u[..., 2] = (1 - DEPTH[:-1] / DEPTH[-1])[:, None, None]
    held = block.forces(u)
    around = sum(np.roll(columns, shift, (0, 1)) for shift in ((0, 0), (0, 1), (1, 0), (1, 1))) / 4
    np.testing.assert_allclose(held[0, ..., 2], block.area * 2.0 * around / DEPTH[-1], rtol=1e-12)
    np.testing.assert_allclose(held[1:, ..., 2], 0, atol=1e-12)


@pytest.mark.exact
def test_laminates_yield_as_oedometers_in_series():
    layers = np.array([0.5, 3.0, 1.5])
    block = composite_block(np.ones((3, *SHAPE)) * layers[:, None, None], SPACING, DEPTH, 2.0, 0.3)
    moved = block.under(np.ones(SHAPE), tolerance=1e-10)
    oedometer = 2.0 * 0.7 / (1.3 * 0.4)
    np.testing.assert_allclose(moved[0, ..., 2], (np.diff(DEPTH) / layers).sum() / oedometer, rtol=1e-8)


@pytest.mark.exact
@pytest.mark.parametrize("contrast", [0.2, 5.0])
def test_a_sphere_strains_evenly_after_eshelby(contrast):
    """J. D. Eshelby, Proc. R. Soc. A 241 (1957) 376: the strain in a sphere of other modulus is that far away times
    (3 K + 4 G) / (3 K1 + 4 G) in volume and 5 G (3 K + 4 G) / (G (9 K + 8 G) + 6 G1 (K + 2 G)) in shape."""
    n, ratio = 32, 0.25
    place = np.arange(n) + 0.5 - n / 2
    inside = (place[:, None, None] ** 2 + place[:, None] ** 2 + place**2) < (n / 6) ** 2
    block = composite_block(np.where(inside, contrast, 1.0), (1.0, 1.0), np.arange(n + 1.0), 1.0, ratio)
    moved = block.under(np.ones((n, n)), tolerance=1e-5)
    oedometer = (1 - ratio) / ((1 + ratio) * (1 - 2 * ratio))
    bulk, shear = 1 / (3 * (1 - 2 * ratio)), 1 / (2 * (1 + ratio))
    volume = (3 * bulk + 4 * shear) / (3 * contrast * bulk + 4 * shear)
    shape = 5 * shear * (3 * bulk + 4 * shear) / (shear * (9 * bulk + 8 * shear)
                                                 + 6 * contrast * shear * (bulk + 2 * shear))
    along = volume / 3 + 2 * shape / 3
    m = n // 2
    stretch = (moved[m - 2, m, m, 2] - moved[m + 2, m, m, 2]) / 4 * oedometer
    assert stretch == pytest.approx(along, rel=0.04)
    across = (moved[m, m, m + 2, 0] - moved[m, m, m - 2, 0]) / 4 * oedometer
    assert across == pytest.approx(volume / 3 - shape / 3, abs=0.04)


def test_factors_must_be_above_0_and_contrast_has_its_limit(factor):
    with pytest.raises(ConfigError, match="above 0"):
        composite_block(0 * factor, SPACING, DEPTH, 2.0, 0.3)
    with pytest.raises(ConvergenceError, match="contrast"):
        composite_block(factor, SPACING, DEPTH, 2.0, 0.3).solved(np.ones((*factor.shape, 3)), max_iterations=1)
