"""Normal laws: forces, slopes and closures of one law agree with each other."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.contact_groups import Grouped
from pipeline.physics.normal_law import Hard, Penalty, Table, closing, force_along, normal_force, normal_kernel, tangent
from tests.physics.lumps import lumps

AREA = np.array([1.0, 2e-3])
LAW = Grouped((Penalty(1e4, 3.0), Table(np.array([0.0, 1e-3, 1e-2]), np.array([0.0, 8e3, 2e5]), 2.0)), (0, 1))


def contacts():
    rows = np.eye(2)
    return replace(lumps([1.0, 1.0], normal=rows, tangent=rows).contacts, area=AREA)


@pytest.mark.exact
def test_forces_of_a_penalty_and_of_a_table():
    """1e4 c + 3 c'; 2e-3 (8e3 + 192e3 / 9e-3 (c - 1e-3)) (1 + c' / 2)."""
    kernel, gap, rate = normal_kernel(LAW, contacts()), np.full(2, -4e-3), np.full(2, -0.1)
    exact = [40.3, 2e-3 * (8e3 + 192e3 / 3) * 1.05]
    force, yields = normal_force(kernel, gap, rate)
    np.testing.assert_allclose(force, exact, rtol=1e-12)
    assert yields.all()
    np.testing.assert_allclose([force_along(LAW, i, AREA, -gap[i], -rate[i]) for i in range(2)], exact, rtol=1e-12)
    assert [float(force_along(LAW, i, AREA, -1e-3, 0.1)) for i in range(2)] == [0.0, 0.0]


@pytest.mark.exact
@pytest.mark.parametrize("closure", [5e-4, 4e-3, 3e-2])
def test_slopes_and_closures_are_those_of_the_force(closure):
    force, step = (np.array([force_along(LAW, i, AREA, c, 0.0) for i in range(2)]) for c in (closure, closure * 1.001))
    moved = np.array([force_along(LAW, i, AREA, closure, 1e-3) for i in range(2)])
    stiffness, damping = tangent(LAW, force, AREA)
    np.testing.assert_allclose(stiffness, (step - force) / (1e-3 * closure), rtol=1e-9)
    np.testing.assert_allclose(damping, (moved - force) / 1e-3, rtol=1e-9)
    slope, rest = closing(LAW, force, AREA)
    np.testing.assert_allclose(slope * force + rest, closure, rtol=1e-12)


def test_contacts_that_do_not_yield():
    force = np.array([1.0, 0.0])
    np.testing.assert_array_equal(closing(Hard(), force, AREA), np.zeros((2, 2)))
    np.testing.assert_array_equal(tangent(Hard(), 0 * force, AREA), np.zeros((2, 2)))
    assert not normal_force(normal_kernel(Hard(), contacts()), -np.ones(2), np.zeros(2))[1].any()
    for asked in (lambda: tangent(Hard(), force, AREA), lambda: force_along(Hard(), 0, AREA, 1e-3, 0.0)):
        with pytest.raises(ConfigError, match="yield"):
            asked()
