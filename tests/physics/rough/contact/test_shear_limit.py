"""Tresca shear: Cattaneo and Mindlin's partial slip, full slip, limit at speed."""

import numpy as np
import pytest

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.closed_form import cattaneo_mindlin, hertz
from pipeline.physics.rough.contact.shear_limit import full_slip_displacement, limit_at_speed, solve_shear_limit
from pipeline.physics.rough.layered_solid import half_space_compliance

NODES, RADIUS, FRICTION = 128, 26.0, 0.4


@pytest.fixture(scope="module")
def hertzian():
    """Distance from the centre, exact Hertz pressure and compliance; Poisson ratio 0, where the solution is exact."""
    position = np.arange(NODES) - NODES // 2
    distance = np.hypot(position[:, None], position)
    load = 4.0 * RADIUS ** 3 / (3.0 * 500.0)
    compliance = half_space_compliance((NODES, NODES), (1.0, 1.0), 1.0, 0.0)
    return distance, hertz.pressure(distance, load, 500.0, 1.0), compliance


@pytest.mark.exact
def test_cattaneo_mindlin(hertzian):
    distance, pressure, compliance = hertzian
    limit = FRICTION * pressure
    full = full_slip_displacement(limit, compliance)
    solution = solve_shear_limit(limit, compliance, 0.6 * full, tolerance=1e-6)
    load = solution.traction[0].sum()
    stick = cattaneo_mindlin.stick_radius(RADIUS, load, FRICTION, pressure.sum())
    assert 0.3 * RADIUS < stick < 0.9 * RADIUS
    assert np.sqrt(solution.sticking.sum() / np.pi) == pytest.approx(stick, rel=0.02)
    exact = cattaneo_mindlin.shear(distance, RADIUS, pressure.max(), stick, FRICTION)
    assert np.linalg.norm(solution.traction[0] - exact) < 0.04 * np.linalg.norm(exact)


@pytest.mark.exact
def test_beyond_full_slip_every_node_carries_its_limit(hertzian):
    _, pressure, compliance = hertzian
    limit = np.where(pressure > 0.0, 0.01, 0.0)
    full = full_slip_displacement(limit, compliance)
    slipping = solve_shear_limit(limit, compliance, 1.001 * full)
    assert slipping.traction[0].sum() == pytest.approx(limit.sum(), rel=1e-5)
    assert slipping.sticking.sum() < 0.01 * np.count_nonzero(limit)
    assert solve_shear_limit(limit, compliance, 0.7 * full).traction[0].sum() < 0.97 * limit.sum()


def test_the_limit_is_never_exceeded(hertzian):
    _, pressure, compliance = hertzian
    limit = FRICTION * pressure
    traction = solve_shear_limit(limit, compliance, 0.3 * full_slip_displacement(limit, compliance), 1e-4).traction
    assert np.all(np.hypot(*traction) <= limit * (1.0 + 1e-12))


@pytest.mark.exact
def test_limit_at_speed_solves_its_equation():
    limit = limit_at_speed(13.5e6, 1.5, 1.3, 0.015, 1e-3, 5e-7)
    rise = 5e-7 * limit
    assert limit == pytest.approx(13.5e6 * (1.0 + 0.015 * np.log(1.5 / 1.3)) * (1.0 - 1e-3 * rise), rel=1e-12)


def test_limit_without_speed_effects_is_the_limit():
    assert limit_at_speed(13.5e6, 1.5, 1.3, 0.0, 0.0, 5e-7) == 13.5e6


def test_non_convergence_raises(hertzian):
    _, pressure, compliance = hertzian
    half = 0.5 * full_slip_displacement(FRICTION * pressure, compliance)
    with pytest.raises(ConvergenceError, match="within 2 iterations"):
        solve_shear_limit(FRICTION * pressure, compliance, half, max_iterations=2)


@pytest.mark.exact
def test_without_a_limit_there_is_no_shear_and_no_way_to_full_slip():
    compliance = half_space_compliance((8, 8), (1.0, 1.0), 1.0, 0.3)
    none = np.zeros((8, 8))
    assert full_slip_displacement(none, compliance) == 0.0
    assert not solve_shear_limit(none, compliance, 1.0).traction.any()
