"""Hexahedra, tetrahedra, wedges: patch test, null space, rotation matrices against closed forms, clear errors."""

import numpy as np
import pytest
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.elasticity import (
    assemble,
    centrifugal_load,
    geometric_stiffness,
    gyroscopic,
    isotropic,
    orthotropic,
)
from pipeline.physics.fem.mesh import block, revolve
from pipeline.physics.fem.supports import free_modes
from pipeline.physics.numerics.sparse_solver import available, factorise
from tests.physics.fem.mixed_meshes import cut

pytestmark = pytest.mark.exact
LATTICES = ("hexahedron", "hexahedron20", "hexahedron27")
KINDS = (*LATTICES, "tetra10", "wedge15", "mixed")
MATERIAL = orthotropic((6e9, 5e9, 1.5e9), (0.2, 0.22, 0.25), (1.2e9, 1.1e9, 2.5e9))


def box(*lines, kind):
    return block(*lines, kind=kind) if kind in LATTICES else cut(block(*lines, kind="hexahedron27"), kind)


def skewed_block(kind):
    """Inner nodes out of place: of tetrahedra and linear hexahedra each by itself; edges of wedges stay straight."""
    mesh = box(np.linspace(0, 1, 3), np.linspace(0, 0.8, 3), np.linspace(0, 0.5, 3), kind=kind)
    x, y, z = mesh.node.T
    warp = 0.06 * np.sin(np.pi * x) * np.sin(np.pi * y / 0.8) * np.sin(np.pi * z / 0.5)
    if kind == "wedge15":
        warp = 0.06 * (1 - abs(2 * x - 1)) * (1 - abs(y / 0.4 - 1))
        warp = warp[:, None] * (0, 0, 1) * (1 - abs(z / 0.25 - 1))[:, None]
        return type(mesh)(mesh.node + warp, mesh.element, kind, mesh.cell)
    return type(mesh)(mesh.node + warp[:, None] * (kind in ("hexahedron", "tetra10")), mesh.element, kind, mesh.cell)


def matrices(mesh, density=2500.0, material=MATERIAL):
    return assemble(mesh.node, mesh.element, mesh.kind, np.zeros(len(mesh.element), int), [density], [material])


@pytest.mark.parametrize("kind", KINDS)
def test_patch_of_constant_strain(kind):
    mesh = skewed_block(kind)
    stiffness, _ = matrices(mesh)
    strain = np.array([[1.0, 0.3, -0.2], [0.3, -0.5, 0.4], [-0.2, 0.4, 0.8]]) * 1e-3
    exact = (mesh.node @ strain).ravel()
    inner = np.all((mesh.node > 1e-9) & (mesh.node < np.array([1, 0.8, 0.5]) - 1e-9), axis=1).repeat(3)
    assert np.abs((stiffness @ exact)[inner]).max() < 1e-9 * np.abs(stiffness @ exact).max()
    voigt = strain[[0, 1, 2, 1, 0, 0], [0, 1, 2, 2, 2, 1]] * (1, 1, 1, 2, 2, 2)
    assert exact @ (stiffness @ exact) == pytest.approx(0.4 * voigt @ MATERIAL @ voigt, rel=1e-9)


@pytest.mark.parametrize("kind", KINDS)
def test_only_six_motions_are_free_of_energy(kind):
    mesh = box(np.linspace(0, 2, 3), np.array([0, 1.0]), np.array([0, 0.7]), kind=kind)
    stiffness, mass = matrices(mesh)
    value = np.linalg.eigvalsh(stiffness.toarray())
    assert value[5] < 1e-9 * value[-1] < 1e-5 * value[-1] < value[6]
    assert mass.sum() == pytest.approx(3 * 2500 * 1.4)
    assert np.linalg.eigvalsh(mass.toarray())[0] > 0


@pytest.mark.parametrize("kind", ["tetra10", "wedge15", "mixed"])
def test_mass_of_a_curved_body(kind):
    """A quarter of a ring, its arcs parabolas: the volume converges to pi / 4 (R^2 - r^2) h with the fourth power."""
    error = []
    for cells in (2, 4):
        lines = np.array([0.8, 1.0]), np.linspace(0, np.pi / 2, cells + 1), np.array([0, 0.3])
        ring = revolve(*lines, kind="hexahedron27")
        _, mass = matrices(cut(ring, kind), 1.0)
        error.append(abs(mass.sum() / 3 / (np.pi / 4 * 0.36 * 0.3) - 1))
    assert error[1] < 1e-4 and np.log2(error[0] / error[1]) == pytest.approx(4, abs=0.3)


@pytest.mark.parametrize("kind", ["tetra10", "wedge15"])
def test_frequencies_of_a_bar_converge_with_the_fourth_power(kind):
    """Longitudinal waves of a bar without contraction, f = k c / 2 L, free at both ends."""
    error = []
    for cells in (2, 4):
        mesh = box(np.linspace(0, 1, cells + 1), np.array([0, 0.1]), np.array([0, 0.1]), kind=kind)
        stiffness, mass = (a.toarray()[::3, ::3] for a in matrices(mesh, 1.0, isotropic(1.0, 0.0)))
        frequency = np.sqrt(np.abs(scipy.linalg.eigvalsh(stiffness, mass)[:2])) / (2 * np.pi)
        error.append(frequency[1] / 0.5 - 1)
    assert 0 < error[1] < 2e-3 and np.log2(error[0] / error[1]) == pytest.approx(4, abs=0.4)


