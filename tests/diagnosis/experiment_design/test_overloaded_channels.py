"""Overloaded channels in words."""

import numpy as np
import pytest

from pipeline.diagnosis.experiment_design.overloaded_channels import overload_told
from pipeline.recordings.samples import channel

TIME = np.arange(20000) / 2e4
HELD = np.clip(9.0 * np.sin(2 * np.pi * 613.7 * TIME), -7.5, 7.5)


@pytest.mark.parametrize("unit, measures", [("Pa", "sound_pressure"), ("Pa", "pressure"), ("m/s^2", "acceleration"),
                                            ("m/s", "velocity"), ("N", "force")])
def test_what_swings_is_told_with_its_range(unit, measures):
    told = overload_told(channel(HELD, unit, measures, 2e4, 0.0, "test"))
    assert told.startswith("37 % of the samples stand at the end of the range, 7.5 ") and f" {unit}: over" in told
    assert not overload_told(channel(9.0 * np.sin(2 * np.pi * 613.7 * TIME), unit, measures, 2e4, 0.0, "test"))


def test_what_rests_at_an_end_is_none():
    assert not overload_told(channel(HELD, "V", "voltage", 2e4, 0.0, "test"))
    assert not overload_told(channel(1e6 + 1e5 * HELD, "Pa", "pressure", 2e4, 0.0, "test"))
