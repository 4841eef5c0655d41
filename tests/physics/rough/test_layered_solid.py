"""DFT condensation against the assembled periodic block; the half-space as its limit."""

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse.linalg import spsolve

from pipeline.contract.errors import ConfigError
from pipeline.physics.rough.contact.normal_contact import apply
from pipeline.physics.rough.layer_element import brick_stiffness
from pipeline.physics.rough.layered_solid import graded_depth, half_space_compliance, layered_compliance

SHAPE, SPACING, DEPTH = (6, 8), (0.7, 1.0), np.array([0.0, 0.5, 1.5, 3.5])


def assembled(youngs_modulus, poisson_ratio, factor=None):
    """Stiffness of the same block as one sparse matrix; degrees of freedom (plane, y, x, direction), base clamped.

    ``factor`` (layers, ny, nx): of the modulus of each element.
    """
    planes = DEPTH.size - 1
    number = np.arange(planes * SHAPE[0] * SHAPE[1] * 3).reshape(planes, *SHAPE, 3)
    rows, columns, values = [], [], []
    for layer, thickness in enumerate(np.diff(DEPTH)):
        element = brick_stiffness((SPACING[1], SPACING[0], thickness), youngs_modulus, poisson_ratio).reshape(24, 24)
        kept = np.repeat(np.tile([True, layer + 1 < planes], 4), 3)
        for y, x in np.ndindex(SHAPE):
            degrees = np.array([number[min(layer + c, planes - 1), (y + b) % SHAPE[0], (x + a) % SHAPE[1], i]
                                for a in (0, 1) for b in (0, 1) for c in (0, 1) for i in range(3)])[kept]
            rows.append(np.repeat(degrees, degrees.size))
            columns.append(np.tile(degrees, degrees.size))
            values.append((1.0 if factor is None else factor[layer, y, x]) * element[np.ix_(kept, kept)].ravel())
    entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))
    return sparse.csc_matrix(entries, shape=(number.size,) * 2)


@pytest.mark.exact
def test_condensation_equals_the_sparse_finite_elements():
    random = np.random.default_rng(1)
    traction = random.standard_normal(SHAPE)
    stiffness = assembled(2.0, 0.3)
    compliance = layered_compliance(SHAPE, SPACING, DEPTH, 2.0, 0.3)
    for axis, ours in ((2, apply(compliance.normal, traction)), (0, apply(compliance.along, traction)),
                       (1, apply(compliance.across, traction))):
        load = np.zeros((DEPTH.size - 1, *SHAPE, 3))
        load[0, :, :, axis] = traction * SPACING[0] * SPACING[1]
        reference = spsolve(stiffness, load.ravel()).reshape(load.shape)[0, :, :, axis]
        np.testing.assert_allclose(ours, reference, atol=1e-12 * np.abs(reference).max())


@pytest.mark.exact
def test_lift_by_shear_equals_the_sparse_finite_elements_and_nears_the_half_space():
    traction = np.random.default_rng(2).standard_normal(SHAPE)
    load = np.zeros((DEPTH.size - 1, *SHAPE, 3))
    load[0, :, :, 0] = traction * SPACING[0] * SPACING[1]
    reference = spsolve(assembled(2.0, 0.3), load.ravel()).reshape(load.shape)[0, :, :, 2]
    ours = apply(layered_compliance(SHAPE, SPACING, DEPTH, 2.0, 0.3).lift, traction)
    np.testing.assert_allclose(ours, reference, atol=1e-12 * np.abs(reference).max())
    fine = layered_compliance((4, 32), (1 / 32,) * 2, np.linspace(0.0, 2.0, 65), 2.0, 0.3).lift[0, 1]
    assert fine == pytest.approx(half_space_compliance((4, 32), (1 / 32,) * 2, 2.0, 0.3).lift[0, 1], rel=0.02)


@pytest.mark.exact
def test_uniform_pressure_meets_the_oedometer():
    compliance = layered_compliance((4, 4), (1.0, 1.0), DEPTH, 2.0, 0.3)
    oedometer = 2.0 * 0.7 / (1.3 * 0.4)
    assert compliance.normal[0, 0] == pytest.approx(DEPTH[-1] / oedometer, rel=1e-12)


@pytest.mark.exact
def test_fine_grids_approach_the_half_space_at_second_order():
    error = []
    for nodes in (16, 32):
        depth = np.linspace(0.0, 2.0, 2 * nodes + 1)
        block = layered_compliance((4, nodes), (1.0 / nodes,) * 2, depth, 2.0, 0.3).normal[0, 1]
        error.append(abs(block / half_space_compliance((4, nodes), (1.0 / nodes,) * 2, 2.0, 0.3).normal[0, 1] - 1.0))
    assert error[1] < 0.01
    assert np.log2(error[0] / error[1]) == pytest.approx(2.0, abs=0.2)


def test_graded_depth_reaches_the_thickness():
    depth = graded_depth(8e-6, 1e-3, 1.5)
    assert depth[0] == 0.0 and depth[-1] == pytest.approx(1e-3)
    np.testing.assert_allclose(np.diff(depth)[1:] / np.diff(depth)[:-1], 1.5)
    assert depth[1] <= 8e-6


def test_a_layer_thicker_than_the_block_is_refused():
    with pytest.raises(ConfigError, match="0 < first layer <= thickness"):
        graded_depth(2e-3, 1e-3, 1.5)
