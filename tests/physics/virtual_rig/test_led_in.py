"""Runs that begin in steady sliding while the end of a joint moves: dry friction has settled at time 0."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.case_models import virtual_rig as benches
from pipeline.contract.settings import fill
from pipeline.effects import CATALOGUE
from pipeline.physics.virtual_rig.response import Run, led_in, respond
from stages.lumped import Settings as LumpedSettings
from stages.lumped import lumped
from stages.reduced_model import Settings as ReductionSettings
from stages.reduced_model import reduced_model
from tests.diagnosis.velocity_steps import SYSTEM

RATE, FRICTION, DRAG = 100.0, 5.0, 100.0
LAID = {"step": "2 ms", "settled": True, "inputs": {"load_point": {"channel": "point"}},
        "channels": {"load": {"quantity": "joint_force", "source": "machine"}}}


@pytest.fixture(scope="module")
def bench():
    system = fill(LumpedSettings, SYSTEM, "lumped")
    laid = benches.built(reduced_model(lumped(settings=system), settings=ReductionSettings()),
                         fill(benches.Settings, LAID, "bench"))
    coulomb, = (effect for effect in CATALOGUE if effect.name == "coulomb")
    drifting = laid.with_channels(lambda channel: replace(channel, offset=0.5, drift=0.1))
    return coulomb.apply(drifting, "face", {"force": FRICTION})


@pytest.mark.exact
def test_the_load_is_that_of_friction_from_the_first_sample(bench):
    time = np.arange(401) / RATE
    speed = np.where(time < 2.0, 1e-4, 3e-4)
    point = np.concatenate(([0.0], np.cumsum(speed[:-1]) / RATE))
    load = respond(bench, Run("a", 4.0, RATE, inputs={"load_point": point}))["load"]
    steady = (time < 1.9) | (time > 2.5)
    expected = -FRICTION - DRAG * speed + 0.5 + 0.1 * time
    np.testing.assert_allclose(load[steady], expected[steady], atol=2e-3)


def test_a_run_whose_ends_are_at_rest_begins_as_it_is(bench):
    run = Run("a", 4.0, RATE, inputs={"load_point": np.zeros(401)})
    assert led_in(bench, run) is run
    moved = Run("b", 4.0, RATE, inputs={"load_point": 1e-6 * np.arange(401.0)})
    led = led_in(bench, moved)
    assert led.samples == 401 + 200
    np.testing.assert_allclose(np.diff(led.inputs["load_point"]), 1e-6)
