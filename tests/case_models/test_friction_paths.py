"""Systems over the share of friction end in the modes of the operating point; their paths become fields."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from pipeline.case_models.friction_paths import followed, on_surface, over_friction, path_fields
from pipeline.case_models.steady_sliding import posed
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.modal.nearest_modes import modes_near
from pipeline.physics.sliding.equilibrium import closure_response
from pipeline.physics.stability.friction_basis import friction_basis
from pipeline.physics.stability.friction_path import FrictionPath
from pipeline.physics.stability.growth_balance import Losses
from pipeline.products.motion import COUPLING, FALLING, SINGLE
from stages.complex_modes import Settings, _linearised
from stages.reduced_model import Settings as Reduction
from stages.reduced_model import reduced_model
from tests.stages.small_brake import small_brake
from tests.stages.small_structure import small_structure

FRICTION = 0.5
SETTINGS = Settings(friction_damping=False)
LINEARISED = partial(_linearised, settings=SETTINGS)


@pytest.fixture(scope="module")
def point():
    """(model about steady sliding, Steady, what loss factors add, root, motion) of a mode that flutters."""
    product = reduced_model(small_structure(), settings=Reduction(fixed_below="20 kHz"))
    product = replace(product, loss=1e-3 * product.stiffness)
    case = posed(product, 1, 10.0, 1.0)
    load = product.pressure[1] * product.input_area
    sliding = case.slide(closure_response(case.bench.model), load, constant(FRICTION), FRICTION, SETTINGS)
    model = sliding.about(case.bench.model)
    mass, damping, stiffness = model.linearised(sliding.acting(), friction_damping=False)
    more = Losses.of(product).change(case.base.model)
    roots, shapes = modes_near(mass, damping + more[0], stiffness + more[1], 1.2e4j, 12)
    top = int(np.argmax(roots.real))
    assert roots[top].real > 100
    return model, sliding, more, roots[top], shapes[:, top]


@pytest.mark.exact
def test_a_basis_without_the_mode_still_ends_in_it(point):
    model, sliding, more, root, motion = point
    basis = friction_basis(model, 3000.0, friction_damping=False, smallest=np.inf)
    over = over_friction(LINEARISED, model, sliding, basis, motion[:, None], more)
    assert basis.shape.shape[1] < over.basis.shape[1] < model.size
    matrices, beside = over.system(1.0)
    nearest, _ = modes_near(*matrices, root * 1.001, 1, beside)
    assert beside is None and nearest[0] == pytest.approx(root, rel=1e-9)
    still, _ = over.system(0.0)
    expected = over.basis.T @ (model.frictionless()[2] + more[1]) @ over.basis
    np.testing.assert_allclose(still[2], expected, atol=1e-9 * abs(expected).max())


@pytest.mark.exact
def test_along_the_path_roots_are_those_of_the_whole_model_with_less_friction(point):
    model, sliding, more, root, motion = point
    basis = friction_basis(model, 1e7, friction_damping=False, smallest=np.inf)      # all of them
    over = over_friction(LINEARISED, model, sliding, basis, motion[:, None], more)
    path = followed(1e-6, over, root, motion)
    assert path.root[-1] == pytest.approx(root, rel=1e-8) and path.start.shape == (model.size, 2)
    assert 0 < path.critical < 1 and path.alike > 0.5
    for k in range(0, len(path.share), 7):
        mass, damping, stiffness = model.linearised(FRICTION * path.share[k], friction_damping=False)
        nearest, _ = modes_near(mass, damping + more[0], stiffness + more[1], path.root[k] * 1.0001, 1)
        assert nearest[0] == pytest.approx(path.root[k], rel=1e-8)


def test_motions_on_the_surface_are_those_of_the_recovery():
    product = small_brake()
    size, random = product.recovery.shape[2], np.random.default_rng(0)
    motions = random.standard_normal((2, size + 1)) + 1j * random.standard_normal((2, size + 1))
    expected = np.einsum("vxn,gn->gvx", product.recovery, motions[:, :size])
    np.testing.assert_allclose(on_surface(product, motions), expected, rtol=1e-5, atol=1e-6 * abs(expected).max())
    assert on_surface(product, []).shape == (0, *product.recovery.shape[:2])


def test_paths_become_fields():
    """Two paths, the second of a mode that meets none; frequencies of the first pair cross."""
    product = small_brake()
    starts = np.zeros((2, 10, 2))
    starts[0, 0, 0], starts[0, 1, 1], starts[1, 9, 0] = 1.0, 1.0, 2.0
    rising = np.array([5 + 1000j, 6 + 1010j, 7 + 1020j])
    paths = [FrictionPath(np.array([0, 0.5, 1]), rising, np.array([1 + 1005j, 1 + 1006j, 0]), 0.5, 0.9, starts[0]),
             FrictionPath(np.array([0, 1.0]), rising[:2], np.zeros(2, complex), 0.25, 0.0, starts[1])]
    made = path_fields(np.array([0, 3]), paths, np.array([0.4, 0.6]), [True, False], product,
                       lambda shapes: np.arange(len(shapes)))
    np.testing.assert_allclose(made["followed_critical"], [0.2, 0.15])
    np.testing.assert_allclose(made["path_friction"], [0, 0.2, 0.4, 0, 0.6])
    assert made["path_mode"].tolist() == [0, 0, 0, 3, 3] and made["followed_nearest"] == [0.0, 0.0]
    assert made["pair_body"].tolist() == [[0, 1], [3, -1]] and made["pair_diameters"].tolist() == [[0, 1], [2, -1]]
    assert made["pair_root"].tolist() == [[5 + 1000j, 1 + 1005j], [5 + 1000j, 0]]
    apart = path_fields(np.array([0]), [replace(paths[0], meeting=rising + 30j)], np.array([0.4]), [False], product,
                        lambda shapes: np.arange(len(shapes)))
    assert made["followed_mechanism"] == [FALLING, SINGLE] and apart["followed_mechanism"] == [COUPLING]
    assert apart["followed_nearest"] == [pytest.approx(30 / (2 * np.pi))]
    none = path_fields(np.empty(0, int), [], np.empty(0), [], product, lambda shapes: np.arange(len(shapes)))
    assert all(len(values) == 0 for values in none.values())
