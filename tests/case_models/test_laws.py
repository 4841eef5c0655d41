"""Laws of contact and friction from a section."""

import numpy as np
import pytest

from pipeline.case_models.laws import Laws, friction_law, normal_law
from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from pipeline.physics.sliding.model import sliding_model
from pipeline.physics.time_stepping.simulate import Hard, Penalty
from tests.diagnosis.small_rig import model


def of(given):
    whole, settings = model(), fill(Laws, given, "laws")
    contacts = sliding_model(whole, 0, 1.0).contacts
    return normal_law(whole, contacts, settings, "stage"), friction_law(whole, contacts, settings, "stage")


def test_hard_and_yielding_contacts():
    assert isinstance(of({})[0], Hard)
    law = of({"contact": "penalty", "contact_stiffness": "2 kN/mm", "contact_damping": "3 N s/m"})[0]
    assert isinstance(law, Penalty) and law.stiffness == pytest.approx(2e6) and law.damping == 3.0


def test_friction_falls_from_rest():
    friction = of({"friction": 0.3, "friction_at_rest": 0.5, "decay_speed": "0.1 m/s"})[1]
    assert friction.at_speed(np.array([0.0, 0.1])) == pytest.approx([0.5, 0.3 + 0.2 / np.e], rel=1e-4)


@pytest.mark.parametrize("given, said", [({"contact": "table"}, "stage.contact"),
                                         ({"friction_at_rest": 0.4}, "stage.friction")])
def test_what_does_not_fit_is_refused(given, said):
    with pytest.raises(ConfigError, match=said):
        of(given)
