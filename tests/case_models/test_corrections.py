"""Nominal numbers of a bench: read, changed, refused; a change does what the model with other values does."""

import numpy as np
import pytest

from pipeline.case_models import corrections
from pipeline.case_models import virtual_rig as benches
from pipeline.contract import ConfigError
from pipeline.physics.virtual_rig.response import Run, respond
from tests.diagnosis.small_rig import RATE, force, laid_out, model

RUN = Run("level", 1.0, RATE, {"shaker": force(3.0, 1)[:201]})


def bench():
    return benches.built(model(), laid_out())


@pytest.mark.parametrize("name, value", [("joints.mount.stiffness", 400.0), ("joints.mount.damping", 1.2),
                                         ("masses.block", 1.0), ("bodies.block.mass", 1.0), ("inputs.shaker.gain", 1.0),
                                         ("inputs.shaker.offset", 0.0), ("channels.x.gain", 1.0)])
def test_nominal_values(name, value):
    assert corrections.nominal(bench(), name) == pytest.approx(value)


def test_every_number_can_be_changed_and_keeps_the_rest():
    base = respond(bench(), RUN)["x"]
    for name in corrections.known(bench()):
        value = corrections.nominal(bench(), name)
        same = respond(corrections.corrected(bench(), {name: value}), RUN)["x"]
        np.testing.assert_allclose(same, base, rtol=1e-9, atol=1e-12 * abs(base).max(), err_msg=name)
        other = respond(corrections.corrected(bench(), {name: 1.1 * value + 0.01}), RUN)["x"]
        if name != "bodies.block.stiffness":       # all its stiffness is in the joint
            assert abs(other - base).max() > 1e-4 * abs(base).max(), name


@pytest.mark.exact
def test_frequency_and_damping_are_those_of_a_body_with_its_own_joints():
    """k -> f^2 k and c -> d c of the mount, at the same mass."""
    joints = corrections.corrected(bench(), {"bodies.block.frequency": 1.1, "bodies.block.damping": 2.0}).model.joints
    np.testing.assert_allclose((joints.stiffness[0], joints.damping[0]), (1.21 * 400.0, 2 * 1.2), rtol=1e-12)


@pytest.mark.exact
def test_a_modal_mass_keeps_frequency_and_damping_ratio():
    """m, c and k of block and mount times 1.3: the same free vibration, 1 / 1.3 of it under the same force."""
    heavy = corrections.corrected(bench(), {"bodies.block.modal_mass": 1.3})
    np.testing.assert_allclose((heavy.model.mass[0, 0], heavy.model.joints.stiffness[0], heavy.model.joints.damping[0]),
                               1.3 * np.array([1.0, 400.0, 1.2]), rtol=1e-12)
    np.testing.assert_allclose(respond(heavy, RUN)["x"], respond(bench(), RUN)["x"] / 1.3, rtol=1e-9, atol=1e-12)


def test_an_offset_is_a_constant_force():
    """Static deflection under 5 N: 5 / 400 m."""
    still = Run("still", 30.0, RATE)
    pushed = respond(corrections.corrected(bench(), {"inputs.shaker.offset": 5.0}), still)["x"]
    assert pushed[-1] == pytest.approx(5.0 / 400.0, rel=1e-4)


def test_mass_by_value_and_by_factor_agree():
    one, other = (respond(corrections.corrected(bench(), c), RUN)["x"] for c in (
        {"masses.block": 1.3}, {"bodies.block.mass": 1.3}))
    np.testing.assert_array_equal(one, other)


@pytest.mark.parametrize("given, said", [({"joints.mont.stiffness": "1 N/m"}, "did you mean 'joints.mount"),
                                         ({"joints.mount.stiffness": "1 kg"}, "N/m"),
                                         ({"masses.block": "-1 kg"}, "masses.block: expected a value above 0"),
                                         ({"bodies.block.frequency": 0}, "expected a value above 0, found 0")])
def test_wrong_names_and_units_are_refused(given, said):
    with pytest.raises(ConfigError, match=said):
        corrections.read(bench(), given, "bench.corrections")


def test_factors_are_those_that_one_leaves_as_they_are():
    factors = ("friction", "friction.stiffness", "contact.stiffness", "bodies.pad.mass", "inputs.press.gain")
    assert all(map(corrections.is_factor, factors))
    assert not any(map(corrections.is_factor, ("joints.a.b.stiffness", "masses.block", "channels.x.gain",
                                               "inputs.press.offset", "contact.damping")))
