"""The map on a coarse mesh: lock-in of the matched pin, silence without friction, bad input."""

import numpy as np
import pytest

from pipeline.contract import ConfigError
from stages.lock_in import Settings, lock_in
from stages.lock_in import _check as check
from tests.stages.small_pin import CONTEXT, small_pin, small_system

ONE = {"cases": [{"length": "151.5 mm"}], "lengths": 1, "shortest": "130 mm", "loads": ["1.5 kg"],
       "speeds": ["2.4 rpm"], "tilts": ["-2 deg"], "fixed_below": "6 kHz", "residual_below": "100 kHz"}


@pytest.fixture(scope="module")
def found():
    return lock_in(*small_system(), None, Settings(**ONE), context=CONTEXT)


def test_every_scan_has_its_points(found):
    assert list(found.scan) == ["case", "length", "load", "speed", "tilt"]
    assert found.length == pytest.approx([0.1515, 0.13, 0.1515, 0.1515, 0.1515])
    assert np.degrees(found.tilt) == pytest.approx([4, 4, 4, 4, -2])


@pytest.mark.published
def test_pin_and_disc_lock_in_where_the_paper_says(found):
    """2215 Hz measured at 151.5 mm, +-25 Hz."""
    assert found.kind[0] in ("classical", "intermediate")
    assert found.base[0] == pytest.approx(2215, abs=25)
    assert found.harmonics[0][1] >= 3


@pytest.mark.exact
def test_the_same_point_twice_gives_the_same_bits(found):
    for name in ("root", "base", "amplitude", "levels"):
        values = getattr(found, name)
        assert np.array_equal(values[0], values[2]) and np.array_equal(values[0], values[3])


@pytest.mark.exact
def test_nothing_grows_without_friction():
    still = lock_in(*small_system(), None, Settings(**{**ONE, "friction": 0.0}), context=CONTEXT)
    assert not still.root.any() and set(still.kind) == {"none"} and not still.base.any()


def test_nothing_grows_below_a_limit_without_modes():
    found = lock_in(*small_system(), None, Settings(**{**ONE, "highest_mode": "1 Hz"}), context=CONTEXT)
    assert not found.root.any()


@pytest.mark.exact
def test_bad_input():
    with pytest.raises(ValueError, match="greater than or equal"):
        Settings(friction=-0.1)
    with pytest.raises(ConfigError, match="duration"):
        check({"lock_in": Settings(window="1 s")})
    with pytest.raises(ConfigError, match="hard"):
        lock_in(small_pin(contact={"hard": True}), small_system()[1], None, Settings(**ONE), context=CONTEXT)
