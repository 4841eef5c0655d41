"""Wear that is not in proportion to the pressure."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.effects.typical import ASPERITIES
from tests.effects.rough_pair import CYCLES, DISC, PAD, rubbed, rubbing


@pytest.mark.exact
@pytest.mark.parametrize("pressure", [1e6, 2e6, 3e6])
def test_the_worn_volume_goes_with_a_power_of_the_pressure(pressure):
    """V = k P (P / P_0)^a s per area; at P = P_0 everything is as Archard has it, bit for bit."""
    found = rubbed(named("wear_law").on(rubbing(), ASPERITIES, {"exponent": 0.5, "pressure": 2e6}), pressure)
    volume = pressure * (pressure / 2e6) ** 0.5 * CYCLES * 2e-3
    assert found.maps.pad_wear[-1].mean() == pytest.approx(PAD * volume, rel=1e-12)
    assert found.maps.disc_wear[-1].mean() == pytest.approx(DISC * volume, rel=1e-12)
    if pressure == 2e6:
        np.testing.assert_array_equal(found.friction, rubbed(rubbing()).friction)
