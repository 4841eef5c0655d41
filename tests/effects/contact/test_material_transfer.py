"""Transfer between the bodies: nothing is lost, and the disc grows where more sticks than it loses."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.effects.typical import ASPERITIES
from tests.effects.rough_pair import CYCLES, DISC, PAD, rubbed, rubbing


@pytest.mark.exact
@pytest.mark.parametrize("share", [0.05, 0.1, 0.6])
def test_what_the_disc_gains_the_pad_has_lost(share):
    """Mean depths: pad k_pad P s as without, disc (k_disc - f k_pad) P s; nothing at f = k_disc / k_pad."""
    found = rubbed(named("material_transfer").on(rubbing(), ASPERITIES, {"share": share}))
    loaded = 2e6 * CYCLES * 2e-3
    assert found.maps.pad_wear[-1].mean() == pytest.approx(PAD * loaded, rel=1e-12)
    assert found.maps.disc_wear[-1].mean() == pytest.approx((DISC - share * PAD) * loaded, rel=1e-9, abs=1e-18)


@pytest.mark.exact
def test_material_sticks_where_the_pair_touches():
    found = rubbed(named("material_transfer").on(rubbing(), ASPERITIES, {"share": 0.6}))
    plain = rubbed(rubbing())
    assert np.all(found.maps.disc_wear[-1][plain.maps.contact_pressure[0] > 0] < 0)
    assert np.all(found.maps.disc_wear[-1] <= 0) and np.all(found.friction[:, -1] < plain.friction[:, -1])
