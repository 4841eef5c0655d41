"""Reduction of one body: a turning ring seen from rest, its surface, and a free block."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.elasticity import assemble, isotropic
from pipeline.physics.fem.mesh import revolve
from pipeline.physics.fem.supports import held_modes
from pipeline.physics.modal.quadratic_eigenproblem import quadratic_roots
from pipeline.physics.reduction.body import ElasticBody, reduce_body

SPEED = 12.0


@pytest.fixture(scope="module")
def ring():
    """A steel ring plate held at its bore, with its modes below 6 kHz, loaded axially at two places of its rim."""
    mesh = revolve(np.array([0.03, 0.06, 0.09, 0.12]), np.linspace(0, 2 * np.pi, 25), np.array([0.0, 0.006]))
    tables = np.zeros(len(mesh.element), int), np.array([7800.0]), isotropic(210e9, 0.3)[None]
    supported = np.flatnonzero(np.hypot(*mesh.node[:, :2].T) < 0.0301)
    frequency, modes = held_modes(*assemble(mesh.node, mesh.element, mesh.kind, *tables), supported, "superlu",
                                  below=6e3)
    rim = np.flatnonzero((np.hypot(*mesh.node[:, :2].T) > 0.1199) & (mesh.node[:, 2] == 0.006))
    rows = sp.csr_matrix((np.ones(2), ([0, 1], 3 * rim[:2] + 2)), (2, 3 * len(mesh.node)))
    return ElasticBody("ring", mesh.node, mesh.element, mesh.kind, *tables, 0.01, supported, rows, np.arange(2), True,
                       frequency, modes)


@pytest.fixture(scope="module")
def terms(ring):
    return reduce_body(ring, 30e3, 200e3, "superlu")


def nodal_diameters(ring, mode):
    """Circumferential order of the axial motion of the outer rim."""
    rim = (np.hypot(*ring.node[:, :2].T) > 0.1199) & (ring.node[:, 2] == 0.006)
    order = np.argsort(np.arctan2(ring.node[rim, 1], ring.node[rim, 0]))
    return int(abs(np.fft.rfft(mode.reshape(-1, 3)[rim, 2][order])).argmax())


@pytest.mark.exact
def test_a_standing_observer_sees_doublets_split_by_the_rotation(ring, terms):
    """Plate modes of n diameters at w in the turning ring appear at w +- n speed (Coriolis forces act in its plane)."""
    still = np.zeros_like(terms.mass)
    stiffness = terms.stiffness + SPEED**2 * terms.centrifugal
    seen = quadratic_roots(terms.mass, SPEED * terms.gyroscopic, stiffness)
    rest = quadratic_roots(terms.mass, still, terms.stiffness)
    seen, rest = (np.sort(r.imag[r.imag > 0]) for r in (seen, rest))
    doublets = [k for k in range(7) if rest[k + 1] - rest[k] < 1e-4 * rest[k]]
    orders = [nodal_diameters(ring, ring.modes[:, k]) for k in doublets]
    assert {1, 2, 3} <= set(orders)
    split = seen[np.array(doublets) + 1] - seen[doublets]
    np.testing.assert_allclose(split, 2 * SPEED * np.array(orders), rtol=1e-2)


@pytest.mark.exact
def test_rotation_stiffens_the_umbrella_mode(ring, terms):
    """Without diameters there is no convection: only the tension of rotation remains, w^2 = w0^2 + B speed^2, B > 0."""
    umbrella = next(k for k in range(9) if nodal_diameters(ring, ring.modes[:, k]) == 0)
    southwell = terms.centrifugal[umbrella, umbrella]
    assert 0.3 < southwell < 3.0
    np.testing.assert_array_equal(terms.gyroscopic, -terms.gyroscopic.T)
    assert abs(terms.gyroscopic[umbrella]).max() < 1e-2 * abs(terms.gyroscopic).max()


@pytest.mark.exact
def test_surface_follows_the_modes_and_supports_stay(ring, terms):
    nodes = [np.flatnonzero((ring.node == p).all(axis=1))[0] for p in terms.position]
    modes = ring.modes.reshape(-1, 3, len(ring.frequency))[nodes]
    np.testing.assert_allclose(terms.recovery[..., :len(ring.frequency)], modes, atol=1e-6 * abs(modes).max())
    assert not terms.recovery[np.isin(nodes, ring.supported)].any()
    area = np.linalg.norm(np.cross(terms.position[terms.face[:, 2]] - terms.position[terms.face[:, 0]],
                                   terms.position[terms.face[:, 3]] - terms.position[terms.face[:, 1]]), axis=1) / 2
    ring_area = 2 * np.pi * (0.12**2 - 0.03**2) + 2 * np.pi * 0.006 * (0.12 + 0.03)
    assert area.sum() == pytest.approx(ring_area, rel=2e-2)


@pytest.mark.exact
def test_free_body_keeps_its_rows_and_does_not_turn(ring):
    rows = sp.csr_matrix(np.eye(3 * len(ring.node))[[0, 1, 2, 301, 302, 600, 602]])
    free = replace(ring, supported=np.empty(0, int), rows=rows, interface=np.arange(7), turns=False)
    terms = reduce_body(free, 2e3, 1e5, "superlu")
    np.testing.assert_allclose(terms.rows[:, :7], np.eye(7), atol=1e-9)
    assert not terms.gyroscopic.any() and not terms.centrifugal.any()


@pytest.mark.exact
def test_a_free_body_of_rigid_motions_alone_keeps_its_static_answers(ring):
    """No elastic mode kept, two, or many: residual shapes make up for the rest of the elastic answer to two forces."""
    matrices = assemble(ring.node, ring.element, ring.kind, ring.material, ring.density, ring.elasticity)
    rim = np.flatnonzero((np.hypot(*ring.node[:, :2].T) > 0.1199) & (ring.node[:, 2] == 0.006))
    frequency, modes = held_modes(*matrices, np.empty(0, int), "superlu", count=60)
    rows = sp.csr_matrix(np.eye(3 * len(ring.node))[[3 * rim[0] + 2, 3 * rim[1] + 2]])
    found = []
    for kept in (6, 8, 60):
        free = replace(ring, supported=np.empty(0, int), rows=rows, interface=np.arange(2), turns=False,
                       patterns=sp.eye_array(2, format="csr"), frequency=frequency[:kept], modes=modes[:, :kept])
        made = reduce_body(free, 2e3, 1e6, "superlu")
        forces = made.rows.T @ [1.0, -1.0]
        elastic = np.diag(made.stiffness) > 1e3
        found.append(np.sum(forces[elastic] ** 2 / np.diag(made.stiffness)[elastic]))
    assert found == pytest.approx([found[-1]] * 3, rel=1e-2)


@pytest.mark.exact
def test_loss_factors_make_the_imaginary_stiffness_of_their_materials(ring):
    """One for all is that share of the stiffness; each of two materials adds its own part."""
    inner = np.hypot(*ring.node[ring.element].mean(axis=1)[:, :2].T) < 0.06
    halves = replace(ring, material=inner.astype(int), density=np.repeat(ring.density, 2),
                     elasticity=np.repeat(ring.elasticity, 2, axis=0))

    def loss(body, *factors):
        return reduce_body(replace(body, loss_factor=np.array(factors)), 30e3, 200e3, "superlu").loss

    stiffness = reduce_body(ring, 30e3, 200e3, "superlu").stiffness
    scale = abs(stiffness).max()
    np.testing.assert_allclose(loss(ring, 0.03), 0.03 * stiffness, atol=1e-12 * scale)
    first, second = loss(halves, 1.0, 0.0), loss(halves, 0.0, 1.0)
    np.testing.assert_allclose(first + second, stiffness, atol=1e-9 * scale)
    np.testing.assert_allclose(loss(halves, 0.02, 0.07), 0.02 * first + 0.07 * second, atol=1e-9 * scale)
    assert np.linalg.eigvalsh(first).min() > -1e-9 * scale and abs(first).max() > 0.01 * scale


@pytest.mark.exact
def test_the_part_of_a_material_is_what_its_moduli_scale(ring):
    inner = np.hypot(*ring.node[ring.element].mean(axis=1)[:, :2].T) < 0.06
    halves = replace(ring, material=inner.astype(int), density=np.repeat(ring.density, 2),
                     elasticity=np.repeat(ring.elasticity, 2, axis=0), loss_factor=np.array([0.0, 1.0]), part=(1,))
    terms = reduce_body(halves, 30e3, 200e3, "superlu")
    scale = abs(terms.stiffness).max()
    np.testing.assert_allclose(terms.part, terms.loss, atol=1e-9 * scale)      # the same material, all of it lost
    assert reduce_body(ring, 30e3, 200e3, "superlu").part is None


def test_turning_body_needs_a_mount(ring):
    with pytest.raises(ConfigError, match="rigid supports"):
        reduce_body(replace(ring, supported=np.empty(0, int)), 2e3, 1e5, "superlu")
