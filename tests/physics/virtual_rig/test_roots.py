"""Roots of benches against closed forms and against the growth of simulated motions."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.closed_form.two_mode_flutter import onset_friction, roots_over_friction
from pipeline.physics.friction.dry_friction import constant, tabulated
from pipeline.physics.signals.oscillation import dominant_frequency, growth_rate
from pipeline.physics.time_stepping.elements import Element, Polynomial, Power
from pipeline.physics.time_stepping.simulate import Hard, Penalty, Table
from pipeline.physics.virtual_rig.response import Bench, Run, respond
from pipeline.physics.virtual_rig.roots import linearised, roots
from pipeline.physics.virtual_rig.sensor import DISPLACEMENT, Sensor
from tests.physics.lumps import belt, lumps

PRESSED = Run("pressed", 1.0, 1000.0, {"input_1": -20.0})


def rubbed(law=None, friction=None, **options):
    return Bench(belt(400.0, 0.5, **options), law or Penalty(1e4, 20.0), friction or constant(0.3), 1e-4,
                 (Sensor("x", DISPLACEMENT, "sensor_0"),))


@pytest.mark.exact
def test_falling_friction_is_a_negative_damper():
    """s^2 + (c + N dmu/dv) s + k = 0 along the belt, and the contact alone across."""
    bench = rubbed(friction=tabulated([0.0, 0.5], [0.4, 0.3]), speed=0.2)
    along = np.roots([1.0, 0.5 - 20.0 * 0.2, 400.0])
    across = np.roots([1.0, 20.0, 1e4])
    found = roots(bench, PRESSED)
    np.testing.assert_allclose(found[:2], sorted(along, key=lambda s: s.imag), rtol=1e-9)
    np.testing.assert_allclose(found[2:], sorted(across, key=lambda s: s.imag), rtol=1e-9)


@pytest.mark.exact
@pytest.mark.parametrize("share", [0.9, 1.1, 1.5])
def test_flutter_of_two_modes(share):
    stiffness = 1.1e6, 1.2e6, 1e5, 4e5
    k11, k22, k12, contact = stiffness
    mu = share * onset_friction(*stiffness)
    model = lumps([1.0, 1.0], [[1.0, 0.0], [0.0, 1.0], [1.0, 1.0]], [k11 - k12, k22 - k12 - contact, k12],
                  normal=[[0.0, 1.0]], tangent=[[1.0, 0.0]], speed=-5.0)
    found = roots(Bench(model, Penalty(contact), constant(mu), 1e-5, ()), PRESSED)
    exact = roots_over_friction(*stiffness, mu)
    np.testing.assert_allclose(sorted(found.real), sorted(np.real(exact)), atol=1e-6 * abs(exact).max())
    np.testing.assert_allclose(np.sort(abs(found.imag)), np.sort(abs(np.imag(exact))), rtol=1e-6)


@pytest.mark.exact
def test_slopes_of_tables_and_elements_where_they_stand():
    """A contact of p = 3e4 c beyond 5e3 Pa, with p / v0 of damping; k + 2 k2 x + 3 k3 x^2 of an element at x."""
    law = Table(np.array([0.0, 1.0, 2.0]), np.array([0.0, 5.0, 3e4]), 4.0)
    row = np.array([1.0, 0.0])
    bench = rubbed(law).with_elements(Element("curved", row, Polynomial(0.0, 2e4, 1e6)),
                                      Element("drag", row, Power(3.0, 1.0)))
    mass, damping, stiffness = linearised(bench, PRESSED)
    x = np.roots([1e6, 2e4, 400.0, -0.3 * 20.0])
    x = x[abs(x.imag) < 1e-12].real[0]
    assert stiffness[0, 0] == pytest.approx(400 + 4e4 * x + 3e6 * x**2, rel=1e-9)
    assert (damping[0, 0], damping[1, 1]) == pytest.approx((3.5, 20.0 / 4.0))
    assert stiffness[1, 1] == pytest.approx(3e4 - 5.0)


@pytest.mark.exact
def test_a_simulated_motion_grows_and_turns_as_its_root_says():
    bench = rubbed(friction=tabulated([0.0, 1.0], [0.4, 0.3]), speed=0.6)
    run = replace(PRESSED, duration=3.0)
    run = replace(run, inputs={"input_1": -20.0, "input_0": 1e-3 * (run.time < 0.02)})
    x = respond(replace(bench, settled=True), run)["x"]
    root = roots(bench, PRESSED)[1]
    swing = x[500:] - 20.0 * 0.34 / 400.0
    assert root.real > 0.5
    assert growth_rate(swing, 1e-3, root.imag / (2 * np.pi))[0] == pytest.approx(root.real, rel=0.02)
    assert dominant_frequency(swing, 1e-3) == pytest.approx(root.imag / (2 * np.pi), rel=0.01)


def test_hard_contacts_have_no_roots():
    with pytest.raises(ConfigError, match="yield"):
        roots(rubbed(Hard()), PRESSED)
