"""Craig-Bampton and attachment modes against the full model of a free plate and a clamped one."""

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.linalg import eigh

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.elasticity import assemble, isotropic
from pipeline.physics.fem.mesh import block
from pipeline.physics.modal.natural_modes import lowest_modes
from pipeline.physics.numerics.sparse_solver import factorise
from pipeline.physics.reduction.craig_bampton import (
    attachment,
    craig_bampton,
    independent_rows,
    modal_damping,
    projected,
)

DENSITY = np.array([7800.0])


@pytest.fixture(scope="module")
def plate():
    """(nodes, stiffness, mass) of a free steel plate 120 x 60 x 10 mm of 20-node bricks."""
    mesh = block(np.linspace(0, 0.12, 9), np.linspace(0, 0.06, 5), np.linspace(0, 0.01, 2))
    matrices = assemble(mesh.node, mesh.element, mesh.kind, np.zeros(len(mesh.element), int), DENSITY,
                        isotropic(210e9, 0.3)[None])
    return mesh.node, *matrices


def patch_rows(node):
    """Mean displacement of the four quarters of the lower face along x, y, z."""
    lower = np.flatnonzero(node[:, 2] == 0)
    quarter = 2 * (node[lower, 0] > 0.06).astype(int) + (node[lower, 1] > 0.03)
    rows = np.zeros((12, 3 * len(node)))
    for patch in range(4):
        nodes = lower[quarter == patch]
        for axis in range(3):
            rows[3 * patch + axis, 3 * nodes + axis] = 1 / len(nodes)
    return sp.csr_matrix(rows)


def frequencies(body):
    return np.sqrt(np.maximum(eigh(body.stiffness, body.mass, eigvals_only=True), 0)) / (2 * np.pi)


def rigid_motions(node):
    """(3n, 6) translations along and rotations about x, y, z."""
    turns = [np.cross(axis, node).ravel() for axis in np.eye(3)]
    return np.column_stack([*(np.tile(axis, len(node)) for axis in np.eye(3)), *turns])


@pytest.mark.exact
def test_craig_bampton_converges_to_the_full_modes_of_a_free_plate(plate):
    node, stiffness, mass = plate
    full = lowest_modes(stiffness, mass, "superlu", count=14, shift=1e3)[0][6:]
    errors = []
    for below in (40e3, 80e3, 160e3):
        body = craig_bampton(stiffness, mass, patch_rows(node), below, "superlu")
        errors.append(frequencies(body)[6:14] / full - 1)
    errors = np.array(errors)
    assert (errors > -1e-8).all()
    order = np.log2(errors.max(axis=1)[:-1] / errors.max(axis=1)[1:])
    assert (order > 2).all()


@pytest.mark.exact
def test_residual_inertia_squares_the_errors_of_craig_bampton(plate):
    """Errors fall with the fourth power of frequency instead of the second: by 16 and 4 when the limit doubles."""
    node, stiffness, mass = plate
    full = lowest_modes(stiffness, mass, "superlu", count=9, shift=1e3)[0][6:]
    for residual_below, least in ((None, 2.0), (np.inf, 3.0)):
        bodies = [craig_bampton(stiffness, mass, patch_rows(node), below, "superlu", residual_below)
                  for below in (40e3, 160e3)]
        coarse, fine = (frequencies(body)[6:9] / full - 1 for body in bodies)
        assert np.log2(coarse.max() / fine.max()) / 2 > least
        rows = patch_rows(node) @ bodies[0].shape
        np.testing.assert_allclose(rows[:, 12:], 0.0, atol=1e-8 * abs(bodies[0].shape).max())
    assert coarse.max() < 1e-6


@pytest.mark.exact
def test_rigid_motions_and_static_interface_loads_are_exact(plate):
    node, stiffness, mass = plate
    rows = patch_rows(node)
    body = craig_bampton(stiffness, mass, rows, 5e3, "superlu")
    rigid = rigid_motions(node)
    boundary = np.vstack((rows @ rigid, np.zeros((body.mass.shape[0] - body.boundary, 6))))
    np.testing.assert_allclose(body.shape @ boundary, rigid, atol=1e-9)
    np.testing.assert_allclose(boundary.T @ body.mass @ boundary, rigid.T @ (mass @ rigid), rtol=1e-9, atol=1e-12)

    force = np.random.default_rng(0).standard_normal(3)
    held = factorise(stiffness + 1e9 * (rows[3:].T @ rows[3:]), "superlu").solve(rows[:3].T @ force)
    small_rows = rows @ body.shape
    spring = 1e9 * small_rows[3:].T @ small_rows[3:]
    reduced = np.linalg.solve(body.stiffness + spring, small_rows[:3].T @ force)
    np.testing.assert_allclose(body.shape @ reduced, held, atol=1e-8 * abs(held).max())


