"""Bodies on springs: closed forms of two rigid bodies, and what a reduction to the springs leaves out."""

import numpy as np
import pytest
import scipy

from pipeline.physics.fem.elasticity import isotropic
from pipeline.physics.fem.mesh import block
from pipeline.physics.fem.supports import free_freedoms
from pipeline.physics.modal.coupled_bodies import CoupledBodies, reduced_body, side_by_side
from pipeline.physics.modal.model_updating import ModelModes, Test, update
from pipeline.physics.modal.natural_modes import lowest_modes
from pipeline.systems.solids import Solid

pytestmark = pytest.mark.exact

#: two rigid bars, 2 and 3 kg, that shift and tilt: on ground springs at both ends of the first, and tied to each other
MASS, HALF = np.diag([2.0, 2.0 * 0.04 / 3, 3.0, 3.0 * 0.04 / 3]), 0.2
ROWS = np.array([[1, HALF, 0, 0], [1, -HALF, 0, 0], [1, HALF, -1, -HALF], [1, -HALF, -1, HALF]])
STATED, SPREAD, GROUPS = np.array([4e4, 4e4, 9e4, 9e4]), 0.3, np.array([[1, 0], [1, 0], [0, 1], [0, 1.0]])
#: 1 where a spring belongs to a value
BARS = CoupledBodies(MASS, np.zeros((4, 4)), ROWS)


def bars(latent):
    """ModelModes of the bars with two values, the stiffness of the ground springs and of those between."""
    springs = STATED * np.exp(SPREAD * (GROUPS @ np.asarray(latent)))
    frequency, shape, share = BARS.modes(springs, 1e3)
    return ModelModes(frequency, SPREAD / 2 * share.T @ GROUPS, shape)


def closed_form(ground, between):
    """Frequencies (4,) Hz: shift and tilt part; each is a row of two masses, tilt with a lever of HALF."""
    both = []
    for first, second, lever in ((2.0, 3.0, 1.0), (2.0 / 3, 1.0, 1.0)):
        stiffness = 2 * np.array([[ground + between, -between], [-between, between]]) * lever
        inertia = np.diag([first, second])
        both.append(scipy.linalg.eigvalsh(stiffness, inertia))
    return np.sort(np.sqrt(np.concatenate(both)) / (2 * np.pi))


def test_two_rigid_bars_have_the_frequencies_of_their_closed_form():
    np.testing.assert_allclose(bars([0.5, -0.7]).frequency,
                               closed_form(4e4 * np.exp(0.15), 9e4 * np.exp(-0.21)), rtol=1e-9)


def test_slopes_are_those_of_differences_and_shares_are_the_whole_energy():
    step = 1e-5
    found = [(np.log(bars(step * u).frequency) - np.log(bars(-step * u).frequency)) / (2 * step) for u in np.eye(2)]
    np.testing.assert_allclose(bars([0, 0]).slope.T, found, atol=1e-9)
    np.testing.assert_allclose(BARS.modes(STATED, 1e3)[2].sum(axis=0), 1.0, rtol=1e-9)


def test_rigid_motions_and_modes_beyond_the_limit_are_left_out():
    frequency = BARS.modes(STATED * [0, 0, 1, 1], 1e3)[0]
    assert len(frequency) == 2
    assert len(BARS.modes(STATED, frequency.mean())[0]) < 4


def hammered(latent, error=0.0, random=None):
    """Test of the bars at both ends of each, whose frequencies are off by an ``error`` that nobody states."""
    modes = bars(latent)
    off = error * (random.standard_normal(4) if random else 0.0)
    return Test(modes.frequency * np.exp(off), np.full(4, 1e-7), (seen(modes.shown)).T)


def seen(shape):
    return np.array([[1, HALF, 0, 0], [1, -HALF, 0, 0], [0, 0, 1, HALF], [0, 0, 1, -HALF]]) @ shape


def test_stiffnesses_thirty_percent_off_come_back_exactly():
    found = update(bars, seen, hammered([0.9, -1.2]), 2)
    np.testing.assert_allclose(found.latent, [0.9, -1.2], atol=1e-3)
    assert found.pairing.clear.all()


