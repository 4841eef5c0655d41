"""Values of hidden physics: they give the force of the law when put into the equation that others use."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.blind_trial.generators.spring_mass.hidden_laws import HIDDEN, Spot
from pipeline.blind_trial.generators.spring_mass.inserted_effect import Planted
from pipeline.blind_trial.generators.spring_mass.reported_values import alike, parameters
from pipeline.blind_trial.generators.spring_mass.rig import drawn
from pipeline.effects import CATALOGUE
from pipeline.effects.typical import Typical

SPOT = Spot(drawn(np.random.default_rng(2), 3), 1, 0.01, 0.2, 3.0, 5.0, (0.3, 0.6, 0.9))
E, V, T = 0.004, 0.15, 1.7
#: equations of the catalogue, written out
FORCE = {
    "coulomb": lambda p: p["force"], "asymmetric_friction": lambda p: p["force"],
    "joint_damping": lambda p: p["damping"] * V, "cubic_stiffness": lambda p: p["coefficient"] * E**3,
    "quadratic_stiffness": lambda p: p["coefficient"] * E**2, "quadratic_damping": lambda p: p["coefficient"] * V**2,
    "backlash": lambda p: -SPOT.link.stiffness * np.clip(E, -p["gap"], p["gap"]),
    "thermal_softening": lambda p: -SPOT.link.stiffness * p["drop"] * (1 - np.exp(-T / p["time"])) * E,
    "base_shake": lambda p: -(SPOT.link.stiffness * p["amplitude"] * np.cos(
        2 * np.pi * p["frequency"] * T - p["phase"]) - SPOT.link.damping * p["amplitude"] * 2 * np.pi * p[
        "frequency"] * np.sin(2 * np.pi * p["frequency"] * T - p["phase"])),
    "pressure_ripple": lambda p: -p["force"] * np.cos(2 * np.pi * p["frequency"] * T - p["phase"]),
}


@pytest.mark.exact
@pytest.mark.parametrize("name", FORCE)
def test_told_values_give_the_force_of_the_law(name):
    law = HIDDEN[name].build(SPOT, 0.4).laws[0]
    assert law.force(T, E, V, np.zeros(0)) == pytest.approx(FORCE[name](parameters(HIDDEN[name], SPOT, 0.4)), rel=1e-6)


@pytest.mark.exact
@pytest.mark.parametrize("name, holding", [("viscoelastic_pad", "share"), ("hydraulic_compliance", "stiffness")])
def test_told_values_give_the_rate_of_a_branch(name, holding):
    law, told = HIDDEN[name].build(SPOT, 0.4).laws[0], parameters(HIDDEN[name], SPOT, 0.4)
    stiffness = told[holding] * (SPOT.link.stiffness if holding == "share" else 1.0)
    assert law.rates(T, E, V, np.array([0.3]))[0] == pytest.approx(stiffness * V - 0.3 / told["time"])


@pytest.mark.parametrize("name", [n for n, piece in HIDDEN.items() if piece.known])
def test_names_are_those_of_the_catalogue_or_none(name):
    effect = next(e for e in CATALOGUE if e.name == name)
    assert set(parameters(HIDDEN[name], SPOT, 0.4)) in ({p.name for p in effect.parameters(Typical())}, set())


def test_other_laws_have_no_values():
    assert parameters(HIDDEN["film_drag"], SPOT, 0.4) == parameters(HIDDEN["hysteretic_joint"], SPOT, 0.4) == {}


@pytest.mark.parametrize("name, place, masses, wanted", [
    ("pressure_ripple", "shaker", 1, [("base_shake", "link_0")]),
    ("base_shake", "link_0", 1, [("pressure_ripple", "shaker")]),
    ("viscoelastic_pad", "link_0", 1, [("hydraulic_compliance", "shaker")]),
    ("pressure_ripple", "shaker", 3, []), ("base_shake", "link_0", 2, []), ("coulomb", "link_0", 1, [])])
def test_laws_of_the_same_force_are_told_only_at_a_mass_that_a_wall_holds(name, place, masses, wanted):
    found = alike(Planted(HIDDEN[name], place, SPOT), drawn(np.random.default_rng(2), masses))
    assert [(one["name"], one["place"]) for one in found] == wanted


def test_a_ripple_of_the_shaker_moves_one_mass_as_its_shaken_wall_does():
    """Of one amplitude k a and phase, for a link without damping."""
    rig = drawn(np.random.default_rng(2), 1)
    rig = replace(rig, links=(replace(rig.links[0], damping=0.0),))
    spot = replace(SPOT, rig=rig, index=0, force=rig.links[0].stiffness * SPOT.length)
    ripple, shaken = ([HIDDEN[name].build(spot, 0.4).laws[0].force(t, E, V, np.zeros(0)) for t in (0.1, 0.5, 1.7)]
                      for name in ("pressure_ripple", "base_shake"))
    np.testing.assert_allclose(ripple, shaken, rtol=1e-12)