@pytest.mark.exact
def test_fixed_interface_modes_hold_the_averages_only(plate):
    node, stiffness, mass = plate
    rows = patch_rows(node)
    body = craig_bampton(stiffness, mass, rows, 40e3, "superlu")
    interface = rows @ body.shape
    expected = np.hstack((np.eye(body.boundary), np.zeros((body.boundary, len(body.frequency)))))
    np.testing.assert_allclose(interface, expected, atol=1e-9)
    fixed = body.shape[:, body.boundary:]
    np.testing.assert_allclose(fixed.T @ (mass @ fixed), np.eye(len(body.frequency)), atol=1e-8)
    assert abs(fixed[:, 0]).max() > 0 and (np.diff(body.frequency) >= 0).all() and body.frequency[-1] < 40e3


@pytest.mark.exact
def test_rows_that_select_nodes_give_the_textbook_method(plate):
    node, stiffness, mass = plate
    end = np.flatnonzero(node[:, 0] == 0)
    held = (3 * end[:, None] + np.arange(3)).ravel()
    inner = np.setdiff1d(np.arange(3 * len(node)), held)
    rows = sp.csr_matrix(np.eye(3 * len(node))[held])
    body = craig_bampton(stiffness, mass, rows, 30e3, "superlu")
    block = factorise(stiffness[inner][:, inner], "superlu")
    constraint = -block.solve(stiffness[inner][:, held].toarray())
    np.testing.assert_allclose(body.shape[inner, :len(held)], constraint, atol=1e-7)
    cantilever = lowest_modes(stiffness[inner][:, inner], mass[inner][:, inner], "superlu", below=30e3)[0]
    np.testing.assert_allclose(body.frequency, cantilever, rtol=1e-8)


@pytest.fixture(scope="module")
def mounted(plate):
    """The plate clamped at x = 0, with its patch rows."""
    node, stiffness, mass = plate
    free = np.flatnonzero(np.repeat(node[:, 0] > 0, 3))
    return stiffness[free][:, free], mass[free][:, free], patch_rows(node)[:, free]


@pytest.mark.exact
def test_residual_attachment_makes_the_static_response_exact(mounted):
    stiffness, mass, rows = mounted
    frequency, modes = lowest_modes(stiffness, mass, "superlu", below=20e3)
    body = attachment(stiffness, mass, rows, frequency, modes, np.inf, factorise(stiffness, "superlu"))
    force = np.arange(1.0, rows.shape[0] + 1)
    reduced = body.shape @ np.linalg.solve(body.stiffness, (rows @ body.shape).T @ force)
    expected = factorise(stiffness, "superlu").solve(rows.T @ force)
    np.testing.assert_allclose(reduced, expected, atol=1e-8 * abs(expected).max())
    modal_only = modes @ (modes.T @ (rows.T @ force) / (2 * np.pi * frequency) ** 2)
    assert abs(modal_only - expected).max() > 1e-4 * abs(expected).max()
    np.testing.assert_allclose(projected(mass, body.shape), body.mass, atol=1e-8)
    np.testing.assert_allclose(projected(stiffness, body.shape), body.stiffness, atol=1e-7 * body.stiffness.max())


def test_pseudo_modes_are_cut_at_the_declared_frequency(mounted):
    stiffness, mass, rows = mounted
    frequency, modes = lowest_modes(stiffness, mass, "superlu", below=20e3)
    every = attachment(stiffness, mass, rows, frequency, modes, np.inf, factorise(stiffness, "superlu")).frequency
    cut = np.median(every[len(frequency):])
    kept = attachment(stiffness, mass, rows, frequency, modes, cut, factorise(stiffness, "superlu")).frequency
    np.testing.assert_allclose(kept, every[every < cut], rtol=1e-9)


@pytest.mark.exact
def test_dependent_rows_are_left_out():
    rows = np.random.default_rng(0).standard_normal((5, 9))
    rows[3] = rows[0] - 2 * rows[1]
    rows[4] = 0.0
    chosen = independent_rows(sp.csr_matrix(rows))
    assert len(chosen) == 3 and 4 not in chosen
    assert np.linalg.matrix_rank(rows[chosen]) == 3


@pytest.mark.exact
def test_modal_damping_gives_every_elastic_mode_its_ratio(plate):
    node, stiffness, mass = plate
    body = craig_bampton(stiffness, mass, patch_rows(node), 20e3, "superlu")
    damping = modal_damping(body.mass, body.stiffness, 0.02)
    square, modes = eigh(body.stiffness, body.mass)
    modal = modes.T @ damping @ modes
    np.testing.assert_allclose(np.diag(modal)[6:], 0.04 * np.sqrt(square[6:]), rtol=1e-8)
    rigid = np.linalg.pinv(body.shape) @ rigid_motions(node)
    assert abs(rigid.T @ damping @ rigid).max() < 1e-3 * abs(modal).max()


def test_unrestrained_or_dependent_rows_are_refused(plate):
    node, stiffness, mass = plate
    with pytest.raises(ConfigError, match="restrain"):
        craig_bampton(stiffness, mass, patch_rows(node)[:2], 5e3, "superlu")
    rows = patch_rows(node)
    with pytest.raises(ConfigError, match="independent"):
        craig_bampton(stiffness, mass, sp.vstack((rows, rows[:1])), 5e3, "superlu")
    with pytest.raises(ConfigError, match="interface row"):
        craig_bampton(stiffness, mass, rows[:0], 5e3, "superlu")
