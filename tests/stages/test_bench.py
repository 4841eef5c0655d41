"""Stage bench: predictions beside recordings."""

import numpy as np
import pytest

from pipeline.contract import ConfigError
from stages.bench import bench
from stages.effects import effects as effects_stage
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


def test_a_bench_without_sensors_is_refused():
    with pytest.raises(ConfigError, match="bench.channels"):
        bench.check({"bench": laid_out(channels={})})
