"""Normal laws as the compiled steps see them: one value for each contact, and laws that cannot be."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.contact.groups import Grouped
from pipeline.physics.time_stepping.contact_solver import HARD, LAGRANGE, PENALTY, TABLE
from pipeline.physics.time_stepping.normal_laws import (
    Forward,
    Hard,
    Lagrange,
    Penalty,
    Table,
    closing,
    contiguous,
    force_along,
    normal_force,
    normal_kernel,
    tangent,
)
from tests.physics.lumps import lumps

pytestmark = pytest.mark.exact
TWO = lumps([1.0, 1.0], normal=np.eye(2), tangent=np.zeros((2, 2))).contacts
AREA = np.array([1.0, 2e-3])
LAW = Grouped((Penalty(1e4, 3.0), Table(np.array([0.0, 1e-3, 1e-2]), np.array([0.0, 8e3, 2e5]), 2.0)), (0, 1))


@pytest.mark.parametrize("law, kind, newmark", [
    (Hard(), HARD, False), (Penalty(1e6), PENALTY, False), (Penalty(1e6, gamma=0.5), PENALTY, True),
    (Table(np.array([0, 1.0]), np.array([0, 1.0])), TABLE, False), (Lagrange(), LAGRANGE, True),
    (Forward(), LAGRANGE, False)])
def test_each_law_has_its_kind_and_its_rule(law, kind, newmark):
    found = normal_kernel(law, TWO)
    assert (found.kind, found.newmark) == (kind, newmark)


def test_one_value_serves_all_contacts_and_each_may_have_its_own():
    found = normal_kernel(Penalty(np.array([1e6, 2e6]), 5.0, gap=1e-3), TWO)
    assert found.stiffness.tolist() == [1e6, 2e6] and found.damping.tolist() == [5, 5]
    assert found.gap.tolist() == [1e-3, 1e-3]


@pytest.mark.parametrize("law, said", [
    (Hard(-0.1), "restitution: expected between 0 and 1"), (Lagrange(1.1), "gamma: expected between 0.5 and 1"),
    (Penalty(np.array([1.0, 0.0])), "contact stiffness: expected above 0"),
    (Table(np.array([0, 1.0, 1.0]), np.array([0, 1.0, 2.0])), "rise from 0")])
def test_laws_that_cannot_be_are_refused(law, said):
    with pytest.raises(ConfigError, match=said):
        normal_kernel(law, TWO)


def test_a_contiguous_copy_leaves_the_given_array_alone():
    given = np.arange(6).reshape(2, 3).T
    copy = contiguous(given)
    copy[0, 0] = 7.0
    assert given[0, 0] == 0 and copy.flags.c_contiguous and copy.dtype == float


def test_forces_of_a_penalty_and_of_a_table():
    """1e4 c + 3 c'; 2e-3 (8e3 + 192e3 / 9e-3 (c - 1e-3)) (1 + c' / 2)."""
    kernel, gap, rate = normal_kernel(LAW, replace(TWO, area=AREA)), np.full(2, -4e-3), np.full(2, -0.1)
    exact = [40.3, 2e-3 * (8e3 + 192e3 / 3) * 1.05]
    force, yields = normal_force(kernel, gap, rate)
    np.testing.assert_allclose(force, exact, rtol=1e-12)
    assert yields.all()
    np.testing.assert_allclose([force_along(LAW, i, AREA, -gap[i], -rate[i]) for i in range(2)], exact, rtol=1e-12)
    assert [float(force_along(LAW, i, AREA, -1e-3, 0.1)) for i in range(2)] == [0.0, 0.0]


@pytest.mark.parametrize("closure", [5e-4, 4e-3, 3e-2])
def test_slopes_and_closures_are_those_of_the_force(closure):
    force, step = (np.array([force_along(LAW, i, AREA, c, 0.0) for i in range(2)]) for c in (closure, closure * 1.001))
    moved = np.array([force_along(LAW, i, AREA, closure, 1e-3) for i in range(2)])
    stiffness, damping = tangent(LAW, force, AREA)
    np.testing.assert_allclose(stiffness, (step - force) / (1e-3 * closure), rtol=1e-9)
    np.testing.assert_allclose(damping, (moved - force) / 1e-3, rtol=1e-9)
    slope, rest = closing(LAW, force, AREA)
    np.testing.assert_allclose(slope * force + rest, closure, rtol=1e-12)


@pytest.mark.exact
def test_a_sampled_curve_has_a_slope_that_does_not_jump():
    """p = c^2 at even pressures: the compliance 1 / (2 c) of the curve, with the second-order error of its samples."""
    pressure = np.linspace(0.0, 4e4, 201)
    curve = Table(np.sqrt(pressure), pressure, smooth=True)
    force = AREA * np.array([9998.0, 10002.0])      # on both sides of a row
    stiffness, _ = tangent(curve, force, AREA)
    np.testing.assert_allclose(stiffness, AREA * 2 * np.sqrt(force / AREA), rtol=1e-4)


def test_contacts_that_do_not_yield():
    force = np.array([1.0, 0.0])
    np.testing.assert_array_equal(closing(Hard(), force, AREA), np.zeros((2, 2)))
    np.testing.assert_array_equal(tangent(Hard(), 0 * force, AREA), np.zeros((2, 2)))
    assert not normal_force(normal_kernel(Hard(), replace(TWO, area=AREA)), -np.ones(2), np.zeros(2))[1].any()
    for asked in (lambda: tangent(Hard(), force, AREA), lambda: force_along(Hard(), 0, AREA, 1e-3, 0.0)):
        with pytest.raises(ConfigError, match="yield"):
            asked()
