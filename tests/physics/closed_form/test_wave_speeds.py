"""Speeds of surface and interface waves against values with a formula."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.closed_form.wave_speeds import (
    Solid,
    checked,
    generalised_rayleigh_speed,
    mach_angle,
    rayleigh_function,
    rayleigh_speed,
    sliding_function,
)

STIFF, SOFT = Solid(5.3e9, 0.25, 1246.0), Solid(3.392e9, 0.25, 1246.0)


@pytest.mark.exact
def test_the_rayleigh_speed_of_a_solid_with_poisson_ratio_one_quarter():
    """Rayleigh (1885): (c / cS)^2 = 2 - 2 / sqrt(3)."""
    assert rayleigh_speed(STIFF) / STIFF.shear_speed == pytest.approx(np.sqrt(2.0 - 2.0 / np.sqrt(3.0)), rel=1e-9)


@pytest.mark.exact
@pytest.mark.parametrize("poisson", [0.0, 0.31, 0.49])
@pytest.mark.parametrize("plane_stress", [False, True])
def test_the_rayleigh_speed_solves_its_equation(poisson, plane_stress):
    solid = Solid(1e9, poisson, 1000.0, plane_stress)
    assert abs(rayleigh_function(rayleigh_speed(solid), solid)) < 1e-9
    assert 0.86 < rayleigh_speed(solid) / solid.shear_speed < 0.96


@pytest.mark.exact
def test_the_bar_and_plate_moduli():
    """Plane stress: rho cP^2 = E / (1 - nu^2); plane strain: E (1 - nu) / ((1 + nu) (1 - 2 nu))."""
    stress, strain = Solid(2.0, 0.3, 1.0, True), Solid(2.0, 0.3, 1.0)
    assert stress.dilatational_speed**2 == pytest.approx(2.0 / 0.91)
    assert strain.dilatational_speed**2 == pytest.approx(2.0 * 0.7 / (1.3 * 0.4))


@pytest.mark.exact
def test_like_solids_slide_at_the_rayleigh_speed():
    assert generalised_rayleigh_speed(SOFT, SOFT) == pytest.approx(rayleigh_speed(SOFT), rel=1e-12)


@pytest.mark.exact
def test_the_generalised_rayleigh_speed_solves_its_equation_between_both_rayleigh_speeds():
    speed = generalised_rayleigh_speed(STIFF, SOFT)
    assert abs(sliding_function(speed, STIFF, SOFT)) < 1e-9 * STIFF.shear_modulus
    assert rayleigh_speed(SOFT) < speed < rayleigh_speed(STIFF)
    assert generalised_rayleigh_speed(SOFT, STIFF) == pytest.approx(speed, rel=1e-12)


def test_too_unlike_solids_carry_no_generalised_rayleigh_wave():
    assert generalised_rayleigh_speed(STIFF, Solid(1e9, 0.25, 1246.0)) is None


def test_mach_angle():
    assert mach_angle(1000.0, 2000.0) == pytest.approx(np.pi / 6)
    assert np.isnan(mach_angle(1000.0, 900.0))


@pytest.mark.parametrize("solid", [Solid(1e9, 0.5, 1e3), Solid(1e9, -1.0, 1e3), Solid(0.0, 0.3, 1e3)])
def test_solids_without_wave_speeds_are_refused(solid):
    with pytest.raises(ConfigError, match="upper.*expected"):
        checked(solid, "upper")
