"""Rough interface against single summits and the integrals of Greenwood & Williamson."""

import numpy as np
import pytest
from scipy.integrate import quad

from pipeline.contract.errors import ConfigError
from pipeline.physics.closed_form import hertz
from pipeline.physics.closed_form.rough_summits import exponential_area, exponential_pressure
from pipeline.physics.friction.dry_friction import evolution_curve
from pipeline.physics.rough.summit_model import (
    Summits,
    elastic,
    fit_descriptions,
    gap_at,
    moduli,
    normal_law,
    shear_law,
    summit_shear,
    summits_of,
)

pytestmark = pytest.mark.exact
PAIR = moduli((70e9, 70e9), (0.33, 0.33), 385e6)
GAUSSIAN = Summits(density=1e10, mean=0.0, spread=5e-7, curvature=4e4)


def test_exponential_heights_give_the_formula_of_greenwood_and_williamson():
    summits = Summits(1e10, 0.0, 5e-7, 4e4, heights="exponential")
    gap = np.linspace(0, 3e-6, 7)
    pressure, area, stiffness = normal_law(summits, PAIR.normal, gap)
    expected = exponential_pressure(gap, 1e10, 4e4, PAIR.normal, 5e-7)
    assert pressure == pytest.approx(expected, rel=1e-4)
    assert area == pytest.approx(exponential_area(gap, 1e10, 4e4, 5e-7), rel=1e-4)
    assert stiffness == pytest.approx(expected / 5e-7, rel=1e-4)


@pytest.mark.parametrize("gap", [-1e-6, 0.0, 1e-6])
def test_gaussian_heights_give_the_integral(gap):
    def integrand(z):
        return (z - gap) ** 1.5 * np.exp(-0.5 * (z / 5e-7) ** 2) / (np.sqrt(2 * np.pi) * 5e-7)

    integral = quad(integrand, gap, 3.5e-6, epsabs=0, epsrel=1e-10, points=[max(gap, 0.0) + 2e-7])[0]
    expected = 4 / 3 * PAIR.normal * 1e10 / np.sqrt(4e4) * integral
    assert normal_law(GAUSSIAN, PAIR.normal, [gap])[0][0] == pytest.approx(expected, rel=1e-6)


def test_equal_heights_are_one_hertz_contact_per_summit():
    """Heights of next to no spread: pressure over density is the load of one sphere of radius 1 / curvature."""
    summits, overlap = Summits(1e10, 0.0, 1e-12, 4e4), 2e-7
    pressure, area, stiffness = normal_law(summits, PAIR.normal, [-overlap])
    load = pressure[0] / summits.density
    radius = hertz.contact_radius(load, 1 / summits.curvature, PAIR.normal)
    assert area[0] / summits.density == pytest.approx(np.pi * radius**2, rel=1e-4)
    assert stiffness[0] / summits.density == pytest.approx(2 * PAIR.normal * radius, rel=1e-4)


def test_one_summit_shears_after_cattaneo_and_mindlin():
    """Q = Q_max (1 - (c/a)^3) at v = 3 Q_max / (16 G* a) (1 - (c/a)^2) for any stick radius c."""
    radius, stick = 1e-6, np.linspace(0, 1, 11)
    limit = np.pi * radius**2 * PAIR.shear_limit
    v = 3 * limit / (16 * PAIR.shear * radius) * (1 - stick**2)
    assert summit_shear(v, radius, PAIR) == pytest.approx(limit * (1 - stick**3), rel=1e-12)
    assert summit_shear(10 * v.max(), radius, PAIR) == pytest.approx(limit)


def test_tangential_over_normal_stiffness_is_mindlins_ratio():
    gap, v = np.array([2e-7, 8e-7]), np.array([1e-15])
    ratio = shear_law(GAUSSIAN, PAIR, gap, v)[:, 0] / v[0] / normal_law(GAUSSIAN, PAIR.normal, gap)[2]
    assert ratio == pytest.approx(2 * (1 - 0.33) / (2 - 0.33), rel=1e-4)


def test_load_and_area_grow_as_the_gap_closes():
    summits = Summits(1e10, 1e-7, 5e-7, 4e4, curvature_spread=0.6, correlation=0.4)
    for values in normal_law(summits, PAIR.normal, np.linspace(2e-6, -1e-6, 50))[:2]:
        assert (np.diff(values) > 0).all()


def test_gap_of_a_pressure_carries_it():
    wanted = np.array([1e5, 3e6, 4e8])
    assert normal_law(GAUSSIAN, PAIR.normal, gap_at(GAUSSIAN, PAIR.normal, wanted))[0] == pytest.approx(wanted)
    with pytest.raises(ConfigError, match="pressure"):
        gap_at(GAUSSIAN, PAIR.normal, [1e20])


def test_summits_of_a_wave_are_its_crests():
    """a cos kx cos ky has crests of height a and curvature a k^2, measured with the second difference."""
    nodes, waves, amplitude, length = 240, 6, 1e-6, 1e-3
    x = np.arange(nodes) / nodes * 2 * np.pi * waves
    found = summits_of(amplitude * np.cos(x[:, None]) * np.cos(x[None, :]), length / nodes)
    assert found.density == pytest.approx(2 * waves**2 / length**2)
    assert found.mean == pytest.approx(amplitude)
    step = 2 * np.pi * waves / nodes
    true = amplitude * (2 * np.pi * waves / length) ** 2
    assert found.curvature == pytest.approx(true * 2 * (1 - np.cos(step)) / step**2)
    with pytest.raises(ConfigError, match="summits"):
        summits_of(amplitude * np.cos(x[:40, None]) * np.cos(x[None, :40]), 1e-6)


def test_descriptions_meet_the_law_at_rest_and_in_full_slip():
    gap, v = gap_at(GAUSSIAN, PAIR.normal, [1e6, 1e8]), np.linspace(0, 2e-7, 200)
    shear = shear_law(GAUSSIAN, PAIR, gap, v)
    found = fit_descriptions(GAUSSIAN, PAIR, gap, v, shear)
    assert found.limit == pytest.approx(shear[:, -1], rel=1e-3)
    assert found.stiffness == pytest.approx(shear[:, 1] / v[1], rel=0.1)
    for k in range(2):
        rule = evolution_curve(v, found.limit[k], found.stiffness[k], found.exponent[k])
        assert np.abs(rule - shear[k]).max() < 0.05 * found.limit[k]
        spring = elastic(v, found.elastic_stiffness[k], found.limit[k])
        assert np.trapezoid(spring, v) == pytest.approx(np.trapezoid(shear[k], v), rel=1e-3)
