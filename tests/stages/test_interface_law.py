"""The stage from given summits and from surfaces."""

import numpy as np
import pytest

from pipeline.contract import ConfigError, Context
from stages.interface_law import Settings, interface_law
from stages.surface import Settings as SurfaceSettings
from stages.surface import surface
from tests.stages.small_pin import SUMMITS, small_law

pytestmark = pytest.mark.exact


def rough(rms):
    plain = {"kind": "generated", "rms_height": rms, "roughness_wavelength": "80 um"}
    return surface(SurfaceSettings(nodes=128, patch_length="256 um", shortest_wavelength="16 um",
                                   disc={**plain, "feed": "64 um", "outbreak_share": 0},
                                   pad={**plain, "plateau_height": 0, "plateau_roughness": 1}), context=Context())


def test_friction_is_the_yield_stress_on_the_real_area():
    law = small_law()
    area = np.interp(law.pressure[2:-1], law.gap_pressure, law.real_area)
    assert law.friction[2:-1] == pytest.approx(385e6 * area / law.pressure[2:-1], rel=1e-2)
    assert law.limit == pytest.approx(law.shear[:, -1], rel=1e-6)


def test_descriptions_start_and_end_with_the_law():
    law = small_law()
    assert np.abs(law.evolution_shear - law.shear).max(axis=1) == pytest.approx(0, abs=0.05 * law.limit.max())
    assert law.elastic_shear[:, -1] == pytest.approx(law.limit)
    assert ((law.exponent > 1 / 3) & (law.exponent < 1)).all()


def test_rougher_surfaces_rub_less_and_yield_more():
    """Steeper summits carry the load on less area: friction falls as 1 / rms, and so does the stiffness."""
    fine, coarse = (interface_law(rough(rms), Settings(pressure_steps=3), context=Context()) for rms in
                    ("0.3 um", "0.6 um"))
    assert fine.friction[1] / coarse.friction[1] == pytest.approx(2, rel=0.1)
    stiffness = [np.interp(1e6, law.gap_pressure, law.normal_stiffness) for law in (fine, coarse)]
    assert stiffness[0] / stiffness[1] == pytest.approx(2, rel=0.1)


def test_what_is_missing_is_said():
    with pytest.raises(ConfigError, match="kind: given"):
        interface_law(None, Settings(), context=Context())
    with pytest.raises(ConfigError, match="above the lowest"):
        interface_law(None, Settings(summits=SUMMITS, highest_pressure="1 Pa"), context=Context())
