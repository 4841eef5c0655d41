"""Contact with a hardness: against Tamaas, a flattened sphere in closed form, and elastic contact below yield."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.rough.contact.normal_contact import apply, solve_normal_contact
from pipeline.physics.rough.contact.yielding_contact import solve_yielding_contact
from pipeline.physics.rough.generator import self_affine
from pipeline.physics.rough.layered_solid import half_space_compliance

YOUNG, POISSON = 1.0, 0.3
MODULUS = YOUNG / (1.0 - POISSON ** 2)
ROUGH = 0.01 * self_affine(np.random.default_rng(4), 64, 1.0, 1 / 8, 1 / 2, 0.8)
COMPLIANCE = half_space_compliance(ROUGH.shape, (1 / 64, 1 / 64), YOUNG, POISSON).normal


@pytest.mark.golden
@pytest.mark.parametrize("mean, hardness", [(0.02, 0.1), (0.005, 0.05)])
def test_agrees_with_tamaas(mean, hardness, capfd):
    tamaas = pytest.importorskip("tamaas")
    model = tamaas.Model(tamaas.model_type.basic_2d, [1.0, 1.0], list(ROUGH.shape))
    model.E, model.nu = YOUNG, POISSON
    solver = tamaas.KatoSaturated(model, ROUGH, 1e-10, hardness)
    solver.max_iter = 20000
    solver.solve(mean)
    ours = solve_yielding_contact(-ROUGH, COMPLIANCE, mean, tolerance=1e-7, hardness=hardness).pressure
    assert np.linalg.norm(ours - model.traction) < 1e-6 * np.linalg.norm(model.traction)


@pytest.mark.exact
def test_a_sphere_is_flattened():
    """In full yield the load is hardness times area, and the pressure uniform over a circle: the surface sinks by 2 H a
    / E* in its middle and 4 H a / (pi E*) at its edge (Johnson, Contact Mechanics, 1985, 3.4)."""
    nodes, radius, hardness, edge = 256, 100.0, 0.002, 40.0
    position = np.arange(nodes) - nodes // 2
    gap = (position[:, None] ** 2 + position ** 2) / (2.0 * radius)
    compliance = half_space_compliance((nodes, nodes), (1.0, 1.0), YOUNG, POISSON).normal
    mean = hardness * np.pi * edge ** 2 / nodes ** 2
    found = solve_yielding_contact(gap, compliance, mean, tolerance=1e-6, hardness=hardness)
    assert np.sqrt(np.count_nonzero(found.pressure) / np.pi) == pytest.approx(edge, rel=0.01)
    sunk = edge ** 2 / (2.0 * radius) - (1.0 - 2.0 / np.pi) * 2.0 * hardness * edge / MODULUS
    assert found.flattened.max() == pytest.approx(sunk, rel=0.01)
    assert np.argmax(found.flattened) == np.argmin(gap)


def test_below_the_hardness_contact_is_elastic():
    elastic = solve_normal_contact(-ROUGH, COMPLIANCE, 0.02, tolerance=1e-7)
    same = solve_yielding_contact(-ROUGH, COMPLIANCE, 0.02, tolerance=1e-7, hardness=1.001 * elastic.pressure.max())
    np.testing.assert_array_equal(same.pressure, elastic.pressure)
    assert same.approach == elastic.approach and not same.flattened.any()


def test_flattened_surfaces_carry_the_same_pressures_elastically():
    yielded = solve_yielding_contact(-ROUGH, COMPLIANCE, 0.02, tolerance=1e-8, hardness=0.1)
    again = solve_normal_contact(-ROUGH + yielded.flattened, COMPLIANCE, 0.02, tolerance=1e-8)
    np.testing.assert_allclose(again.pressure, yielded.pressure, atol=1e-4 * 0.1)
    assert yielded.flattened.max() > 0.1 * ROUGH.std()


def test_solution_is_complementary():
    found = solve_yielding_contact(-ROUGH, COMPLIANCE, 0.02, tolerance=1e-7, hardness=0.05)
    left = -ROUGH + apply(COMPLIANCE, found.pressure) - found.approach
    slack = 1e-7 * ROUGH.std()
    assert found.pressure.mean() == pytest.approx(0.02, rel=1e-10)
    assert found.pressure.min() >= 0.0 and found.pressure.max() <= 0.05
    assert left[found.pressure < 0.05].min() > -slack and left[found.pressure > 0].max() < slack
    np.testing.assert_allclose(found.flattened, np.where(found.pressure >= 0.05, -left, 0.0), atol=slack)


def test_the_softer_the_body_the_larger_the_contact():
    area = [np.count_nonzero(solve_yielding_contact(-ROUGH, COMPLIANCE, 0.01, hardness=h).pressure)
            for h in (np.inf, 0.1, 0.05, 0.02)]
    assert np.all(np.diff(area) > 0) and area[-1] >= 0.5 * ROUGH.size


def test_a_body_softer_than_the_load_is_refused():
    with pytest.raises(ConfigError, match="hardness.*pressed flat"):
        solve_yielding_contact(-ROUGH, COMPLIANCE, 0.02, hardness=0.02)


def test_non_convergence_raises():
    with pytest.raises(ConvergenceError, match="within 60 iterations"):
        solve_yielding_contact(-ROUGH, COMPLIANCE, 0.02, tolerance=1e-9, max_iterations=60, hardness=0.05)
