"""Growth of slip on a weakening zone: published limit, growth too fast for the far side of the zone to matter."""

import numpy as np
import pytest

from pipeline.physics.closed_form.slip_weakening import growing_weakening
from pipeline.physics.closed_form.wave_speeds import Solid

SOLID = Solid(3.392e9, 0.25, 1246.0)


def length_number(rate, solid=SOLID, half_length=1e-3):
    """2 a W over the modulus of mode II; ``rate`` in shear speeds per half length."""
    weakening = growing_weakening(rate * solid.shear_speed / half_length, solid, half_length)
    return 2.0 * half_length * weakening * (1.0 - solid.poisson_ratio) / solid.shear_modulus


@pytest.mark.published
@pytest.mark.parametrize("poisson", [0.0, 0.25, 0.45])
def test_the_critical_length_of_a_weakening_zone(poisson):
    """Uenishi and Rice (2003): 1.158 moduli over weakening rates, whatever the solid; to the printed digits."""
    solid = Solid(1e9, poisson, 1000.0)
    assert length_number(0.0, solid, 0.3) == pytest.approx(1.158, abs=0.0005)


@pytest.mark.exact
def test_fast_growth_is_that_of_plane_shear_waves():
    """Far above cS / a every point radiates by itself: W = G s / (2 cS)."""
    assert length_number(40.0) == pytest.approx(40.0 * (1.0 - SOLID.poisson_ratio), rel=0.03)


@pytest.mark.exact
def test_more_weakening_grows_faster():
    numbers = [length_number(rate) for rate in (0.0, 1e-3, 0.05, 0.2, 1.0, 3.0)]
    assert np.all(np.diff(numbers) > 0.0) and numbers[1] == pytest.approx(numbers[0], rel=1e-5)