def test_intervals_hold_the_truth_in_90_to_98_of_100_draws():
    """Values from their priors, errors of 0.5 % in the frequencies: 95 % intervals, 200 draws."""
    random, inside = np.random.default_rng(11), []
    for _ in range(200):
        true = random.standard_normal(2)
        found = update(bars, seen, hammered(true, 5e-3, random), 2)
        inside.append(abs(found.latent - true) < 2 * np.sqrt(np.diag(found.covariance)))
    assert 0.90 <= np.mean(inside) <= 0.98


def cantilevers():
    """A bar on a rigid wall and a free one beyond its end: Solids, rows of springs from the one to the other and from
    the free one to the ground, and their stiffness."""
    solids = []
    for first, held in ((0.0, True), (0.12, False)):
        mesh = block(first + np.linspace(0, 0.1, 6), np.linspace(0, 0.02, 3), np.linspace(0, 0.01, 2))
        fixed = np.flatnonzero(mesh.node[:, 0] < 1e-9) if held else np.empty(0, int)
        solids.append(Solid(mesh, np.zeros(len(mesh.element), int), ("steel",), np.array([7800.0]),
                            isotropic(2.1e11, 0.3)[None], 0.0, fixed))
    rows = [scipy.sparse.lil_matrix((24, 3 * len(s.mesh.node))) for s in solids]
    corners = [np.flatnonzero(abs(s.mesh.node[:, 0] - x) < 1e-9)[:4] for s, x in zip(solids, (0.1, 0.12), strict=True)]
    end = np.flatnonzero(abs(solids[1].mesh.node[:, 0] - 0.22) < 1e-9)[:4]
    for k in range(4):
        for axis in range(3):
            for body, node in enumerate((corners[0][k], corners[1][k])):
                rows[body][3 * k + axis, 3 * node + axis] = 1 - 2 * body
            rows[1][12 + 3 * k + axis, 3 * end[k] + axis] = 1
    return solids, [r.tocsr() for r in rows], np.repeat([3e7, 1e6], 12)


@pytest.mark.parametrize(("below", "error"), [(15e3, 6e-4), (30e3, 3e-5)])
def test_a_reduction_to_the_springs_keeps_the_modes_of_the_whole(below, error):
    """Frequencies to 10 kHz, whatever the springs are, by modes of the bodies to a half or twice above these; those to
    4 kHz are off by 4e-6 or less."""
    solids, rows, springs = cantilevers()
    coupled = side_by_side([reduced_body(s, r, below, "superlu") for s, r in zip(solids, rows, strict=True)], rows)
    matrices = [s.matrices() for s in solids]
    stiffness, mass = (scipy.sparse.block_diag([m[k] for m in matrices], "csr") for k in (0, 1))
    whole, size = scipy.sparse.hstack(rows, "csr"), 3 * len(solids[0].mesh.node)
    free = np.concatenate((free_freedoms(len(solids[0].mesh.node), solids[0].supported),
                           np.arange(size, stiffness.shape[0])))
    for factor in (1.0, 10.0):
        held = (stiffness + whole.T @ scipy.sparse.diags(factor * springs) @ whole)[free][:, free]
        frequency = lowest_modes(held, mass[free][:, free], "superlu", below=10e3)[0]
        found = coupled.modes(factor * springs, 10e3)[0]
        assert len(found) == len(frequency) > 5
        np.testing.assert_allclose(found, frequency, rtol=error)
        np.testing.assert_allclose(found[frequency < 4e3], frequency[frequency < 4e3], rtol=4e-6)


def test_a_held_body_without_springs_keeps_its_modes_alone():
    solid, rows = cantilevers()[0][0], scipy.sparse.csr_matrix((1, 3 * len(cantilevers()[0][0].mesh.node)))
    reduced = reduced_body(solid, rows, 10e3, "superlu")
    assert reduced.boundary == 0 and reduced.shape.shape[1] == len(reduced.frequency) > 0
    assert not reduced.shape[3 * solid.supported].any()
