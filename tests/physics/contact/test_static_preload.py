"""Preload against closed forms: two springs and a law, an exponential law, an open patch, no touch."""

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.special import lambertw

from pipeline.contract.errors import ConfigError
from pipeline.physics.contact.static_preload import condense, contact_law, solve_preload
from pipeline.physics.numerics.sparse_solver import available

pytestmark = pytest.mark.exact
LINEAR = np.array([0.0, 1.0]), np.array([0.0, 1e9])


def test_law_of_constant_and_of_proportional_stiffness():
    """dp/dc = k gives a line; k = p / scale gives c = scale ln p, ten e-folds or a few alike."""
    closure, pressure = contact_law([1e6, 3e6], [1e12, 1e12], 1e7)
    high = pressure >= 1e6
    assert np.diff(pressure[high]) == pytest.approx(1e12 * np.diff(closure[high]))
    closure, pressure = contact_law([1e6, 3e6], [1e12, 3e12], 3e6)
    assert closure[-1] - closure[1] == pytest.approx(1e-6 * np.log(300), rel=1e-6)
    assert closure[0] == pressure[0] == 0 and closure[1] == pytest.approx(1e-6)
    with pytest.raises(ConfigError, match="positive"):
        contact_law([1e6], [0.0], 1e7)


def test_two_springs_through_two_patches():
    """A mass on a ground spring k, pressed by F on patches of stiffness c1, c2: N_i = c_i F / (k + c1 + c2)."""
    normal = sp.csr_matrix([[1.0], [1.0]])
    compliance, closure = condense(sp.csr_matrix([[2e6]]), normal, np.array([-1000.0]), available()[0])
    area = np.array([1e-3, 3e-3])
    found = solve_preload(compliance, closure, area, *LINEAR)
    assert found.force == pytest.approx(1000 * area * 1e9 / (2e6 + 4e6), rel=1e-9)
    assert found.stiffness == pytest.approx(area * 1e9)
    assert found.closed.all()


def test_exponential_law_against_lambert():
    """N = A p0 e^(c / s), c = c0 - N / k has N = k s W(A p0 e^(c0 / s) / (k s))."""
    scale, stiffness, area, start = 1e-6, 1e8, 1e-3, 2e-5
    closure, pressure = contact_law([1e5, 1e8], [1e11, 1e14], 1e8)
    lower = 1e3 * np.exp(-closure[1] / scale)
    fine = np.linspace(closure[1], closure[-1], 20001)
    law = np.r_[0, fine], np.r_[0, lower * np.exp(fine / scale)]
    exact = stiffness * scale * lambertw(area * lower * np.exp(start / scale) / (stiffness * scale)).real
    assert solve_preload(np.array([[1 / stiffness]]), np.array([start]), np.array([area]), *law).force == \
        pytest.approx(exact, rel=1e-5)


def test_patch_that_lifts_carries_nothing():
    """A rigid bar on two patches, pulled at one end: the far patch opens."""
    normal = sp.csr_matrix([[1.0, -1.0], [1.0, 1.0]])
    compliance, closure = condense(sp.diags([1e5, 1e4]).tocsr(), normal, np.array([-100.0, -400.0]), available()[0])
    found = solve_preload(compliance, closure, np.array([1e-3, 1e-3]), *LINEAR)
    assert list(found.closed) == [False, True]
    assert found.force[0] == found.stiffness[0] == 0 < found.force[1]


def test_bodies_that_do_not_touch():
    with pytest.raises(ConfigError, match="touch"):
        solve_preload(np.eye(2), np.array([-1e-3, -2e-3]), np.ones(2), *LINEAR)
