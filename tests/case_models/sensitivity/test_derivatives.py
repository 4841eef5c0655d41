"""Derivatives over operating points, and the scatter of what they are to."""

from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.case_models.operating_points import StabilitySettings
from pipeline.case_models.sensitivity.derivatives import derivatives, scatter_of
from pipeline.case_models.sensitivity.matrices import Case, without_surface
from tests.case_models.sensitivity.curved_brake import curved_brake

DECLARED = SimpleNamespace(source=["joint_stiffness:finger", "joint_loss", "friction", "body_loss:pad_outer"],
                           scatter=[0.3, 0.5, 0.02, 0.4])


@pytest.mark.parametrize(("source", "value", "expected"), [
    ("joint_stiffness:finger", 2e8, ("joint_stiffness:finger", 6e7)), ("joint_stiffness:abutment", 2e8, ("", None)),
    ("joint_loss:seal", 0.1, ("joint_loss", 0.05)), ("joint_loss", 9e-6, ("joint_loss", 4.5e-6)),
    ("friction", 0.6, ("friction", 0.02)), ("body_loss:pad", 0.03, ("body_loss:pad_outer", 0.012)),
    ("body_loss:disc", 0.03, ("", None)), ("", 7200.0, ("", None))])
def test_a_value_scatters_as_the_source_that_it_belongs_to(source, value, expected):
    name, width = scatter_of(SimpleNamespace(source=source, value=value), DECLARED)
    assert (name, width) == (expected[0], expected[1] if expected[1] is None else pytest.approx(expected[1]))


def test_nothing_is_declared_without_a_probability():
    assert scatter_of(SimpleNamespace(source="friction", value=0.6), None) == ("", None)


def test_of_fine_tables_both_reaches_say_the_same():
    structure, model, law, modes = curved_brake()
    points, operating = StabilitySettings.of(modes), int(modes.unstable_operating[0])
    state, speed = divmod(operating, len(points.speeds))
    found = derivatives(Case(without_surface(model), state, points.speeds[speed]), modes.unstable_reduced[:1],
                        structure, 0.6, law, points)
    assert found.changes.shape == (2, 1, len(found.parameters)) and found.shapes.shape == (len(model.mass), 1)
    assert all(value.changed is None for value in found.parameters)
    assert (abs(found.changes[0] - found.changes[1]) <= 2e-3 * abs(found.changes[0]) + 1e-4).all()
    assert found.roots == pytest.approx(modes.unstable_reduced[:1], rel=1e-8)
    assert np.isfinite(found.changes).all()
