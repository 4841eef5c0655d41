"""Materials: isotropy, units, and axes against the transformation of a rotation by 30 degrees."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.decks.meshes.material import BY_COLUMNS, BY_ROWS, Material, Unread, rotated, symmetric
from pipeline.physics.fem.elasticity import isotropic, orthotropic

pytestmark = pytest.mark.exact


def test_isotropy_and_units():
    iron = Material("A", density=7.1e-9).with_isotropic(110e3, 0.26)
    assert iron.isotropic and not Material("B").isotropic
    si = iron.scaled(1e6, 1e12)
    assert si.density == pytest.approx(7100) and np.allclose(si.elasticity(), isotropic(110e9, 0.26))
    lining = Material("C", (6e9, 6e9, 1.5e9), (0.2, 0.2, 0.1), (1.2e9, 1.2e9, 2.5e9))
    assert not lining.isotropic
    assert np.array_equal(lining.elasticity(), orthotropic(lining.young, lining.poisson, lining.shear))


def test_turning_leaves_an_isotropic_material_as_it_is():
    turn, _ = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))
    assert rotated(isotropic(2e11, 0.3), turn) == pytest.approx(isotropic(2e11, 0.3), abs=1.0)


def test_modulus_between_two_axes():
    """1/E(a) = c^4/E1 + s^4/E2 + (1/G12 - 2 nu12/E1) s^2 c^2 of a material whose axes are turned by a about z."""
    e1, e2, nu, g, angle = 6e9, 2e9, 0.25, 1.7e9, np.pi / 6
    c, s = np.cos(angle), np.sin(angle)
    given = orthotropic((e1, e2, 3e9), (0.1, 0.2, nu), (1e9, 1.1e9, g))
    compliance = np.linalg.inv(rotated(given, np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])))
    assert compliance[0, 0] == pytest.approx(c**4 / e1 + s**4 / e2 + (1 / g - 2 * nu / e1) * s**2 * c**2)


def test_constants_of_a_matrix():
    given = orthotropic((6e9, 2e9, 3e9), (0.1, 0.2, 0.25), (1e9, 1.1e9, 1.7e9))
    made = Material("A", unread=Unread("a:1", "b", "c")).with_matrix(given, "a:2")
    assert made.young == pytest.approx((6e9, 2e9, 3e9)) and made.poisson == pytest.approx((0.1, 0.2, 0.25))
    assert made.shear == pytest.approx((1e9, 1.1e9, 1.7e9)) and made.matrix is None and made.unread is None
    assert np.allclose(made.elasticity(), given)
    assert Material("B").with_matrix(isotropic(2e11, 0.3), "a:2").isotropic
    with pytest.raises(ConfigError, match="a:2, material A: expected elastic constants of a positive strain energy"):
        made.with_matrix(-given, "a:2")


@pytest.mark.parametrize("pairs", [BY_ROWS, BY_COLUMNS])
def test_a_triangle_in_another_order_of_strains(pairs):
    root = np.random.default_rng(2).normal(size=(6, 6))
    given, order = root @ root.T, [0, 1, 2, 5, 3, 4]
    values = [given[order[i], order[j]] for i, j in pairs]
    assert np.allclose(symmetric(values, pairs, order), given)
