"""Normal contact against Hertz, Westergaard and Tamaas; the perimeter-corrected area; the interface stiffness."""

import numpy as np
import pytest
from scipy import sparse

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.closed_form import hertz, westergaard
from pipeline.physics.rough.contact.normal_contact import (
    apply,
    contact_area,
    full_contact_pressure,
    interface_stiffness,
    solve_normal_contact,
)
from pipeline.physics.rough.generator import resample, self_affine
from pipeline.physics.rough.layer_element import brick_stiffness
from pipeline.physics.rough.layered_solid import graded_depth, half_space_compliance, layered_compliance

YOUNG, POISSON = 1.0, 0.3
MODULUS = YOUNG / (1.0 - POISSON ** 2)


@pytest.mark.exact
def test_hertz_on_finite_elements():
    nodes, radius = 192, 300.0
    position = np.arange(nodes) - nodes // 2
    load = 4.0 * MODULUS * 20.0 ** 3 / (3.0 * radius)
    gap = (position[:, None] ** 2 + position ** 2) / (2.0 * radius)
    block = layered_compliance((nodes, nodes), (1.0, 1.0), graded_depth(1.0, 400.0, 1.5), YOUNG, POISSON)
    pressure = solve_normal_contact(gap, block.normal, load / nodes ** 2).pressure
    radius_found = np.sqrt(np.count_nonzero(pressure) / np.pi)
    assert radius_found == pytest.approx(hertz.contact_radius(load, radius, MODULUS), rel=0.02)
    assert pressure.max() == pytest.approx(hertz.peak_pressure(load, radius, MODULUS), rel=0.02)


@pytest.mark.exact
@pytest.mark.parametrize("share", [0.1, 0.2, 0.5])
def test_westergaard_on_finite_elements(share):
    nodes, amplitude = 128, 0.01
    position = np.arange(nodes) / nodes
    mean = share * westergaard.full_contact_pressure(amplitude, 1.0, MODULUS)
    block = layered_compliance((4, nodes), (1.0 / nodes,) * 2, graded_depth(1.0 / nodes, 3.0, 1.2), YOUNG, POISSON)
    gap = np.tile(-amplitude * np.cos(2.0 * np.pi * position), (4, 1))
    pressure = solve_normal_contact(gap, block.normal, mean).pressure[0]
    exact = westergaard.pressure(position, mean, amplitude, 1.0, MODULUS)
    assert np.linalg.norm(pressure - exact) < 0.01 * np.linalg.norm(exact)
    contact = np.count_nonzero(pressure) / nodes
    assert contact == pytest.approx(westergaard.contact_share(mean, amplitude, 1.0, MODULUS), rel=0.04)


@pytest.fixture(scope="module")
def rough():
    return 0.01 * self_affine(np.random.default_rng(4), 64, 1.0, 1 / 8, 1 / 2, 0.8)


@pytest.mark.golden
def test_agrees_with_tamaas_on_the_half_space(rough):
    tamaas = pytest.importorskip("tamaas")
    model = tamaas.Model(tamaas.model_type.basic_2d, [1.0, 1.0], list(rough.shape))
    model.E, model.nu = YOUNG, POISSON
    solver = tamaas.PolonskyKeerRey(model, rough, 1e-14)
    solver.max_iter = 5000
    solver.solve(0.02)
    compliance = half_space_compliance(rough.shape, (1 / 64, 1 / 64), YOUNG, POISSON)
    ours = solve_normal_contact(-rough, compliance.normal, 0.02, tolerance=1e-9).pressure
    assert np.linalg.norm(ours - model.traction) < 1e-6 * np.linalg.norm(model.traction)


def test_solution_is_complementary(rough):
    compliance = half_space_compliance(rough.shape, (1 / 64, 1 / 64), YOUNG, POISSON).normal
    found = solve_normal_contact(-rough, compliance, 0.02, tolerance=1e-8)
    gap = -rough + apply(compliance, found.pressure) - found.approach
    assert found.pressure.min() == 0.0 and found.pressure.mean() == pytest.approx(0.02, rel=1e-12)
    assert gap.min() > -1e-8 * rough.std()
    assert np.abs(gap[found.pressure > 0]).max() < 1e-8 * rough.std()


def test_a_warm_start_changes_the_path_not_the_result(rough):
    compliance = half_space_compliance(rough.shape, (1 / 64, 1 / 64), YOUNG, POISSON).normal
    cold = solve_normal_contact(-rough, compliance, 0.02, tolerance=1e-9)
    warm = solve_normal_contact(-rough, compliance, 0.02, cold.pressure, 1e-9)
    assert warm.iterations < cold.iterations
    np.testing.assert_allclose(warm.pressure, cold.pressure, atol=1e-6 * cold.pressure.max())


