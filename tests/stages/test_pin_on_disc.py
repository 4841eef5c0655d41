"""The stage on a coarse mesh: published modes, contact states, bad input."""

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.physics.friction.tangential_law import tangential_law
from tests.stages.small_pin import COARSE, small_law, small_pin, small_system


@pytest.mark.published
def test_modes_of_disc_and_pin_are_those_of_figure_3():
    """(3,0) within 1 % with nothing fitted; (2,0) and the second pin modes within 2 %, hub and accelerometer fitted."""
    system, _ = small_system()
    out = system.disc_out_of_plane > 0.5
    assert system.disc_frequency[out & (system.disc_diameters == 3)].min() == pytest.approx(2247, rel=1e-2)
    assert system.disc_frequency[out & (system.disc_diameters == 2)].min() == pytest.approx(1020, rel=2e-2)
    assert system.pin_frequency[1, 2] == pytest.approx(2247, rel=2e-2)
    assert system.pin_frequency[0, 2] == pytest.approx(2100, rel=2e-2)


@pytest.mark.exact
def test_the_weight_is_the_contact_force():
    system = small_pin(loads=["0.5 kg", "5 kg"])
    assert system.preload[:, 0] == pytest.approx([0.5 * 9.81, 5 * 9.81])
    assert system.pressure * system.load_area == pytest.approx(system.preload[:, 0])
    force = np.interp(np.interp(system.pressure, system.law_pressure, system.law_closure), system.law_closure,
                      system.law_pressure) * system.load_area
    assert force == pytest.approx(system.preload[:, 0])
    assert system.contact_stiffness[1, 0] > 5 * system.contact_stiffness[0, 0]


@pytest.mark.exact
def test_friction_and_tangential_stiffness_follow_the_interface_law():
    system, law = small_system()[0], small_law()
    assert law.friction.min() < system.friction < law.friction.max()
    area = np.interp(system.pressure, law.gap_pressure, law.real_area)
    assert system.friction == pytest.approx(385e6 * area / system.pressure, rel=1e-2)
    stiffness = tangential_law(system).at(system.pressure).stiffness * system.contact_area
    ratio = stiffness / system.contact_stiffness[:, 0]
    assert ratio == pytest.approx(2 * (1 - 0.33) / (2 - 0.33), rel=0.05)


@pytest.mark.exact
@pytest.mark.parametrize("changes, said", [
    ({"pin": {"length": "15 mm"}}, "longer than its clamp"), ({"contact": {"radius": "178 mm"}}, "never touches"),
    ({"pin": {"tilt": "-4 deg", "base_mass": "1 kg"}}, "it locks"),
    ({"loads": ["500000 kg"]}, "tangential law: pressure")])
def test_bad_systems_are_refused(changes, said):
    with pytest.raises(ConfigError, match=said):
        small_pin(**changes)


@pytest.mark.exact
def test_bad_settings_are_refused():
    for changes in ({"loads": ["0 kg"]}, {"pin": {**COARSE["pin"], "length": "250 mm"}}, {"pin": {"tilt": "80 deg"}}):
        with pytest.raises(ValueError, match="greater than|less than"):
            small_pin(**changes)


@pytest.mark.exact
def test_a_hard_contact_has_no_law():
    system = small_pin(contact={"hard": True})
    assert not system.law_closure.size and not system.contact_stiffness.any()
