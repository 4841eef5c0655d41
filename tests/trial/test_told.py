"""Values of hidden physics: they give the force of the law when put into the equation that others use."""

import numpy as np
import pytest

from pipeline.effects import CATALOGUE
from pipeline.effects.typical import Typical
from pipeline.trial.hidden import HIDDEN, Spot
from pipeline.trial.rig import drawn
from pipeline.trial.told import parameters

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
