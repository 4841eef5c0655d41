"""Smoothed laws of contacts against the curves that their tables come from."""

from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.case_models.sensitivity.local_laws import LocalFriction, LocalLaw, curvature_of
from pipeline.physics.contact.static_preload import Preload
from pipeline.physics.sliding.model import FrictionState

CLOSURE = np.linspace(0, 2e-5, 81)
PRESSURE = 1e5 * np.expm1(CLOSURE / 4e-6)


@pytest.mark.exact
@pytest.mark.parametrize("reach", [1, 2])
def test_the_curvature_of_a_table_is_that_of_its_curve(reach):
    at = np.array([3.13e-6, 8e-6, 1.01e-5])
    exact = 1e5 * np.exp(at / 4e-6) / 4e-6**2
    np.testing.assert_allclose(curvature_of(at, CLOSURE, PRESSURE, reach), exact, rtol=0.05 * reach)
    assert not curvature_of(at, np.array([0, 1e-5]), np.array([0, 1e6]), reach).any()


def test_its_slope_is_the_derivative_of_its_force_and_a_factor_acts_at_a_given_pressure():
    force, stiffness = np.array([100.0, 0.0, 40.0]), np.array([1e8, 0.0, 5e7])
    law = LocalLaw(np.array([8e-6, -1e-6, 6e-6]), force, stiffness, np.array([2e13, 0.0, 0.0]))
    ends = [law(1.0, law.closure + side * 1e-9)[0] for side in (-1, 1)]
    np.testing.assert_allclose((ends[1] - ends[0]) / 2e-9, law(1.0, law.closure)[1], rtol=1e-6)
    np.testing.assert_allclose(law(1.25, law.closure / 1.25)[0], force)
    np.testing.assert_allclose(law(1.25, law.closure / 1.25)[1], 1.25 * stiffness)


def test_open_contacts_and_friction_joints_have_no_curvature():
    contacts = SimpleNamespace(area=np.full(3, 1e-4), fixed=np.array([False, False, True]))
    family = SimpleNamespace(model=SimpleNamespace(contacts=contacts), law_added=False, law_closure=CLOSURE,
                             law_pressure=PRESSURE)
    contact = Preload(np.array([100.0, 0.0, 10.0]), np.array([1e8, 0.0, 0.0]), np.array([8e-6, -1e-6, 0.0]))
    law = LocalLaw.about(family, contact)
    assert law.curvature[0] > 0 and not law.curvature[1:].any()


@pytest.mark.exact
def test_a_quadratic_friction_is_its_own_local_law():
    """mu = 0.5 + 0.1 P - 0.2 V + 0.03 P^2 + 0.05 P V - 0.04 V^2, P in MPa and V in m/s."""
    def friction(pressure, speed):
        p = pressure / 1e6
        return FrictionState(0.5 + 0.1 * p - 0.2 * speed + 0.03 * p**2 + 0.05 * p * speed - 0.04 * speed**2,
                             (0.1 + 0.06 * p + 0.05 * speed) / 1e6, -0.2 + 0.05 * p - 0.08 * speed)

    area = np.array([1e-4, 2e-4])
    model = SimpleNamespace(contacts=SimpleNamespace(area=area), sliding_speed=np.array([-1.0, 1.2]))
    force = np.array([100.0, 300.0])
    local = LocalFriction.about(SimpleNamespace(model=model, friction=friction), force, None)
    given, expected = (of(np.array([1.3e6, 1.1e6]), np.array([0.7, 1.5])) for of in (local, friction))
    np.testing.assert_allclose(given.coefficient, expected.coefficient, rtol=1e-6)
    np.testing.assert_allclose(given.pressure_slope, expected.pressure_slope, rtol=1e-6)
    np.testing.assert_allclose(given.speed_slope, expected.speed_slope, rtol=1e-6)


def test_the_staircase_of_a_friction_map_is_smoothed():
    """Slopes 1e-7 and 3e-7 1/Pa below and above a row of the map make a second derivative of both over the rows."""
    axis = np.geomspace(1e5, 1e7, 21)

    def friction(pressure, speed):
        over = pressure > 1e6
        return FrictionState(np.where(over, 3e-7, 1e-7) * pressure, np.where(over, 3e-7, 1e-7), 0 * pressure)

    model = SimpleNamespace(contacts=SimpleNamespace(area=np.ones(1)), sliding_speed=np.ones(1))
    force = np.array([1.01e6])
    family = SimpleNamespace(model=model, friction=friction)
    friction_map = SimpleNamespace(pressure=axis, speed=np.geomspace(0.1, 10, 5))
    ratio = axis[1] / axis[0]
    local = LocalFriction.about(family, force, friction_map)
    assert local.bend[0, 0, 0] == pytest.approx(2e-7 / (1.01e6 * (ratio - 1 / ratio)))
    assert LocalFriction.about(family, force, friction_map, 2).bend[0, 0, 0] < 0.6 * local.bend[0, 0, 0]
