"""Friction corrections on a block of finite elements rubbed on its lower face."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.elasticity import assemble, isotropic
from pipeline.physics.fem.mesh import block
from pipeline.physics.modal.quadratic_eigenproblem import quadratic_roots
from pipeline.physics.sliding.model import Contacts, Joints, SlidingModel
from pipeline.physics.stability.friction_basis import friction_basis

FRICTION = 0.5


@pytest.fixture(scope="module")
def rubbed_block():
    """A block 60 x 20 x 30 mm, held at its top, on contact springs under every node of the lower face."""
    mesh = block(np.linspace(0, 0.06, 7), np.linspace(0, 0.02, 2), np.linspace(0, 0.03, 4), kind="hexahedron")
    node, kind, cells = mesh.node, mesh.kind, np.zeros(len(mesh.element), int)
    stiffness, mass = (a.toarray() for a in assemble(node, mesh.element, kind, cells, np.array([3000.0]),
                                                     isotropic(5e9, 0.3)[None]))
    lower, free = np.flatnonzero(node[:, 2] == 0), np.flatnonzero(np.repeat(node[:, 2] < 0.03, 3))
    normal, tangent, lateral = (np.eye(3 * len(node))[3 * lower + axis][:, free] for axis in (2, 0, 1))
    count, n, none = len(lower), len(free), np.empty((0, len(free)))
    contacts = Contacts(normal, tangent, lateral, node[lower], np.full(count, 1e-4), np.ones(count),
                        np.full(count, 100.0), np.full(count, 2e7), np.zeros(count))
    matrices = mass[np.ix_(free, free)], stiffness[np.ix_(free, free)]
    return SlidingModel(("block",), np.zeros(n, int), matrices[0], np.zeros((n, n)), np.zeros((n, n)), matrices[1],
                        np.zeros((n, n)), Joints((), none, np.empty(0), np.empty(0)), contacts, (), none, (), none, 1.0)


def lowest_growing(model):
    """The growing root of lowest frequency."""
    roots = quadratic_roots(*model.linearised(FRICTION, friction_damping=False))
    return next(s for s in roots if s.imag > 0 and s.real > 1e-6 * abs(s))


@pytest.mark.exact
def test_corrections_converge_the_growth_rate_where_real_modes_do_not(rubbed_block):
    direct = lowest_growing(rubbed_block)
    corrected, plain = [], []
    for below in (20e3, 40e3, 60e3):
        basis = friction_basis(rubbed_block, below, friction_damping=False, smallest=1e-6)
        corrected.append(lowest_growing(rubbed_block.projected(basis.shape)).real)
        plain.append(lowest_growing(rubbed_block.projected(basis.shape[:, :len(basis.frequency)])).real)
    error, without = (abs(np.array(growth) / direct.real - 1) for growth in (corrected, plain))
    assert error[0] < 1e-2 and (error[1:] < error[:-1] / 5).all()
    assert (without > 5 * error).all()


@pytest.mark.exact
def test_basis_is_mass_orthonormal_and_can_be_cut(rubbed_block):
    basis = friction_basis(rubbed_block, 40e3)
    np.testing.assert_allclose(basis.shape.T @ rubbed_block.mass @ basis.shape, np.eye(basis.shape.shape[1]), atol=1e-9)
    cut = friction_basis(rubbed_block, 40e3, smallest=1e-2)
    assert 0 < cut.corrections < basis.corrections
    np.testing.assert_allclose(cut.shape, basis.shape[:, :cut.shape.shape[1]], rtol=0,
                               atol=1e-13 * abs(basis.shape).max())


@pytest.mark.exact
def test_corrections_converge_the_damping_that_friction_induces(rubbed_block):
    """Loaded contacts whose springs are soft: friction at a slow speed damps by its change of direction."""
    contacts = replace(rubbed_block.contacts, stiffness=np.full(len(rubbed_block.contacts.area), 1e3))
    slow = replace(rubbed_block, contacts=contacts, speed=0.5)

    def first_decay(basis):
        roots = quadratic_roots(*slow.projected(basis).linearised(FRICTION))
        return next(s for s in roots if s.imag > 2 * np.pi * 1e3).real

    direct, basis = first_decay(np.eye(slow.size)), friction_basis(slow, 30e3)
    assert direct < -10.0
    assert first_decay(basis.shape) == pytest.approx(direct, rel=1e-2)
    assert abs(first_decay(basis.shape[:, :len(basis.frequency)]) - direct) > 5 * abs(first_decay(basis.shape) - direct)


@pytest.mark.exact
def test_corrections_for_contact_stiffness_serve_another_state_of_the_contacts(rubbed_block):
    """The basis of closed contacts where friction has opened every other one and doubled the rest."""
    contacts = rubbed_block.contacts
    moved = replace(rubbed_block, contacts=replace(contacts, stiffness=contacts.stiffness * np.resize([0, 2], 14)))
    direct, errors, half = lowest_growing(moved), [], np.resize([-1e7, 1e7], 14)
    for change in (0.0, 2e7, [half, 2e7 - half]):
        basis = friction_basis(rubbed_block, 40e3, friction_damping=False, smallest=1e-6, contact_stiffness=change)
        errors.append(abs(lowest_growing(moved.projected(basis.shape)) / direct - 1))
    assert max(errors[1:]) < errors[0] / 5 and max(errors[1:]) < 1e-3


@pytest.mark.exact
def test_corrections_for_left_vectors_take_the_roots_nearer(rubbed_block):
    """Roots are off by what the basis lacks of right vectors times what it lacks of left ones."""
    direct = lowest_growing(rubbed_block)
    for smallest in (1e-2, 3e-3):
        bases = [friction_basis(rubbed_block, 40e3, friction_damping=False, smallest=smallest, adjoint=adjoint).shape
                 for adjoint in (None, FRICTION)]
        errors = [abs(lowest_growing(rubbed_block.projected(basis)) / direct - 1) for basis in bases]
        assert errors[1] < errors[0] / 5


@pytest.mark.exact
def test_no_corrections_without_closed_contacts(rubbed_block):
    open_contacts = replace(rubbed_block.contacts, stiffness=np.zeros(len(rubbed_block.contacts.area)))
    opened = replace(rubbed_block, contacts=replace(open_contacts, preload=np.zeros(len(open_contacts.area))))
    assert friction_basis(opened, 40e3).corrections == 0


def test_refuses_a_limit_below_the_first_mode(rubbed_block):
    with pytest.raises(ConfigError, match="lowest at"):
        friction_basis(rubbed_block, 1.0)
