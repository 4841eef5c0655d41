"""Stage bench: predictions beside recordings."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract import ConfigError
from stages.bench import bench
from stages.effects import effects as effects_stage
from tests.diagnosis import small_bench
from tests.diagnosis.features import test_stops
from tests.diagnosis.small_rig import HIDDEN, NOISE, effects, laid_out, model, recording


def test_the_true_model_leaves_the_noise():
    found = bench(model(), effects(HIDDEN), recording(HIDDEN), settings=laid_out())
    for run in found.runs.values():
        assert run.root_mean_square == pytest.approx([NOISE], rel=0.1)
        assert run.error == pytest.approx(run.root_mean_square / run.measured.std(axis=1))


def test_without_the_effect_more_is_left():
    found = bench(model(), effects_stage(settings=effects_stage.settings()), recording(HIDDEN), settings=laid_out())
    assert found.runs["level_3"].error[0] > 0.3 and list(found.unit) == ["m"]
    assert np.all(found.runs["level_3"].valid == 1)


def test_stops_are_told_one_by_one(monkeypatch):
    whole = small_bench.bench(test_stops.FALLING)
    records = test_stops.stops(whole, 2)
    silent = records["stop_hard_1"]
    records["stop_hard_1"] = replace(silent, samples=3e-5 * np.random.default_rng(0).standard_normal(
        silent.samples.shape))
    monkeypatch.setattr("stages.bench.recorded", lambda *_: records)
    settings = small_bench.laid_out(poles={"low": "40 Hz", "high": "400 Hz", "onset": {"runs": ["stop_*"]}})
    stops = bench(small_bench.model(), None, recording(), settings=settings).stops
    assert set(stops) == {"stop_soft_0", "stop_hard_0"} and list(stops["stop_hard_0"].stop) == [
        "stop_hard_0", "stop_hard_1"]
    growth, reason = stops["stop_hard_0"].growth_rate, list(stops["stop_hard_0"].reason)
    assert growth[0] == pytest.approx(19.9, rel=0.02) and growth[1] == 0
    assert reason[0] == "" and "outgrows the noise floor" in reason[1]


def test_a_bench_without_sensors_is_refused():
    with pytest.raises(ConfigError, match="bench.channels"):
        bench.check({"bench": laid_out(channels={})})


def test_poles_are_one_sample_a_feature(monkeypatch):
    """Free vibrations of the true bench: features within a few of their standard deviations."""
    whole = small_bench.bench()
    monkeypatch.setattr("stages.bench.recorded", lambda recording, settings, model: small_bench.recorded(whole))
    found = bench(small_bench.model(), None, None, settings=small_bench.laid_out())
    assert set(found.runs) == {*small_bench.RUNS, "turned"} and "pole 1 frequency" in list(found.channel)
    assert max(run.error[run.valid[:, 0] == 1].max() for run in found.runs.values()) < 4
