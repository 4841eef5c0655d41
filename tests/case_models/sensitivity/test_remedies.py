"""What takes the growth from a mode: who is asked, and how far it has to go."""

from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.case_models.operating_points import StabilitySettings
from pipeline.case_models.sensitivity.derivatives import derivatives
from pipeline.case_models.sensitivity.matrices import Case, polished_root, system_of, without_surface
from pipeline.case_models.sensitivity.parameters import parameters
from pipeline.case_models.sensitivity.remedies import candidates, stabilised
from tests.case_models.sensitivity.curved_brake import curved_brake


def value(name, nominal, reference=None):
    return SimpleNamespace(name=name, value=nominal, reference=nominal if reference is None else reference)


def test_those_that_need_the_smallest_part_of_what_they_can_be_changed_by_come_first():
    """100 1/s: a fifth of the friction of which 30 % can go, a loss factor of 0.05 of 0.2, half the finger's twice."""
    values = [value("friction", 0.5), value("structure.joints.finger_stiffness", 1e8),
              value("structure.pad.lining_loss_factor", 0.0, 0.01), value("structure.disc.density", 7200.0),
              value("structure.pressures", 1e6), value("contact_stiffness", 1.0)]
    slopes = np.array([500.0, -200.0, -20.0, 500.0, 1e4, 1e4])
    assert candidates(values, 100.0, slopes, 9) == [2, 1, 0]
    assert candidates(values, 100.0, slopes, 1) == [2]
    assert candidates(values, 100.0, 0 * slopes, 3) == []


def test_the_mode_no_longer_grows_with_the_value_that_is_found():
    structure, model, law, modes = curved_brake()
    points, operating = StabilitySettings.of(modes), int(modes.unstable_operating[0])
    state, speed = divmod(operating, len(points.speeds))
    case = Case(without_surface(model), state, points.speeds[speed])
    found = derivatives(case, modes.unstable_reduced[:1], structure, 0.6, law, points)
    k = [v.name for v in found.parameters].index("structure.pad.loss_factor")
    chosen = parameters(case, structure, 0.6, points)[k]
    step, root = stabilised(case, found.roots[0], found.shapes[:, 0], chosen, found.changes[0, 0, k], law, points)
    assert step > 0 and -0.1 * found.roots[0].real < root.real <= 0
    again = polished_root(system_of(chosen.changed(case, step), law, points), root).root
    assert again == pytest.approx(root, rel=1e-8)
