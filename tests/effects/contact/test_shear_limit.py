"""The shear limit of a third body: mu = f tau_0 A / P + a in full slip."""

import numpy as np
import pytest

from pipeline.effects import named
from pipeline.effects.typical import ASPERITIES
from tests.effects.rough_pair import LIMIT, rubbed, rubbing


@pytest.mark.exact
@pytest.mark.parametrize("pressure", [1e6, 3e6])
@pytest.mark.parametrize("factor, slope", [(0.1, 0.0), (1.0, 0.2), (0.3, 0.05)])
def test_friction_is_limit_times_area_over_pressure_and_the_slope(factor, slope, pressure):
    plain = rubbing(rate=0.0, softening=0.0)
    values = {"factor": factor, "pressure_coefficient": slope}
    found = rubbed(named("shear_limit").on(plain, ASPERITIES, values), pressure)
    np.testing.assert_allclose(found.friction, factor * LIMIT * found.real_area / pressure + slope, rtol=1e-4)
    np.testing.assert_array_equal(found.real_area, rubbed(plain, pressure).real_area)


@pytest.mark.exact
def test_a_factor_is_a_factor_on_friction():
    """Without softening by heat: the rate term multiplies the limit."""
    plain = rubbing(softening=0.0)
    found = rubbed(named("shear_limit").on(plain, ASPERITIES, {"factor": 0.1, "pressure_coefficient": 0.0}))
    np.testing.assert_allclose(found.friction, 0.1 * rubbed(plain).friction, rtol=1e-6)
