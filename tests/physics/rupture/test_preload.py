"""The static state before a rupture: a crack with a formula, complementarity, equilibrium."""

from functools import cache

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.rupture.plate_grid import nodal_share
from pipeline.physics.rupture.preload import solve_preload
from tests.physics.small_ruptures import SOFT, STIFF, plates


@cache
def shear_where_stuck(spacing, length):
    """Shear / Pa in the middle of plates that stick everywhere: that of no crack."""
    state = solve_preload(*plates(spacing, length=length, height=0.5 * length, solids=(SOFT, SOFT)), 10.0, 1e6, 0.5,
                          "superlu")
    return state.shear[state.shear.size // 2]


def crack(spacing, length, half=6e-4):
    """(slip at the centre, slope of slip^2 over x^2), over those of an infinite solid, and tip / m."""
    lower, upper = plates(spacing, length=length, height=0.5 * length, solids=(SOFT, SOFT))
    x = spacing * np.arange(lower.columns) - 0.5 * length
    free = np.abs(x) < half * (1 - 1e-6)
    cracked = solve_preload(lower, upper, np.where(free, 0.0, 10.0), 1e6, 0.5, "superlu")
    assert not cracked.shear[free].round(3).any() and not cracked.slip[~free].any()
    middle = np.abs(x) < 0.69 * half
    slope, height = np.polyfit(x[middle] ** 2, cracked.slip[middle] ** 2, 1)
    expected = 2 * (1 - SOFT.poisson_ratio) * shear_where_stuck(1e-4, length) / SOFT.shear_modulus
    return cracked.slip[x.size // 2] / (expected * half), np.sqrt(-slope) / expected, np.sqrt(-height / slope)


@pytest.mark.exact
def test_a_frictionless_patch_slips_like_a_static_crack():
    """Infinite solid: slip^2 = (2 (1 - nu) tau / G)^2 (a^2 - x^2).

    First order in the mesh: the tip lies 0.4 elements inside the first node that sticks. Second order in the size of
    the plates, whose held edges stiffen the crack: 1.3 % at 5 crack lengths, 0.3 % at 10.
    """
    small, large = ((crack(1e-4, length), crack(5e-5, length)) for length in (6e-3, 12e-3))
    for (coarse, _, far), (fine, _, near) in (small, large):
        assert (1.0 - coarse) / (1.0 - fine) == pytest.approx(2.0, abs=0.35)
        assert [(6e-4 - far) / 1e-4, (6e-4 - near) / 5e-5] == pytest.approx([0.4, 0.4], abs=0.05)
    centre = [2.0 * fine[0] - coarse[0] for coarse, fine in (small, large)]
    assert centre == pytest.approx([0.987, 0.997], abs=0.002)
    assert (4.0 * centre[1] - centre[0]) / 3.0 == pytest.approx(1.0, abs=0.001)
    assert large[1][1] == pytest.approx(1.0, abs=0.003), "the slope does not feel where the tip is"


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
