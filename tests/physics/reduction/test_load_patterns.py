"""Load patterns: what they span, faces of few contacts, and modes on an elastic foundation that they converge to."""

from dataclasses import replace

import numpy as np
import pytest
import scipy
import scipy.sparse as sp

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.elasticity import assemble, isotropic
from pipeline.physics.fem.face_averages import along, face_points, foundation, surface_rows
from pipeline.physics.fem.mesh import boundary_faces, face_normals, revolve
from pipeline.physics.fem.supports import held_modes
from pipeline.physics.reduction.body import ElasticBody, reduce_body
from pipeline.physics.reduction.load_patterns import load_patterns

#: foundation under the block, Pa/m
FOUNDATION = 5e12


def grid(count=(9, 5), size=(0.1, 0.04), shift=0.0):
    x, y = np.meshgrid(*(np.linspace(0, s, n) for s, n in zip(size, count, strict=True)), indexing="ij")
    return np.column_stack((x.ravel() + shift, y.ravel(), 0 * x.ravel()))


@pytest.mark.exact
def test_patterns_span_the_polynomials_of_their_orders():
    position, area = grid(), np.linspace(1, 2, 45)
    patterns = load_patterns(position, area, np.zeros(45, int), (2, 1)).toarray()
    assert patterns.shape == (45, 6)
    x, y = (position - 0.02)[:, :2].T
    for load in (1 + 0 * x, x, y, x * y, x**2, x**2 * y):
        assert scipy.linalg.lstsq(patterns, area * load)[1] == pytest.approx(0, abs=1e-20)
    assert scipy.linalg.lstsq(patterns, area * x**3)[1] > 1e-12


@pytest.mark.exact
def test_each_face_has_patterns_of_its_own_whatever_the_order_of_contacts():
    position = np.vstack((grid(), grid(shift=0.3)))
    group, order = np.repeat([4, 7], 45), np.random.default_rng(1).permutation(90)
    patterns = load_patterns(position, np.ones(90), group, (3, 2)).toarray()
    assert not patterns[:45, 12:].any() and not patterns[45:, :12].any()
    mixed = load_patterns(position[order], np.ones(90), group[order], (3, 2)).toarray()
    for face in (slice(0, 12), slice(12, 24)):     # principal axes may change sides
        np.testing.assert_allclose(abs(mixed[:, face]), abs(patterns[order][:, face]), atol=1e-12)


@pytest.mark.exact
def test_a_face_of_few_contacts_has_one_pattern_for_each():
    patterns = load_patterns(grid((3, 2)), np.ones(6), np.zeros(6, int), (2, 1)).toarray()
    np.testing.assert_array_equal(patterns, np.eye(6))


def test_orders_below_zero_are_refused():
    with pytest.raises(ConfigError, match="orders of at least 0"):
        load_patterns(grid(), np.ones(45), np.zeros(45, int), (2, -1))


@pytest.fixture(scope="module")
def block():
    """A free sector of a ring whose lower face is read at its integration points, and its modes below 60 kHz."""
    mesh = revolve(np.linspace(0.1, 0.14, 3), np.linspace(-0.3, 0.3, 5), np.array([0.0, 0.008, 0.014]))
    tables = np.zeros(len(mesh.element), int), np.array([2600.0]), isotropic(3e9, 0.2)[None]
    face = boundary_faces(mesh)
    face = face[face_normals(mesh.node, face)[0][:, 2] < -0.99]
    point, area = (a.reshape(-1, *a.shape[2:]) for a in face_points(mesh.node, face))
    mean = surface_rows(mesh.node, face, point, area, np.arange(len(point)))
    rows = along(mean, np.tile([0.0, 0.0, 1.0], (len(point), 1)))
    matrices = assemble(mesh.node, mesh.element, mesh.kind, *tables)
    frequency, modes = held_modes(*matrices, np.empty(0, int), "superlu", below=60e3)
    body = ElasticBody("block", mesh.node, mesh.element, mesh.kind, *tables, 0.0, np.empty(0, int), rows,
                       np.arange(len(point)), False, frequency, modes)
    return body, face, point, area, matrices


@pytest.mark.exact
def test_springs_at_the_integration_points_are_the_elastic_foundation(block):
    body, face, _, area, _ = block
    springs = body.rows.T @ sp.diags(FOUNDATION * area) @ body.rows
    spread = foundation(body.node, face, np.diag([0.0, 0.0, FOUNDATION]))
    assert abs(springs - spread).max() < 1e-12 * abs(spread).max()


@pytest.mark.exact
def test_modes_on_a_foundation_converge_with_the_orders_of_the_patterns(block):
    """Against the finite-element model itself, without the three motions in its plane that nothing holds."""
    body, _, point, area, (stiffness, mass) = block
    held = stiffness + body.rows.T @ sp.diags(FOUNDATION * area) @ body.rows
    exact = np.sqrt(scipy.linalg.eigh(held.toarray(), mass.toarray(), eigvals_only=True)[3:20])
    errors = []
    for orders in ((1, 1), (3, 2), (6, 4)):
        patterns = load_patterns(point, area, np.zeros(len(point), int), orders)
        terms = reduce_body(replace(body, patterns=patterns), 60e3, 1e9, "superlu")
        springs = terms.rows.T @ (FOUNDATION * area[:, None] * terms.rows)
        root = np.sqrt(scipy.linalg.eigh(terms.stiffness + springs, terms.mass, eigvals_only=True)[3:20])
        errors.append((root / exact - 1).max())
    assert errors[0] > 10 * errors[1] > 100 * errors[2] > 0 and errors[2] < 2e-4


def test_a_free_body_without_modes_is_refused(block):
    body, _, point, area, _ = block
    patterns = load_patterns(point, area, np.zeros(len(point), int), (1, 1))
    bare = replace(body, patterns=patterns, frequency=body.frequency[:0], modes=body.modes[:, :0])
    with pytest.raises(ConfigError, match="rigid motions among the modes"):
        reduce_body(bare, 60e3, 1e9, "superlu")
