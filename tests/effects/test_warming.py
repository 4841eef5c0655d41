"""The time constant that effects of temperature share."""

import pytest

from pipeline.effects import named
from pipeline.effects.typical import Typical
from pipeline.effects.warming import warming_time


@pytest.mark.parametrize("effect", ["thermal_softening", "thermal_coning", "hot_spots", "thermal_fade"])
def test_what_has_settled_at_once_has_not_warmed_up(effect):
    """A time constant far below the run makes a joint softer from the begin: another value, not a temperature."""
    time = next(p for p in named(effect).parameters(Typical(time=8.0)) if p.name == "time")
    assert time.within[0] == 0.4 < time.nominal and time == warming_time(Typical(time=8.0))
