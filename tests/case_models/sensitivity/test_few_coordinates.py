"""Derivatives in few coordinates beside those of the whole model and beside differences of roots."""

import numpy as np
import pytest

from pipeline.case_models.scatter import stability_settings
from pipeline.case_models.sensitivity.few_coordinates import few_coordinates, without_surface
from pipeline.case_models.sensitivity.matrices import Case, matrices, mean_friction, polished_root
from pipeline.case_models.sensitivity.parameters import parameters
from tests.case_models.sensitivity.curved_brake import curved_brake

SMALL, STEP = 1e-3, 2e-2


@pytest.fixture(scope="module")
def brake():
    return curved_brake()


def test_derivatives_are_those_of_the_roots_of_the_whole_model(brake):
    """Every value of two modes at one operating point, within 1 % of central differences of the roots themselves."""
    structure, model, law, modes = brake
    points, operating = stability_settings(modes), int(modes.unstable_operating[0])
    roots = modes.unstable_reduced[modes.unstable_operating == operating][:2]
    assert len(roots) == 2
    state, speed = divmod(operating, len(points.speeds))
    case = Case(without_surface(model), state, points.speeds[speed])
    few = few_coordinates(case, roots, law, points)
    assert few.basis.shape[1] <= 1 + 2 * 4 * 2 and len(model.mass) > 100
    np.testing.assert_allclose([mode.root for mode in few.modes], roots, rtol=1e-8)
    for value in parameters(case, structure, mean_friction(case, law, points), points):
        ends = [value.changed(case, side * STEP) for side in (-1, 1)]
        steps = (-SMALL, SMALL)
        small = [few.on(value.changed(case, step)) if value.of_bodies else value.changed(few.small, step)
                 for step in steps]
        changes = few.changes(small, law, points)[0] / (2 * SMALL)
        whole = [matrices(end, law, points) for end in ends]
        for mode, change in zip(few.modes, changes, strict=True):
            low, high = (polished_root(each, mode.root + side * STEP * change).root
                         for side, each in zip((-1, 1), whole, strict=True))
            expected = (high - low) / (2 * STEP)
            assert abs(change - expected) < 0.01 * abs(expected) + 0.01, value.name


def test_the_case_itself_is_in_balance_and_has_its_roots(brake):
    structure, model, law, modes = brake
    points = stability_settings(modes)
    state, speed = divmod(int(modes.unstable_operating[0]), len(points.speeds))
    few = few_coordinates(Case(without_surface(model), state, points.speeds[speed]), modes.unstable_reduced[:1], law,
                          points)
    (mode,), ((mass, damping, stiffness), imbalance) = few.modes, few.about(few.small, law, points)
    assert abs(imbalance).max() < 1e-6 * model.preload.sum()
    whole = mode.root**2 * mass + mode.root * damping + stiffness
    assert abs(mode.left.conj() @ whole @ mode.right) < 1e-6 * abs(mode.root)
    assert mode.left.conj() @ (2 * mode.root * mass + damping) @ mode.right == pytest.approx(1, rel=1e-9)
