"""The tangential law: its table where it is known, power laws exactly between, nothing beyond."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.friction.tangential_law import TangentialLaw

pytestmark = pytest.mark.exact
PRESSURE = np.array([1e3, 1e5, 1e8])
LAW = TangentialLaw(PRESSURE, 0.5 * PRESSURE**-0.02, 1e6 * PRESSURE**0.9, 6e5 * PRESSURE**0.9, np.full(3, 0.57))


def test_power_laws_are_read_exactly():
    found = LAW.at([1e3, 3e6])
    assert found.friction == pytest.approx(0.5 * found.pressure**-0.02, rel=1e-12)
    assert found.stiffness == pytest.approx(1e6 * found.pressure**0.9, rel=1e-12)
    assert found.elastic_stiffness == pytest.approx(0.6 * found.stiffness, rel=1e-12)
    assert found.exponent == pytest.approx(0.57)


def test_friction_over_pressure_is_that_of_the_table_and_does_not_depend_on_speed():
    law = LAW.friction_law()
    for speed in (0.0, 5.0):
        assert law.evaluate(PRESSURE, speed, 0.0)[0] == pytest.approx(LAW.friction)


def test_what_lies_outside_and_what_is_missing_is_said():
    with pytest.raises(ConfigError, match="1e\\+03 to 1e\\+08 Pa, found 100 Pa"):
        LAW.at(100.0)
    nothing = TangentialLaw(*[np.empty(0)] * 5)
    for asked in (lambda: nothing.at(1e5), nothing.friction_law):
        with pytest.raises(ConfigError, match="friction"):
            asked()
