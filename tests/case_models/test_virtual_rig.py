"""A bench from a section: sensors, groups, corrections."""

from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.case_models import virtual_rig as benches
from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
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
