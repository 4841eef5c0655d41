"""Reported values are those that the laws and changes use."""

import numpy as np
import pytest

from pipeline.blind_trial.generators.switching import joint_laws
from pipeline.blind_trial.generators.switching.hidden import PIECES
from pipeline.blind_trial.generators.switching.reported_values import of_change, of_law
from pipeline.blind_trial.generators.switching.rig import drawn
from pipeline.effects import CATALOGUE
from tests.blind_trial.generators.switching.test_joint_laws import SPOT

RIG = drawn(np.random.default_rng(1), "row")


@pytest.mark.exact
def test_laws_have_the_reported_coefficients():
    for form, law, e, v, power in (("cubic_stiffness", joint_laws.cubic, 0.02, 0.0, 0.02**3),
                                   ("quadratic_stiffness", joint_laws.quadratic, 0.02, 0.0, 0.02**2),
                                   ("quadratic_damping", joint_laws.drag, 0.0, 0.3, 0.09)):
        force = law(SPOT, 0.4)[0].force(0, e, v, (), 1)
        assert force == pytest.approx(of_law(form, SPOT, 0.4)["coefficient"] * power, rel=1e-12)
    assert joint_laws.coulomb(SPOT, 0.4)[0].limits(0, 0, ())[1] == of_law("coulomb", SPOT, 0.4)["force"]
    gap = of_law("backlash", SPOT, 0.4)["gap"]
    assert joint_laws.play(SPOT, 0.4)[0].force(0, 2 * gap, 0, (), 1) == pytest.approx(-800 * gap)
    assert of_law("bouc_wen", SPOT, 0.4) == {}


@pytest.mark.exact
def test_changes_have_the_reported_values_and_all_names_are_of_the_catalogue():
    assert PIECES["attached_mass"].change(RIG, 1, 0.2).mass[1] - RIG.mass[1] == pytest.approx(
        of_change("attached_mass", RIG, 1, 0.2)["mass"])
    softer, compliance = PIECES["compliant_arm"].change(RIG, 0, 0.2), of_change("compliant_arm", RIG, 0, 0.2)
    assert 1 / softer.stiffness[0] - 1 / RIG.stiffness[0] == pytest.approx(compliance["compliance"])
    assert PIECES["added_stiffness"].change(RIG, 0, 0.2).stiffness[-1] == of_change(
        "added_stiffness", RIG, 0, 0.2)["stiffness"]
    assert PIECES["joint_damping"].change(RIG, 0, 0.2).damping[0] - RIG.damping[0] == pytest.approx(
        of_change("joint_damping", RIG, 0, 0.2)["damping"])
    known = {effect.name for effect in CATALOGUE}
    assert {form for form, piece in PIECES.items() if of_law(form, SPOT, 1.0) or piece.change} <= known
