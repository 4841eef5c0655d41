"""Values of effects that a case states are numbers of its bench."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.case_models import corrections
from pipeline.case_models.effect_block import Settings, product, with_bare, with_effects
from pipeline.case_models.virtual_rig import Settings as BenchSettings
from pipeline.case_models.virtual_rig import built
from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from pipeline.physics.virtual_rig.response import Run, respond
from stages.lumped import Settings as LumpedSettings
from stages.lumped import lumped
from stages.reduced_model import Settings as ReductionSettings
from stages.reduced_model import reduced_model

LUMPED = {"masses": {"block": {"mass": "1 kg", "moves": ["x"]}},
          "springs": {"tie": {"between": ["block.x", "ground"], "stiffness": "400 N/m", "damping": "1 N s/m"}},
          "inputs": {"pull": {"along": {"block.x": 1}, "force": "1 N"}},
          "sensors": {"x": {"along": {"block.x": 1}, "quantity": "displacement", "unit": "m"}}}
BENCH = {"step": "1 ms", "channels": {"x": {"quantity": "displacement", "source": "x"}}}
TIME = np.arange(500) / 250
RUN = Run("a", 499 / 250, 250.0, {"pull": 5 * np.sin(12 * TIME)})
FORCE, STIFFNESS = "coulomb@tie.force", "joints.tie.stiffness"


def bench(**effects):
    whole = built(reduced_model(lumped(settings=fill(LumpedSettings, LUMPED, "lumped")), settings=ReductionSettings()),
                  fill(BenchSettings, BENCH, "bench"))
    return with_effects(whole, product(fill(Settings, effects, "effects")))


def test_another_value_is_as_if_it_had_been_stated():
    changed = corrections.corrected(bench(coulomb={"tie": {"force": "1 N"}}), {FORCE: 2.0, STIFFNESS: 500.0})
    stated = corrections.corrected(bench(coulomb={"tie": {"force": "2 N"}}), {STIFFNESS: 500.0})
    assert np.array_equal(respond(changed, RUN)["x"], respond(stated, RUN)["x"])
    assert corrections.nominal(changed, FORCE) == 2.0 and corrections.known(changed)[FORCE] == "N"
    assert not corrections.is_factor(FORCE)


def test_several_values_of_one_effect_and_other_effects_stay():
    two = bench(coulomb={"tie": {"force": "1 N"}}, cubic_stiffness={"tie": {"coefficient": "1e5 N/m^3"}})
    changed = corrections.corrected(two, {FORCE: 3.0})
    assert corrections.nominal(changed, "cubic_stiffness@tie.coefficient") == 1e5
    assert np.array_equal(respond(corrections.corrected(changed, {FORCE: 1.0}), RUN)["x"], respond(two, RUN)["x"])


def test_an_effect_at_its_null_has_values_and_does_nothing():
    none = bench(coulomb={"tie": {"force": "0 N"}})
    assert corrections.nominal(none, FORCE) == 0.0
    assert np.array_equal(respond(none, RUN)["x"], respond(bench(), RUN)["x"])


def test_what_is_not_stated_has_no_value():
    with pytest.raises(ConfigError, match="coulomb@tie.force"):
        corrections.nominal(bench(), FORCE)


def test_a_change_of_the_bench_outlives_another_value():
    slower = with_bare(bench(coulomb={"tie": {"force": "1 N"}}), lambda each: replace(each, step=5e-4))
    assert corrections.corrected(slower, {FORCE: 2.0}).step == 5e-4
