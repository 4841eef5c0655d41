"""Friction joints under the load of a run."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.time_stepping.simulate import Hard
from pipeline.physics.virtual_rig.normal_load import loaded
from pipeline.physics.virtual_rig.response import respond
from pipeline.physics.virtual_rig.sensor import DISPLACEMENT, FRICTION_FORCE, Sensor
from tests.effects.benches import slider, steady

STIFFNESS = 2e4


def jointed(description="elastic"):
    """The slider on a stiff arm, held down by 40 N of its own, the belt at rest first."""
    bench = slider(Hard(), constant(0.3, description=description, stiffness=STIFFNESS), speed=0.0)
    contacts = replace(bench.model.contacts, normal=np.zeros((1, 2)), preload=np.array([40.0]))
    joints = replace(bench.model.joints, stiffness=np.array([1e6]), damping=np.array([500.0]))
    return replace(bench, model=replace(bench.model, contacts=contacts, joints=joints), channels=(
        Sensor("t", FRICTION_FORCE, "contact"), Sensor("x", DISPLACEMENT, "sensor_0")), settled=False)


def run(load=None):
    start = steady(0.0, 0.5)
    return replace(start, inputs={}, drive=2e-2 * start.time, conditions={} if load is None else {"normal_load": load})


@pytest.mark.exact
@pytest.mark.parametrize("load", [10.0, 80.0])
def test_friction_and_stiffness_are_proportional_to_the_load(load):
    """T = min(k N / N0 s, mu N) over the way s of the belt against the mass."""
    found = respond(jointed(), run(load))
    way = 1e-2 * run().time**2 - found["x"]
    np.testing.assert_allclose(found["t"], np.minimum(STIFFNESS * load / 40 * way, 0.3 * load), atol=0.01 * load)
    assert found["t"][-1] == pytest.approx(0.3 * load)


def test_the_load_of_the_model_changes_nothing():
    for description in ("elastic", "rigid"):
        bench = jointed(description)
        for name, values in respond(bench, run()).items():
            np.testing.assert_array_equal(respond(bench, run(40.0))[name], values)


def test_contacts_that_press_on_their_own_are_left_alone():
    bench = slider()
    assert loaded(bench, run(5.0)) is bench


@pytest.mark.parametrize("load", [0.0, -1.0])
def test_a_joint_without_a_load_is_refused(load):
    with pytest.raises(ConfigError, match="normal_load"):
        loaded(jointed(), run(load))
