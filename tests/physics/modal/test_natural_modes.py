"""Modes against closed forms: bar, beam, free square plate, free annular disc; order, completeness, repeatability."""

import numpy as np
import pytest
import scipy

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.closed_form.axisymmetric_disc import section_frequencies
from pipeline.physics.fem.elasticity import assemble, isotropic
from pipeline.physics.fem.mesh import block, revolve
from pipeline.physics.modal import natural_modes
from pipeline.physics.modal.natural_modes import all_modes, lowest_modes, slopes
from pipeline.physics.numerics.sparse_solver import available, factorise

pytestmark = pytest.mark.exact
FASTEST = available()[0]


def body(mesh, young=2e11, poisson=0.3, density=7800.0):
    return assemble(mesh.node, mesh.element, mesh.kind, np.zeros(len(mesh.element), int), [density],
                    [isotropic(young, poisson)])


def beam(cells, thickness=0.01):
    return block(np.linspace(0, 1, cells + 1), np.linspace(0, 0.012, 2), np.linspace(0, thickness, 2))


def test_free_beam_bends_as_euler_bernoulli():
    """beta L = 4.73004, 7.85320; E-B for slenderness 100, deviation from shear about 1e-3."""
    stiffness, mass = body(beam(20), poisson=0.0)
    frequency, _ = lowest_modes(stiffness, mass, FASTEST, count=10)
    speed = np.sqrt(2e11 / 7800)
    expected = [b**2 * speed * h / np.sqrt(12) / (2 * np.pi) for b in (4.730041, 7.853205) for h in (0.01, 0.012)]
    assert frequency[:6] == pytest.approx(0, abs=0.1)
    assert frequency[6:] == pytest.approx(sorted(expected), rel=3e-3)


def test_longitudinal_bar_converges_with_order_four():
    """Fixed-free bar with nu = 0: f = c / 4L; quadratic elements err with h^4."""
    errors = []
    for cells in (1, 2, 4):
        mesh = beam(cells)
        stiffness, mass = body(mesh, poisson=0.0)
        along = 3 * np.flatnonzero(mesh.node[:, 0] > 1e-9)
        frequency, _ = lowest_modes(stiffness[along][:, along], mass[along][:, along], FASTEST, count=1)
        errors.append(frequency[0] / (np.sqrt(2e11 / 7800) / 4) - 1)
    assert np.log2(np.divide(errors[:-1], errors[1:])) == pytest.approx(4, abs=0.25)


def test_free_square_plate():
    """Thin plate, nu = 0.3: omega a^2 sqrt(rho h / D) = 13.468, 19.596, 24.270, h / a = 1/100.

    Leissa's (1969) 13.489, 19.789, 24.432 are the upper bounds of a short Ritz series.
    """
    mesh = block(np.linspace(0, 1, 9), np.linspace(0, 1, 9), np.array([0, 0.01]))
    frequency, _ = lowest_modes(*body(mesh), FASTEST, count=9)
    rigidity = 2e11 * 0.01**3 / (12 * (1 - 0.3**2))
    expected = np.array([13.468, 19.596, 24.270]) * np.sqrt(rigidity / (7800 * 0.01)) / (2 * np.pi)
    assert frequency[6:] == pytest.approx(expected, rel=4e-3)


def test_stepped_disc_against_the_section_model():
    """Every mode below 6 kHz, in number and within 1 %."""
    web, ring, height = np.linspace(0.035, 0.066, 4), np.linspace(0.066, 0.157, 7), np.array([-0.0034, 0.0008, 0.0034])
    radius = np.r_[web, ring[1:]]
    mask = np.ones((9, 2), bool)
    mask[:3, 1] = False
    around = np.linspace(0, 2 * np.pi, 49)
    mesh = revolve(radius, around, height, np.repeat(mask[:, None], 48, axis=1))
    stiffness, mass = body(mesh, 1.2e11, 0.27, 7200.0)
    reference = []
    for diameters in range(12):
        found = section_frequencies(radius, height, mask, 1.2e11, 0.27, 7200.0, diameters, 12)
        reference += [f for f in found if 1 < f < 6000 for _ in range(1 + (diameters > 0))]
    frequency, shape = lowest_modes(stiffness, mass, FASTEST, below=6000)
    assert shape.T @ (mass @ shape) == pytest.approx(np.eye(len(frequency)), abs=1e-8)
    assert frequency[6:] == pytest.approx(sorted(reference), rel=1e-2)


def test_solvers_agree():
    mesh = revolve(np.linspace(0.05, 0.15, 4), np.linspace(0, 2 * np.pi, 25), np.linspace(0, 0.01, 2))
    stiffness, mass = body(mesh)
    found = [lowest_modes(stiffness, mass, solver, below=3000)[0] for solver in available()]
    assert len(found[0]) > 10
    assert found[-1][6:] == pytest.approx(found[0][6:], rel=1e-8)


def test_modes_repeat_bit_for_bit_and_point_upwards():
    stiffness, mass = body(beam(20))
    first, second = (lowest_modes(stiffness, mass, FASTEST, count=12) for _ in range(2))
    assert all(np.array_equal(a, b) for a, b in zip(first, second, strict=True))
    assert (first[1][np.abs(first[1]).argmax(axis=0), np.arange(12)] > 0).all()