@pytest.mark.parametrize("kind", ["tetra10", "wedge15", "hexahedron20"])
def test_bending_of_a_slender_beam(kind):
    """First bending frequency of a free beam of Euler and Bernoulli; shear and rotary inertia take less than 1 %."""
    mesh = box(np.linspace(0, 1, 9), np.array([-0.02, 0.02]), np.array([-0.02, 0.02]), kind=kind)
    pair = matrices(mesh, 1000.0, isotropic(1e9, 0.0))
    frequency, _ = free_modes(*pair, available()[0], 60.0, "beam")
    exact = 4.7300407**2 / (2 * np.pi) * np.sqrt(1e9 * 0.04**2 / 12 / 1000.0)
    assert frequency[0] == pytest.approx(exact, rel=0.01)


def test_orthotropic_is_isotropic_when_equal_and_refuses_negative_energy():
    young, nu = 2e11, 0.3
    lame = young * nu / ((1 + nu) * (1 - 2 * nu))
    shear = young / (2 * (1 + nu))
    expected = np.diag([2 * shear] * 3 + [shear] * 3)
    expected[:3, :3] += lame
    assert np.allclose(isotropic(young, nu), expected)
    with pytest.raises(ConfigError, match="strain energy"):
        orthotropic((1e9, 1e9, 9e9), (0.9, 0.9, 0.9), (1e9,) * 3)


def rod(cells=6):
    return block(np.linspace(0, 1, cells + 1), np.array([-0.01, 0.01]), np.array([-0.01, 0.01]), kind="hexahedron27")


def test_centrifugal_stretch_and_stiffening_of_a_rod():
    """u(L) = rho L^3 / 3E; a rigid flap u_z = x meets the work of its stress, its moment of inertia per speed^2."""
    mesh, density = rod(), 7000.0
    material, cells = isotropic(1e11, 0.0), np.zeros(len(mesh.element), int)
    stiffness, _ = matrices(mesh, density, material)
    held = np.zeros(mesh.node.shape, bool)
    held[np.isclose(mesh.node[:, 0], 0)] = True
    free = np.flatnonzero(~held.ravel())
    load = centrifugal_load(mesh.node, mesh.element, mesh.kind, cells, [density]).reshape(-1, 3) * (1, 0, 1)
    moved = np.zeros(mesh.node.size)
    moved[free] = factorise(stiffness[free][:, free], available()[0]).solve(load.ravel()[free])
    tip = np.isclose(mesh.node[:, 0], 1)
    assert moved.reshape(-1, 3)[tip, 0] == pytest.approx(density / 3e11, rel=1e-3)
    stress = geometric_stiffness(mesh.node, mesh.element, mesh.kind, cells, [material], moved)
    flap = np.zeros_like(mesh.node)
    flap[:, 2] = mesh.node[:, 0]
    area = 0.02**2
    assert flap.ravel() @ (stress @ flap.ravel()) == pytest.approx(density * area / 3, rel=1e-4)


def test_gyroscopic_matrices_of_a_wave_around_a_ring():
    """For u_z = cos and sin of n theta: G = 2n and H = n^2 times the modal mass; rigid motions feel neither."""
    mesh = revolve(np.array([0.8, 1.0]), np.linspace(0, 2 * np.pi, 49), np.array([0, 0.1]), kind="hexahedron27")
    cells, n = np.zeros(len(mesh.element), int), 3
    whirl, convective = gyroscopic(mesh.node, mesh.element, mesh.kind, cells, [7000.0])
    _, mass = matrices(mesh, 7000.0)
    angle = np.arctan2(mesh.node[:, 1], mesh.node[:, 0])
    wave = np.zeros((2, *mesh.node.shape))
    wave[0, :, 2], wave[1, :, 2] = np.cos(n * angle), np.sin(n * angle)
    c, s = wave.reshape(2, -1)
    modal = c @ (mass @ c)
    assert c @ (whirl @ s) == pytest.approx(2 * n * modal, rel=1e-3)
    assert abs(c @ (whirl @ c)) < 1e-9 * modal
    assert abs(whirl + whirl.T).max() < 1e-9 * abs(whirl).max()
    assert c @ (convective @ c) == pytest.approx(n**2 * modal, rel=1e-3)
    shift = np.tile([1.0, 0, 0], len(mesh.node))
    assert shift @ (convective @ shift) < 1e-12 * modal
    assert np.abs(whirl @ shift).max() < 1e-6 * abs(whirl).max()


def test_inverted_and_unknown_elements_are_refused():
    mesh = rod(1)
    turned = mesh.element[:, [4, 5, 6, 7, 0, 1, 2, 3, *range(12, 16), *range(8, 12), *range(16, 24), 25, 24, 26]]
    with pytest.raises(ConfigError, match="Jacobian"):
        assemble(mesh.node, turned, mesh.kind, np.zeros(1, int), [1.0], [isotropic(1, 0.3)])
    with pytest.raises(ConfigError, match="hexahedron20"):
        assemble(mesh.node, mesh.element, "tetra", np.zeros(1, int), [1.0], [isotropic(1, 0.3)])
