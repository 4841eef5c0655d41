"""The table of mu: exact on multilinear functions, constant and counted outside, no overshoot."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.friction.friction_table import FrictionLaw, friction_at, mean_friction_at, refine


def multilinear(p, v, s):
    return 0.4 + 0.03e-6 * p - 0.002 * v + 5.0 * s + 1e-7 * p * v * s


@pytest.fixture
def law():
    p, v, s = np.array([1e6, 2e6, 3e6]), np.array([1.1, 1.3, 1.5]), np.array([0.0, 1e-3, 1e-2])
    return FrictionLaw(p, v, s, multilinear(p[:, None, None], v[:, None], s))


@pytest.mark.exact
def test_multilinear_function_and_its_slopes_are_exact(law):
    p, v, s = 1.37e6, 1.44, 6.2e-3
    friction, by_pressure, by_speed, outside = friction_at(p, v, s, *law.table)
    assert friction == pytest.approx(multilinear(p, v, s), rel=1e-14)
    assert by_pressure == pytest.approx(0.03e-6 + 1e-7 * v * s, rel=1e-10)
    assert by_speed == pytest.approx(-0.002 + 1e-7 * p * s, rel=1e-10)
    assert outside == 0


@pytest.mark.exact
def test_slopes_of_a_sampled_curve_do_not_jump():
    """Of v^2 on even samples: 2 v, exact between the middles of the first and the last interval; 0 outside."""
    speed = np.linspace(0.0, 2.0, 11)
    curve = FrictionLaw([1e6], speed, [0.0], (speed**2)[None, :, None])
    for v in (0.1, 0.4, 0.63, 1.9):
        assert curve.slope("speed", 1e6, v, 0.0) == pytest.approx(2 * v, rel=1e-12)
    assert curve.slope("speed", 1e6, 3.0, 0.0) == curve.slope("pressure", 1e6, 1.0, 0.0) == 0.0


@pytest.mark.exact
def test_grid_points_are_reproduced(law):
    friction, outside = law.evaluate(law.pressure[:, None, None], law.speed[:, None], law.distance)
    np.testing.assert_allclose(friction, law.friction, rtol=1e-15)
    assert not outside.any()


@pytest.mark.parametrize("state, clipped", [((5e6, 1.2, 1e-3), (3e6, 1.2, 1e-3)),
                                            ((2e6, 0.2, 1e-3), (2e6, 1.1, 1e-3)),
                                            ((2e6, 1.2, 1.0), (2e6, 1.2, 1e-2))])
def test_outside_is_constant_flat_and_told(law, state, clipped):
    friction, by_pressure, by_speed, outside = friction_at(*state, *law.table)
    assert friction == pytest.approx(multilinear(*clipped), rel=1e-14)
    assert outside == 1
    assert (by_pressure == 0.0) == (state[0] != clipped[0])
    assert (by_speed == 0.0) == (state[1] != clipped[1])


def test_axes_of_one_value_are_constant():
    law = FrictionLaw([2e6], [1.3], [0.0], [[[0.45]]])
    assert friction_at(1e6, 1.0, 0.5, *law.table) == (0.45, 0.0, 0.0, 1)
    assert friction_at(2e6, 1.3, 0.0, *law.table) == (0.45, 0.0, 0.0, 0)


def test_refinement_keeps_points_and_range():
    axes = [np.array([1.0, 2.0, 4.0]), np.array([3.0]), np.array([0.0, 1.0, 2.0, 5.0])]
    values = np.random.default_rng(3).uniform(0.3, 0.7, (3, 1, 4))
    fine_axes, fine = refine(axes, values, (4, 4, 5))
    assert fine.shape == (9, 1, 16)
    np.testing.assert_allclose(fine[::4, :, ::5], values, rtol=1e-14)
    np.testing.assert_allclose(fine_axes[0][::4], axes[0])
    assert fine.min() >= values.min() - 1e-15 and fine.max() <= values.max() + 1e-15


@pytest.mark.exact
def test_refinement_is_monotone_where_the_points_are():
    _, fine = refine([np.array([0.0, 1.0, 2.0, 3.0])], np.array([0.40, 0.41, 0.60, 0.61]), (50,))
    assert np.all(np.diff(fine) > 0)


def test_a_falling_axis_is_refused():
    with pytest.raises(ConfigError, match="strictly rising"):
        FrictionLaw([2e6, 1e6], [1.0], [0.0], np.full((2, 1, 1), 0.4))


def test_a_table_of_another_shape_is_refused():
    with pytest.raises(ConfigError, match=r"shape \(2, 1, 1\)"):
        FrictionLaw([1e6, 2e6], [1.0], [0.0], np.full((2, 1), 0.4))


@pytest.mark.exact
def test_the_mean_over_distances_is_that_of_the_readings():
    law = FrictionLaw([1e6, 2e6, 4e6], [0.5, 1.0], [0.0, 1e-3, 5e-3], 0.3 + np.arange(18).reshape(3, 2, 3) ** 2 / 900)
    distance, share = np.array([0.0, 7e-4, 2e-3, 9e-3]), np.array([0.0, 0.25, 0.6, 0.15])
    for pressure, speed in ((1.3e6, 0.7), (2e6, 0.6), (5e6, 0.2)):
        read = np.array([friction_at(pressure, speed, d, *law.table)[:3] for d in distance])
        np.testing.assert_allclose(mean_friction_at(pressure, speed, distance, share, *law.table, 0), share @ read,
                                   rtol=1e-12, atol=1e-18)
