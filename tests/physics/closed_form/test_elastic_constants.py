"""Constants of isotropic elasticity against one another and against the elasticity matrix."""

import numpy as np
import pytest

from pipeline.physics.closed_form.elastic_constants import first_modulus, plane_strain_modulus, shear_modulus
from pipeline.physics.fem.elasticity import isotropic

pytestmark = pytest.mark.exact


@pytest.mark.parametrize("poisson", [-0.2, 0.0, 0.3, 0.49])
def test_the_elasticity_matrix_holds_lame_s_constants(poisson):
    matrix, shear, first = isotropic(210e9, poisson), shear_modulus(210e9, poisson), first_modulus(210e9, poisson)
    np.testing.assert_allclose(np.diag(matrix)[3:], shear, rtol=1e-12)
    np.testing.assert_allclose(matrix[0, :3], [first + 2 * shear, first, first], rtol=1e-9, atol=1.0)


def test_a_strip_in_plane_strain_has_the_plane_strain_modulus():
    compliance = np.linalg.inv(isotropic(70e9, 0.33)[np.ix_([0, 2], [0, 2])])     # strain yy = 0, stress zz = 0
    assert 1 / compliance[0, 0] == pytest.approx(plane_strain_modulus(70e9, 0.33), rel=1e-12)


def test_lame_s_constant_of_plane_stress_leaves_the_other_stress_zero():
    young, poisson = 70e9, 0.33
    first, shear = first_modulus(young, poisson, plane_stress=True), shear_modulus(young, poisson)
    assert first + 2 * shear == pytest.approx(plane_strain_modulus(young, poisson), rel=1e-12)
