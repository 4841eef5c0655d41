"""Recorded runs in the form of a bench, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.benches.runs import check_units, recorded
from pipeline.contract import ConfigError
from tests.diagnosis.small_rig import RATE, SAMPLES, force, laid_out, recording


def test_inputs_samples_and_conditions_arrive():
    one = recorded(recording(), laid_out())["level_2"]
    assert one.run.samples == SAMPLES and one.run.sample_rate == RATE and one.channels == ("x",)
    np.testing.assert_allclose(one.run.inputs["shaker"], force(5.0, 1))
    assert one.run.conditions == {"level": 5.0} and one.valid.all()


def test_missing_samples_are_masked():
    found = recording()
    run = found.runs["level_1"]
    gap = replace(run.channels["x"], missing=np.array([[3, 5]]))
    runs = {"level_1": replace(run, channels={**run.channels, "x": gap})}
    one = recorded(replace(found, runs=runs), laid_out())["level_1"]
    assert np.flatnonzero(~one.valid[0]).tolist() == [3, 4]


@pytest.mark.parametrize("more, said", [
    ({"channels": {"y": {"quantity": "displacement", "source": "block"}}}, "bench.channels"),
    ({"inputs": {"shaker": {"channel": "forc"}}}, "bench.inputs.shaker.channel")])
def test_channels_that_were_not_recorded_are_refused(more, said):
    with pytest.raises(ConfigError, match=said):
        recorded(recording(), laid_out(**more))


def test_units_must_fit_what_a_channel_shows():
    settings = laid_out(channels={"x": {"quantity": "velocity", "source": "block"}})
    with pytest.raises(ConfigError, match="m/s"):
        check_units(recorded(recording(), settings), settings)
