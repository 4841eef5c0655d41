"""A balance of forces asks for no mass and no step."""

import numpy as np
import pytest

from pipeline.case_models import virtual_rig
from pipeline.case_models.force_balance import balance
from pipeline.case_models.runs import Recorded
from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from pipeline.diagnosis.signals.balanced_bench import balanced_bench
from pipeline.physics.virtual_rig.response import Run
from stages import lumped as stage
from stages.lumped import Settings
from stages.reduced_model import Settings as ReductionSettings
from stages.reduced_model import reduced_model

LUMPED = {"masses": {"bar": {"moves": ["x"]}},
          "springs": {"bar": {"between": ["bar.x", "ground"], "stiffness": "3 N/m"}},
          "inputs": {"pull": {"along": {"bar.x": 1}, "force": "1 N"}},
          "sensors": {"x": {"along": {"bar.x": 1}, "quantity": "displacement", "unit": "m"}}}
BENCH = {"forward": "equation", "channels": {"x": {"quantity": "displacement", "source": "x"}},
         "inputs": {"pull": {"channel": "pull"}}}


def test_a_bar_without_mass_is_balanced_and_vibrates_far_above_its_samples():
    settings = fill(virtual_rig.Settings, BENCH, "bench")
    bench = virtual_rig.built(reduced_model(stage.lumped(settings=fill(Settings, LUMPED, "lumped")),
                                            settings=ReductionSettings()), settings)
    motion = np.sin(np.linspace(0, 20, 200))
    record = Recorded(Run("a", 199.0, 1.0, {"pull": 3 * motion}), ("x",), ("m",), motion[None],
                      np.ones((1, 200), bool), "")
    ready = balanced_bench(bench, {"a": record})
    for each in (bench, ready):
        found = balance(each, record, settings.equation)
        assert found.predicted(each) == pytest.approx(found.seen.samples, abs=2e-3)
    assert np.sqrt(3 / ready.model.mass[0, 0]) == pytest.approx(20 * np.pi) and ready.step < 0.1


def test_elsewhere_a_mass_is_asked_for():
    sections = {"lumped": fill(Settings, LUMPED, "lumped"), "bench": fill(virtual_rig.Settings, BENCH, "bench")}
    stage.lumped.check(sections)
    with pytest.raises(ConfigError, match="lumped.masses.bar.mass: expected above 0 kg"):
        stage.lumped.check({"lumped": sections["lumped"]})