def test_any_start_leads_to_the_same_contact(rough):
    compliance = half_space_compliance(rough.shape, (1 / 64, 1 / 64), YOUNG, POISSON).normal
    cold = solve_normal_contact(-rough, compliance, 0.02, tolerance=1e-9)
    for start in (np.random.default_rng(5).normal(size=rough.shape), np.eye(64), np.maximum(-rough, 0.0)):
        found = solve_normal_contact(-rough, compliance, 0.02, start, 1e-9)
        np.testing.assert_allclose(found.pressure, cold.pressure, atol=1e-6 * cold.pressure.max())
        assert found.approach == pytest.approx(cold.approach, rel=1e-8)


@pytest.mark.exact
def test_corrected_area_of_a_disc():
    position = np.arange(100) - 50.3
    mask = position[:, None] ** 2 + position ** 2 < 20.0 ** 2
    counted, corrected = contact_area(mask)
    switches = 2 * (np.any(mask, axis=0).sum() + np.any(mask, axis=1).sum())
    assert counted == mask.mean()
    assert corrected == pytest.approx(counted - (np.pi - 1 + np.log(2)) / 24 * switches / mask.size, rel=1e-14)


@pytest.mark.exact
def test_corrected_area_converges_at_eight_nodes_per_wavelength(rough):
    area = []
    for nodes in (64, 256):
        compliance = half_space_compliance((nodes, nodes), (1 / nodes,) * 2, YOUNG, POISSON).normal
        solution = solve_normal_contact(-resample(rough, (nodes, nodes)), compliance, 0.005, tolerance=1e-5)
        area.append(contact_area(solution.pressure > 0))
    (counted, corrected), (_, converged) = area
    assert corrected == pytest.approx(converged, rel=0.03)
    assert counted > converged * 1.1


@pytest.mark.exact
def test_interface_stiffness_leaves_out_the_uniform_compliance_of_the_blocks(rough):
    """Blocks twice as thick give twice the uniform compliance under the same rough interface."""
    stiffness = []
    for thickness in (2.0, 4.0):
        block = layered_compliance((64, 64), (1 / 64, 1 / 64), graded_depth(1 / 64, thickness, 1.3), YOUNG, POISSON)
        contact = solve_normal_contact(-rough, block.normal, 0.01, tolerance=1e-7)
        stiffness.append(interface_stiffness(-rough, block.normal, contact, 1e-7, 2000))
    assert stiffness[0] > 0.0
    assert stiffness[1] == pytest.approx(stiffness[0], rel=2e-3)


def test_non_convergence_raises(rough):
    compliance = half_space_compliance(rough.shape, (1 / 64, 1 / 64), YOUNG, POISSON).normal
    with pytest.raises(ConvergenceError, match="within 3 iterations"):
        solve_normal_contact(-rough, compliance, 0.02, max_iterations=3)


def test_a_flat_gap_is_refused():
    with pytest.raises(ConfigError, match="a gap that varies"):
        solve_normal_contact(np.zeros((8, 8)), np.ones((8, 5)), 1.0)


@pytest.mark.slow
@pytest.mark.exact
def test_explicit_dynamics_comes_to_rest_at_the_same_contact():
    """The paper's method as a cross-check: lumped masses, central differences, a damped plate carrying the load.

    A rigid rough plate is pressed on an elastic block through a penalty; the same penalty is a uniform compliance
    that adds to the block's in the quasi-static solution.
    """
    nodes, young, mean, penalty = 32, 1.0, 0.01, 32.0
    spacing, depth = 1.0 / nodes, graded_depth(1.0 / nodes, 0.25, 1.5)
    rough = 0.02 * self_affine(np.random.default_rng(4), nodes, 1.0, 1 / 8, 1 / 2, 0.8)
    stiffness, area = periodic_block(nodes, depth, young), spacing ** 2
    surface = np.arange(nodes ** 2) * 3 + 2
    largest = np.abs(stiffness).sum(axis=1)
    largest[surface] += penalty * area
    mass, plate_mass = largest.copy(), penalty
    displacement, velocity = np.zeros(stiffness.shape[0]), np.zeros(stiffness.shape[0])
    plate, plate_velocity, damping = rough.max(), 0.0, 0.02
    for _ in range(2500):
        overlap = np.maximum(rough.ravel() - plate + displacement[surface], 0.0)
        force = -stiffness @ displacement
        force[surface] -= penalty * area * overlap
        velocity = (1.0 - damping) * velocity + force / mass
        plate_velocity = (1.0 - damping) * plate_velocity + (penalty * overlap.mean() - mean) / plate_mass
        displacement, plate = displacement + velocity, plate + plate_velocity
    assert penalty * overlap.mean() == pytest.approx(mean, rel=1e-5)
    block = layered_compliance((nodes, nodes), (spacing, spacing), depth, young, 0.3).normal
    static = solve_normal_contact(-rough, block + 1.0 / penalty, mean, tolerance=1e-8)
    assert np.count_nonzero(overlap) == pytest.approx(np.count_nonzero(static.pressure), rel=0.01)
    np.testing.assert_allclose(penalty * overlap, static.pressure.ravel(), atol=0.01 * static.pressure.max())


