"""Smooth law over pressure: reproduces its own kind, levels off beyond the points, and keeps scatter out of slopes."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.friction.pressure_law import LEVELLING, levelling_axis, polynomial_fit, slope_error

PRESSURE = np.array([0.5e6, 1e6, 2e6, 3e6, 6e6])


def law(p):
    x = np.log(p / 1e6)
    return 0.6 + 0.13 * x - 0.06 * x**2


def test_a_law_of_the_fitted_order_is_met_exactly():
    axis = levelling_axis(PRESSURE, 8)
    fitted = polynomial_fit(PRESSURE, [0.06, 0.04, 0.003, 0.01, 0.007], 2, axis) @ law(PRESSURE)
    inside = (axis >= PRESSURE[0]) & (axis <= PRESSURE[-1])
    assert len(axis) == 4 * 8 + 1 + 2 * 8 and np.isin(PRESSURE, axis).all()
    np.testing.assert_allclose(fitted[inside], law(axis[inside]), rtol=1e-12)


def test_it_levels_off_without_a_kink():
    place = PRESSURE[-1] * LEVELLING ** np.linspace(-0.5, 1.5, 20001)
    value = polynomial_fit(PRESSURE, np.ones(5), 2, place) @ law(PRESSURE)
    slope = np.gradient(value, np.log(place))
    end = 0.13 - 0.12 * np.log(6)
    assert slope[5000] == pytest.approx(end, abs=1e-4) and np.abs(np.diff(slope)).max() < 1e-3
    np.testing.assert_allclose(slope[10000], end / 2, rtol=1e-3)      # half way over ln p
    assert np.ptp(value[15001:]) <= 2 * np.spacing(value[-1])     # equal rows of a product, up to its last bits


def test_weights_are_those_of_the_standard_errors():
    rng, deviation = np.random.default_rng(0), np.array([0.06, 0.04, 0.003, 0.01, 0.007])
    fit = polynomial_fit(PRESSURE, deviation, 2, PRESSURE)
    drawn = fit @ (law(PRESSURE)[:, None] + deviation[:, None] * rng.standard_normal((5, 4000)))
    np.testing.assert_allclose(drawn.std(axis=1), np.sqrt(fit**2 @ deviation**2), rtol=0.05)
    assert (drawn.std(axis=1) < deviation * 1.05).all()


def test_error_of_a_slope_is_that_of_drawn_lines():
    rng, deviation, x = np.random.default_rng(1), np.array([0.06, 0.04, 0.003, 0.01, 0.007]), np.log(PRESSURE)
    slopes = [np.polyfit(x, deviation * z, 1, w=1 / deviation)[0] for z in rng.standard_normal((2000, 5))]
    assert slope_error(x, deviation) == pytest.approx(np.std(slopes), rel=0.05)
    assert slope_error(x[:1], deviation[:1]) == slope_error(x, 0 * deviation) == 0.0


@pytest.mark.parametrize("deviation, order", [(np.ones(5), 5), (np.r_[0.0, np.ones(4)], 2)])
def test_what_cannot_be_fitted_is_refused(deviation, order):
    with pytest.raises(ConfigError):
        polynomial_fit(PRESSURE, deviation, order, PRESSURE)
