"""Tables of measured friction, converted to SI."""

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.recordings.friction import measured_friction

GIVEN = {"friction": ([40.0, 42.0, np.nan], "%", "file: columns.friction"),
         "pressure": ([1.0, 2.0, 3.0], "MPa", "file: columns.pressure"),
         "speed": ([3.6, 36.0, 36.0], "km/h", "file: columns.speed"),
         "temperature": ([20.0, 120.0, 120.0], "degC", "file: values.temperature")}


def test_units_are_converted_and_rows_with_a_gap_left_out():
    table = measured_friction(GIVEN, "file")
    np.testing.assert_allclose(table.friction, [0.40, 0.42])
    np.testing.assert_allclose(table.pressure, [1e6, 2e6])
    np.testing.assert_allclose(table.speed, [1.0, 10.0])
    np.testing.assert_allclose(table.temperature, [293.15, 393.15])
    assert not table.friction_std.any() and not table.distance.any()


@pytest.mark.parametrize("change, message", [
    ({"speed": None}, "file: expected columns or values among friction, .* found none beside them, no speed"),
    ({"load": ([1.0] * 3, "N", "file")}, "found load beside them"),
    ({"pressure": ([1.0] * 3, "N", "file: columns.pressure")}, "columns.pressure.unit: expected a unit of Pa, found N"),
    ({"speed": ([np.nan] * 3, "m/s", "file")}, "a row without missing numbers")])
def test_what_is_no_friction_is_refused(change, message):
    given = {k: v for k, v in {**GIVEN, **change}.items() if v is not None}
    with pytest.raises(ConfigError, match=message):
        measured_friction(given, "file")
