"""Terms of steady sliding: what each is, whose, and its weight by hand, equations (1) to (3) of the sliding model."""

import numpy as np
import pytest

from pipeline.physics.sliding.model import FrictionState
from pipeline.physics.sliding.sliding_terms import friction_terms, pressing_terms, supporting_terms
from pipeline.physics.system.terms import Kind, Owner, What
from tests.physics.sliding.test_model import two_masses

STATE = FrictionState(np.array([0.4]), np.array([2e-7]), np.array([-0.03]))


def test_bodies_and_joints_are_told_apart():
    terms = supporting_terms(two_masses())
    assert [(t.name, t.owner) for t in terms if t.kind is Kind.STIFFNESS] == [
        (What.STRUCTURAL_STIFFNESS, Owner.BODY), (What.STRUCTURAL_STIFFNESS, Owner.JOINT),
        (What.CENTRIFUGAL, Owner.BODY)]
    left = {t.name for t in supporting_terms(two_masses(), gyroscopic=False, centrifugal=False)}
    assert left == {What.MASS, What.STRUCTURAL_DAMPING, What.STRUCTURAL_STIFFNESS}


@pytest.mark.exact
@pytest.mark.parametrize("speed", [2.0, -3.0])
def test_weights_of_a_contact_by_hand(speed):
    """Preload 50 N on 1e-4 m^2, stiffness 1e6 N/m, damping 7 N s/m."""
    model, sign = two_masses(speed, damping=7.0), np.sign(speed)
    coupling = sign * (0.4 + 50.0 / 1e-4 * 2e-7)
    found = {t.name: float(np.ravel(t.form.weight)[0]) for t in (*pressing_terms(model), *friction_terms(model, STATE))}
    assert found == pytest.approx({
        What.CONTACT_STIFFNESS: 1e6, What.CONTACT_DAMPING: 7.0, What.CIRCULATORY: coupling * 1e6,
        What.FRICTION_DAMPING: coupling * 7.0, What.FRICTION_OVER_SLIP: 50.0 * -0.03,
        What.FRICTION_TURNING: 0.4 * 50.0 / abs(speed)})


def test_friction_that_does_not_turn_and_no_friction():
    model = two_masses()
    assert What.FRICTION_TURNING not in {t.name for t in friction_terms(model, STATE, friction_damping=False)}
    assert not any(t.form.acts for t in friction_terms(model, FrictionState(0.0)))
