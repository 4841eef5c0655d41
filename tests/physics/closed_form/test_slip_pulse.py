"""Stress of steady slip pulses: limits with a formula, and the pulse of Adams (2001)."""

import numpy as np
import pytest

from pipeline.physics.closed_form.slip_pulse import (
    AGAINST_LOWER,
    WITH_LOWER,
    intersonic_pulse_speeds,
    pulse_exponent,
    pulse_stress,
)
from pipeline.physics.closed_form.wave_speeds import Solid, generalised_rayleigh_speed, rayleigh_function

STIFF, SOFT = Solid(5.3e9, 0.25, 1246.0), Solid(3.392e9, 0.25, 1246.0)


@pytest.mark.exact
def test_like_solids_below_the_shear_speed():
    """Weertman (1980): shear = -G R(c) / (2 a_s (1 - a_s^2)) H[V] / c, pressure = 0."""
    speed = 0.7 * SOFT.shear_speed
    stress = pulse_stress(speed, SOFT, SOFT, WITH_LOWER)
    across = np.sqrt(1 - 0.7**2)
    expected = -SOFT.shear_modulus * rayleigh_function(speed, SOFT) / (2 * across * (1 - across**2)) / speed
    assert stress.shear_hilbert == pytest.approx(expected, rel=1e-9)
    np.testing.assert_allclose(stress[2:], 0.0, atol=1e-9 * abs(expected))
    assert stress.shear_local == pytest.approx(0.0, abs=1e-9 * abs(expected))


@pytest.mark.exact
def test_like_solids_at_the_square_root_of_two_radiate_no_shear_wave():
    """Eshelby's speed: the local (radiated) part of the shear vanishes."""
    stress = pulse_stress(np.sqrt(2) * SOFT.shear_speed, SOFT, SOFT, WITH_LOWER)
    assert abs(stress.shear_local) < 1e-9 * abs(stress.shear_hilbert)


@pytest.mark.exact
def test_far_above_all_wave_speeds_slip_sends_plane_shear_waves():
    """Radiation damping: shear = -V / (1 / Z1 + 1 / Z2), Z = density * shear speed."""
    stress = pulse_stress(1e7, STIFF, SOFT, WITH_LOWER)
    first, second = (s.density * s.shear_speed for s in (STIFF, SOFT))
    assert stress.shear_local == pytest.approx(-first * second / (first + second), rel=1e-5)


@pytest.mark.exact
def test_slip_at_the_generalised_rayleigh_speed_meets_no_shear():
    stress = pulse_stress(generalised_rayleigh_speed(STIFF, SOFT), STIFF, SOFT, WITH_LOWER)
    assert abs(stress.shear_hilbert) < 1e-8 * abs(stress.pressure_local)
    assert stress.pressure_local < 0, "a pulse along the slip of the softer solid relieves its pressure"


@pytest.mark.published
def test_the_intersonic_pulse_of_adams_2001():
    """'just below the lesser dilatational wave speed', against the slower solid's slip, for sufficient friction."""
    low, high = intersonic_pulse_speeds(STIFF, SOFT, 1.0)
    assert high == SOFT.dilatational_speed
    assert 0.999 * high < low < high
    middle = 0.5 * (low + high)
    assert 0 < pulse_exponent(middle, STIFF, SOFT, 1.0, AGAINST_LOWER) < 0.5, "weakly singular at the leading edge"
    assert np.isnan(pulse_exponent(middle, STIFF, SOFT, 1.0, WITH_LOWER))
    assert intersonic_pulse_speeds(STIFF, SOFT, 0.1) is None
    assert intersonic_pulse_speeds(STIFF, STIFF, 1.0) is None