def test_no_modes_below_a_low_limit_of_a_held_body():
    stiffness, mass = body(beam(4))
    frequency, shape = lowest_modes(stiffness + 1e12 * mass, mass, FASTEST, below=10)
    assert frequency.shape == (0,) and shape.shape == (stiffness.shape[0], 0)


def test_count_and_limit_exclude_one_another():
    stiffness, mass = body(beam(2))
    with pytest.raises(ConfigError, match="either count or below"):
        lowest_modes(stiffness, mass, FASTEST)


def test_slopes_are_the_differences_of_frequencies():
    """Of a beam that becomes thicker, whose nodes move, and stiffer; modes of bending and of torsion."""
    first, stiffer = body(beam(10)), body(beam(10), young=2e11 * 1.01)
    frequency, shape = (part[..., 6:] for part in lowest_modes(*first, FASTEST, count=10))
    np.testing.assert_allclose(slopes(frequency, shape, first, stiffer), 0.005, rtol=1e-5)
    near, far = ([body(beam(10, 0.01 * (1 + side * h))) for side in (-1, 1)] for h in (1e-4, 1e-3))
    ends = [lowest_modes(*matrices, FASTEST, count=10)[0][6:] for matrices in far]
    np.testing.assert_allclose(slopes(frequency, shape, *near) / 2e-4, np.log(ends[1] / ends[0]) / 2e-3, atol=1e-3)


@pytest.mark.parametrize("off", [-1, 1])
def test_a_count_that_the_modes_contradict_is_refused(off, monkeypatch):
    """Modes below a limit are counted by the inertia and found by Lanczos' method: both must say the same."""
    mesh = revolve(np.linspace(0.05, 0.15, 4), np.linspace(0, 2 * np.pi, 25), np.linspace(0, 0.01, 2))
    stiffness, mass = body(mesh)

    def miscounted(matrix, solver):
        factor = factorise(matrix, solver)
        factor.negative += off
        return factor

    monkeypatch.setattr(natural_modes, "factorise", miscounted)
    with pytest.raises(ConvergenceError, match="lowest_modes: expected"):
        lowest_modes(stiffness, mass, FASTEST, below=3000)


def test_rigid_and_lowest_modes_are_as_good_far_below_the_limit():
    stiffness, mass = body(revolve(np.linspace(0.05, 0.15, 4), np.linspace(0, 2 * np.pi, 25), np.linspace(0, 0.01, 2)))
    near, far = (lowest_modes(stiffness, mass, FASTEST, below=below)[0] for below in (1500, 12000))
    assert far[:6].max() < 1e-3 * far[6] and far[6:len(near)] == pytest.approx(near[6:], rel=1e-9)


@pytest.mark.parametrize(("lifted", "share", "beneath", "above"),
                         [(0, 0.9, True, False), (2e5, 0.999, False, True), (0, 1.1, True, True)])
def test_modes_on_either_side_of_the_shift_or_on_one(lifted, share, beneath, above):
    """Of a free beam, lifted in squared frequency or not, below a share of its seventh mode: those of all modes."""
    stiffness, mass = body(beam(20))
    every = scipy.linalg.eigh(stiffness.toarray(), mass.toarray())[0] + lifted
    limit = share**2 * every[6]
    expected = np.maximum(every[every < limit], 0)
    amid = natural_modes._AMID * limit
    assert ((expected < amid).any(), (expected > amid).any()) == (beneath, above)
    frequency, shape = lowest_modes(stiffness + lifted * mass, mass, FASTEST, below=np.sqrt(limit) / (2 * np.pi))
    np.testing.assert_allclose((2 * np.pi * frequency)**2, expected, rtol=1e-7, atol=1e-7 * every[6])
    np.testing.assert_allclose(shape.T @ (mass @ shape), np.eye(len(expected)), atol=1e-8)


@pytest.mark.parametrize("spoilt", [0, 17])
@pytest.mark.parametrize("wanted", [{"count": 30}, {"below": 30000}])
def test_one_mode_in_many_that_misses_its_equation_is_told(wanted, spoilt, monkeypatch):
    """The check of a few sums of all modes loses none of them, and names which one it is."""
    stiffness, mass = body(beam(20))
    honest = natural_modes._lanczos

    def spoiled(*arguments):
        shifted, shape = honest(*arguments)
        shape[:, spoilt] += 1e-4 * shape[:, spoilt - 1]
        return shifted, shape

    assert len(lowest_modes(stiffness, mass, FASTEST, **wanted)[0]) > 20
    monkeypatch.setattr(natural_modes, "_lanczos", spoiled)
    with pytest.raises(ConvergenceError, match=f"in mode {spoilt + 1}"):
        lowest_modes(stiffness, mass, FASTEST, **wanted)


@pytest.mark.parametrize("coupled", [False, True])
def test_all_modes_of_diagonal_and_other_masses(coupled):
    random = np.random.default_rng(4)
    root, inertia = random.normal(size=(30, 30)), np.diag(1 + random.random(30))
    inertia[0, 1] = inertia[1, 0] = 0.3 * coupled
    square, modes = all_modes(root @ root.T, inertia)
    np.testing.assert_allclose(modes.T @ inertia @ modes, np.eye(30), rtol=0, atol=1e-12)
    np.testing.assert_allclose(root @ root.T @ modes, inertia @ modes * square, rtol=0, atol=1e-11)
    assert (np.diff(square) > 0).all()
