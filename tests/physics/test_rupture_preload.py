"""The static state before a rupture: a crack with a formula, complementarity, equilibrium."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.plate_grid import nodal_share
from pipeline.physics.rupture_preload import solve_preload
from tests.physics.small_ruptures import SOFT, STIFF, plates


@pytest.mark.exact
def test_a_frictionless_patch_slips_like_a_static_crack():
    """Infinite solid: slip^2 = (2 (1 - nu) tau / G)^2 (a^2 - x^2); the tip lies at the first node that sticks."""
    lower, upper = plates(5e-5, length=12e-3, height=6e-3, solids=(SOFT, SOFT))
    x = 5e-5 * np.arange(lower.columns) - 6e-3
    free = np.abs(x) < 5.99e-4
    stuck = solve_preload(lower, upper, 10.0, 1e6, 0.5, "superlu")
    cracked = solve_preload(lower, upper, np.where(free, 0.0, 10.0), 1e6, 0.5, "superlu")
    middle = np.abs(x) < 4.1e-4
    slope, height = np.polyfit(x[middle] ** 2, cracked.slip[middle] ** 2, 1)
    expected = 2 * (1 - SOFT.poisson_ratio) * stuck.shear[x.size // 2] / SOFT.shear_modulus
    assert np.sqrt(-slope) == pytest.approx(expected, rel=0.02)
    assert np.sqrt(-height / slope) == pytest.approx(6e-4, abs=2.5e-5), "half an element"
    assert not cracked.shear[free].round(3).any() and not cracked.slip[~free].any()


@pytest.mark.exact
def test_like_plates_carry_a_symmetric_state_and_the_asked_tractions():
    lower, upper = plates(1e-4, length=6e-3, height=2e-3, solids=(SOFT, SOFT))
    state = solve_preload(lower, upper, 1.0, 1e6, 0.6, "superlu")
    share = nodal_share(lower.columns) / (lower.columns - 1)
    assert share @ state.pressure == pytest.approx(1e6)
    assert state.shear[30] / state.pressure[30] == pytest.approx(0.6, rel=1e-3)
    np.testing.assert_allclose(state.shear, state.shear[::-1], atol=1e-6 * 1e6)
    assert state.shift_x > 0 and state.shift_y > 0


@pytest.mark.exact
def test_where_the_limit_is_exceeded_the_interface_slips_at_the_limit():
    """The ratio of the forces near friction: the middle slips, the edges, whose shear is relieved, stick."""
    lower, upper = plates(2e-4, length=8e-3, height=2e-3, solids=(SOFT, STIFF))
    state = solve_preload(lower, upper, 1.0, 1e6, 0.93, "superlu", everywhere=True)
    slipping = state.slip != 0.0
    assert 3 < slipping.sum() < lower.columns - 3
    assert (np.abs(state.shear) <= state.pressure * (1 + 1e-8)).all() and (state.pressure >= 0).all()
    np.testing.assert_allclose(state.shear[slipping], state.pressure[slipping], rtol=1e-8)
    assert (state.slip[slipping] * state.shear[slipping] > 0).all()
    stuck = solve_preload(lower, upper, 10.0, 1e6, 0.93, "superlu", everywhere=True)
    assert np.abs(stuck.shear).max() > stuck.pressure[np.abs(stuck.shear).argmax()], "a stuck state would exceed it"


def test_a_ratio_beyond_friction_is_refused():
    lower, upper = plates(2e-4, length=4e-3, height=2e-3)
    with pytest.raises(ConfigError, match="from 0 to below friction 0.5, found 0.5"):
        solve_preload(lower, upper, 0.5, 1e6, 0.5, "superlu")


def test_unlike_meshes_are_refused():
    lower, upper = plates(2e-4, 1e-4, length=4e-3, height=2e-3)
    with pytest.raises(ConfigError, match="matched interface nodes.*uniform preload"):
        solve_preload(lower, upper, 1.0, 1e6, 0.5, "superlu")