def periodic_block(nodes, depth, young):
    """Sparse stiffness of the block, base clamped; degrees of freedom (plane, y, x, direction)."""
    planes = depth.size - 1
    number = np.arange(planes * nodes ** 2 * 3).reshape(planes, nodes, nodes, 3)
    entries = []
    for layer, thickness in enumerate(np.diff(depth)):
        element = brick_stiffness((1.0 / nodes, 1.0 / nodes, thickness), young, 0.3)
        corners = [(a, b, c) for a in (0, 1) for b in (0, 1) for c in (0, 1) if layer + c < planes]
        for one in corners:
            for other in corners:
                rows, columns = (np.roll(number[layer + c], (-b, -a), (0, 1)).reshape(-1, 3)
                                 for a, b, c in (one, other))
                pair = np.broadcast_to(element[(*one, slice(None), *other)], (len(rows), 3, 3))
                entries.append((pair.ravel(), np.repeat(rows, 3, axis=1).ravel(), np.tile(columns, (1, 3)).ravel()))
    values, rows, columns = (np.concatenate(part) for part in zip(*entries, strict=True))
    return sparse.csr_array((values, (rows, columns)), shape=(number.size,) * 2)


@pytest.mark.exact
def test_full_contact_of_a_wavy_surface():
    """p* = pi E* amplitude / wavelength (Johnson 1985, 13.4): just below a node is open, just above none."""
    nodes, amplitude = 64, 0.01
    gap = np.tile(-amplitude * np.cos(2.0 * np.pi * np.arange(nodes) / nodes), (4, 1))
    compliance = half_space_compliance((4, nodes), (1.0 / nodes,) * 2, YOUNG, POISSON).normal
    flat = full_contact_pressure(gap, compliance)
    assert flat == pytest.approx(westergaard.full_contact_pressure(amplitude, 1.0, MODULUS), rel=1e-12)
    below, above = (solve_normal_contact(gap, compliance, share * flat).pressure for share in (0.98, 1.02))
    assert below.min() == 0.0 and above.min() > 0.0
    with pytest.raises(ConfigError, match="a load that leaves nodes open"):
        interface_stiffness(gap, compliance, solve_normal_contact(gap, compliance, 1.1 * flat), 1e-6, 2000)


@pytest.mark.exact
def test_a_single_touching_node_bears_the_load(rough):
    compliance = half_space_compliance(rough.shape, (1 / 64, 1 / 64), YOUNG, POISSON).normal
    pressure = solve_normal_contact(-rough, compliance, 1e-9).pressure
    assert np.count_nonzero(pressure) == 1 and np.argmax(pressure) == np.argmax(rough)
    assert pressure.sum() == pytest.approx(1e-9 * rough.size, rel=1e-12)


@pytest.mark.exact
@pytest.mark.parametrize("tolerance", [1e-4, 1e-8])
def test_rounding_stays_below_the_tolerance_where_the_blocks_move_by_far_more_than_the_gap(rough, tolerance):
    compliance = half_space_compliance(rough.shape, (1.0, 1.0), YOUNG, POISSON).normal
    compliance[0, 0] = 1e5 * rough.std() / 0.02
    pressure = solve_normal_contact(1e3 - rough, compliance, 0.02, tolerance=tolerance).pressure
    distance = apply(compliance, pressure) - rough
    distance -= distance[pressure > 0.0].mean()
    assert pressure.mean() == pytest.approx(0.02)
    assert abs(distance[pressure > 0.0]).max() < 1.01 * tolerance * rough.std()
    assert distance.min() > -1.01 * tolerance * rough.std()
