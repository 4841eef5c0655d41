"""First-order changes of roots beside differences of the roots of the whole model, with and without effects."""

from dataclasses import replace
from functools import reduce

import numpy as np
import pytest

from pipeline.case_models.operating_points import StabilitySettings
from pipeline.case_models.sensitivity.matrices import Case, mean_friction, polished_root, system_of, without_surface
from pipeline.case_models.sensitivity.parameters import parameters
from pipeline.case_models.sensitivity.root_changes import followed_roots
from tests.case_models.sensitivity.curved_brake import curved_brake
from tests.stages.effects_on_a_brake import SMALL as ACTING
from tests.stages.effects_on_a_brake import acting

SMALL, STEP = 1e-3, 2e-2
@pytest.fixture(scope="module")
def brake():
    return curved_brake()


@pytest.fixture(scope="module")
def plain():
    """The same with tables that are fine enough for one mode and a few values."""
    return curved_brake(400001, 201)


def of_brake(brake, added=None):
    """(Case, with an effect by name, its roots, Structure, FrictionMap, settings) at one operating point."""
    structure, model, law, modes = brake
    points, operating = StabilitySettings.of(modes), int(modes.unstable_operating[0])
    roots = modes.unstable_reduced[modes.unstable_operating == operating][:2]
    state, speed = divmod(operating, len(points.speeds))
    case = Case(without_surface(model), state, points.speeds[speed], effects=added and acting(added))
    return case, roots, structure, law, points


def check(case, roots, law, points, together, within, uncertain):
    """Changes by Parameters that vary ``together``, added up, against differences of the roots of the whole model."""
    followed, at = followed_roots(case, roots, law, points), []
    changes = sum(followed.changes([value.changed(case, step) for step in (-SMALL, SMALL)], law, points)[0]
                  for value in together) / (2 * SMALL)
    for side in (-1, 1):
        varied = reduce(lambda varied, value: value.changed(varied, side * STEP), together, case)
        system = system_of(varied, law, points)
        at.append([polished_root(system, mode.root + side * STEP * change).root
                   for mode, change in zip(followed.modes, changes, strict=True)])
    expected = (np.array(at[1]) - at[0]) / (2 * STEP)
    assert (abs(changes - expected) < within * abs(expected) + uncertain).all(), [v.name for v in together]


def test_derivatives_are_those_of_the_roots_of_the_whole_model(brake):
    """Every value of two modes at one operating point, within 1 % of central differences of the roots themselves."""
    case, roots, structure, law, points = of_brake(brake)
    assert len(roots) == 2
    np.testing.assert_allclose([m.root for m in followed_roots(case, roots, law, points).modes], roots, rtol=1e-8)
    for value in parameters(case, structure, mean_friction(case, law, points), points):
        check(case, roots, law, points, [value], 0.01, 0.01)


@pytest.mark.parametrize("name", sorted(ACTING))
def test_so_they_are_with_every_effect(plain, name):
    """Friction, contacts, load, speed, joints and bodies together; differences of roots are 0.08 1/s uncertain, as the
    tables have steps."""
    case, roots, structure, law, points = of_brake(plain, name)
    points = replace(points, friction_damping=False)       # which effects may bring
    system = system_of(case, law, points)
    roots = [polished_root(system, roots[0]).root]
    values = {v.name: v for v in parameters(case, structure, mean_friction(case, law, points), points)}
    chosen = ("friction", "contact_stiffness", "structure.pressures", "complex_modes.speeds",
              "joints.guide_2_z.stiffness", "structure.disc.young")
    check(case, roots, law, points, [values[name] for name in chosen], 0.02, 2.0)


def test_vectors_are_those_of_the_case_with_memory(plain):
    case, roots, _, law, points = of_brake(plain, "contact_memory")
    system = system_of(case, law, points)
    assert system.beside is not None
    mode = polished_root(system, roots[0])
    assert abs(system.apply(mode.root, mode.right)).max() < 1e-6 * abs(mode.root) ** 2
    assert mode.left.conj() @ system.slope(mode.root, mode.right) == pytest.approx(1, rel=1e-9)
