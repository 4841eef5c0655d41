"""A bench from a section: sensors, groups, corrections."""

import pytest

from pipeline.benches import bench as benches
from pipeline.contract import ConfigError
from tests.diagnosis.small_rig import laid_out, model


def test_sensors_and_corrected_values():
    found = benches.built(model(), laid_out(corrections={"masses.block": "1.5 kg"}))
    assert [c.name for c in found.channels] == ["x"] and found.model.mass[0, 0] == pytest.approx(1.5)


def test_a_sensor_of_something_unknown_is_refused():
    with pytest.raises(ConfigError, match="bench.channels.x.source"):
        benches.built(model(), laid_out(channels={"x": {"quantity": "displacement", "source": "blok"}}))


def test_one_body_is_no_group():
    assert benches.groups(model()) == {}
