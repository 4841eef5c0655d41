"""A bench from a section: sensors, groups, corrections."""

from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.effect_block import Settings as EffectSettings
from pipeline.case_models.effect_block import product, with_effects
from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from pipeline.physics.virtual_rig.response import Run, respond
from stages.lumped import Settings as LumpedSettings
from stages.lumped import lumped
from stages.reduced_model import Settings as ReductionSettings
from stages.reduced_model import reduced_model
from tests.diagnosis import pin_rig
from tests.diagnosis.small_rig import laid_out, model
from tests.stages.small_brake import small_brake


def test_sensors_and_corrected_values():
    found = benches.built(model(), laid_out(corrections={"masses.block": "1.5 kg"}))
    assert [c.name for c in found.channels] == ["x"] and found.model.mass[0, 0] == pytest.approx(1.5)


def test_a_sensor_of_something_unknown_is_refused():
    with pytest.raises(ConfigError, match="bench.channels.x.source"):
        benches.built(model(), laid_out(channels={"x": {"quantity": "displacement", "source": "blok"}}))


def test_a_row_that_the_preload_table_lacks_is_refused():
    with pytest.raises(ConfigError, match="bench.state: expected a row of the preload table, 0 to 0, found 5"):
        benches.built(model(), laid_out(state=5))


def test_one_body_is_no_group():
    assert benches.groups(model()) == {}


def test_equal_modes_of_a_body_are_places():
    """A second coordinate of the block, alike and by itself."""
    one = model()
    two = dict(coordinate_body=np.zeros(2, int), joint_name=["first", "second"], joint_rows=np.eye(2),
               sensor_rows=np.eye(2)[:1], joint_stiffness=np.full(2, 400.0), joint_damping=np.zeros(2),
               input_rows=np.eye(2)[:1],
               **{name: np.empty((0, 2)) for name in ("contact_normal", "contact_tangent", "contact_lateral")},
               **{name: np.zeros((2, 2)) for name in ("damping", "gyroscopic", "stiffness", "centrifugal")})
    pair = SimpleNamespace(**{**vars(one), **two, "mass": np.eye(2)})
    assert benches.built(pair, laid_out()).doublets == {"block 1": (0, 1)}
    assert benches.built(one, laid_out()).doublets == {}


def test_contacts_have_the_names_of_the_case():
    """One contact of a belt, and those of two bodies; hundreds that nobody named are none."""
    assert benches.contact_names(reduced(pin_rig.LUMPED)) == {"contact": ("tip",)}
    parts = {"masses": {name: {"mass": "1 kg", "moves": ["x"]} for name in ("left", "right")},
             "springs": {}, "contacts": {f"shoe_{name}": {"tangent": {f"{name}.x": 1}, "normal_force": "5 N"}
                                         for name in ("left", "right")}}
    assert benches.contact_names(reduced(parts)) == {"contact": ("shoe_left", "shoe_right"), "left": ("shoe_left",),
                                                       "right": ("shoe_right",)}
    assert benches.contact_names(small_brake()) == {}


def reduced(parts):
    """Product ReducedModel of a section ``lumped``."""
    return reduced_model(lumped(settings=fill(LumpedSettings, parts, "lumped")), settings=ReductionSettings())


def test_the_signs_of_channels_are_those_of_the_table_in_the_docs():
    """A block pulled forward by a force, by the far end of its spring, and dragged forward by a belt."""
    def shown(document, channels, effects=None, run=None, **bench):
        made = reduced_model(lumped(settings=fill(LumpedSettings, document, "lumped")),
                             settings=ReductionSettings())
        whole = benches.built(made, fill(benches.Settings, {"step": "1 ms", "channels": channels, **bench}, "bench"))
        whole = with_effects(whole, product(fill(EffectSettings, effects or {}, "effects")))
        return {name: float(np.mean(values[-200:])) for name, values in respond(whole, run).items()}

    block = {"masses": {"block": {"mass": "1 kg", "moves": ["x"]}},
             "springs": {"tie": {"between": ["block.x", "ground"], "stiffness": "400 N/m", "damping": "20 N s/m"}},
             "sensors": {"x": {"along": {"block.x": 1}, "quantity": "displacement", "unit": "m"}}}
    pulled = {**block, "inputs": {"pull": {"along": {"block.x": 1}, "force": "1 N"}}}
    seen = shown(pulled, {"x": {"quantity": "displacement", "source": "x"},
                          "tension": {"quantity": "joint_force", "source": "tie"},
                          "cubic": {"quantity": "element_force", "source": "cubic_stiffness tie"},
                          "force": {"quantity": "input", "source": "pull"}},
                 {"cubic_stiffness": {"tie": {"coefficient": "1e5 N/m^3"}}},
                 Run("a", 2.0, 500.0, {"pull": np.full(1001, 4.0)}))
    assert min(seen.values()) > 0 and seen["tension"] + seen["cubic"] == pytest.approx(4.0, rel=1e-3)
    led = {**block, "inputs": {"end": {"displaces": "tie", "displacement": "1 m"}}}
    seen = shown(
        {**led, "springs": {**block["springs"], "face": {"between": ["block.x", "ground"], "damping": "50 N s/m"}}},
        {"x": {"quantity": "displacement", "source": "x"}, "tension": {"quantity": "joint_force", "source": "tie"}},
        run=Run("a", 2.0, 500.0, {"end": 0.1 * np.arange(1001) / 500}))
    assert seen["x"] > 0 > seen["tension"], "an end that is led forward presses its spring together"
    belt = {**block, "contacts": {"belt": {"tangent": {"block.x": 1}, "normal_force": "10 N"}}}
    seen = shown(belt, {"x": {"quantity": "displacement", "source": "x"},
                        "load": {"quantity": "normal_force", "source": "contact"},
                        "drag": {"quantity": "friction_force", "source": "contact"}},
                 run=Run("a", 2.0, 500.0, drive=1.0), friction=0.3)
    assert seen["x"] > 0 and seen["load"] == pytest.approx(10) and seen["drag"] == pytest.approx(3)
