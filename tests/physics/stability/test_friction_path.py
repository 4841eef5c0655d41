"""Paths over friction: flutter of two modes in closed form, veering, falling friction."""

import numpy as np
import pytest
import scipy

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.closed_form.two_mode_flutter import onset_friction, roots_over_friction
from pipeline.physics.modal.quadratic_eigenproblem import follow_roots
from pipeline.physics.stability.friction_path import FrictionSystem, enriched, first_of_each, friction_path
from pipeline.physics.stability.linearisation import Settling

pytestmark = pytest.mark.exact

K11, K22, K12, K_FRICTION = 1.00e6, 1.10e6, 4e4, 5e5
OPERATING = 0.3


def flutter(damping=0.0, bystanders=()):
    """FrictionSystem of the two modes up to the friction OPERATING, and of masses that friction leaves alone."""
    n = 2 + len(bystanders)
    still, coupled = np.diag([K11, K22, *bystanders]), np.zeros((n, n))
    still[0, 1] = still[1, 0] = K12
    coupled[0, 1] = -OPERATING * K_FRICTION
    drag = damping * np.eye(n)
    return FrictionSystem(((np.eye(n), drag, still), None), ((np.eye(n), drag, still + coupled), None))


def unstable(system, at=1.0):
    """(root, vector) with the largest growth rate at a share of the friction."""
    (mass, damping, stiffness), _ = system(at)
    n = len(mass)
    roots, vectors = np.linalg.eig(np.block([[np.zeros((n, n)), np.eye(n)], [-stiffness, -damping]]))
    index = np.argmax(np.where(roots.imag > 0, roots.real, -np.inf))
    return roots[index], vectors[:n, index]


@pytest.mark.parametrize("damping", [0.0, 20.0])
@pytest.mark.parametrize("bystanders", [(), (1.01e6, 1.05e6, 1.2e6)])
def test_flutter_of_two_modes_has_its_critical_friction_and_its_pair(damping, bystanders):
    """Masses whose frequencies lie nearer, but which friction does not couple, are not what the mode meets."""
    system = flutter(damping, bystanders)
    root, vector = unstable(system)
    path = friction_path(system, root, vector)
    assert path.critical * OPERATING == pytest.approx(onset_friction(K11, K22, K12, K_FRICTION, damping), rel=2e-4)
    assert path.root[-1] == pytest.approx(root, rel=1e-9) and path.share[0] == 0 and path.share[-1] == 1
    still = np.sort(roots_over_friction(K11, K22, K12, K_FRICTION, 0.0).imag)[2:]
    pair = np.sort([path.root[0].imag, path.meeting[0].imag])
    np.testing.assert_allclose(pair, np.sqrt(still**2 - damping**2 / 4), rtol=1e-9)
    assert path.alike > 0.98
    assert not path.start[2:].any(where=abs(path.start[2:]) > 1e-9) and np.linalg.matrix_rank(path.start[:2]) == 2


def test_roots_along_the_path_are_those_of_the_closed_form():
    system = flutter()
    path = friction_path(system, *unstable(system))
    for share, root in zip(path.share, path.root, strict=True):
        exact = roots_over_friction(K11, K22, K12, K_FRICTION, share * OPERATING)
        assert abs(exact - root).min() < 1e-4 * abs(root)      # next to the coalescence, a root of rounding


def veering(coupling):
    """Two modes whose squared frequencies would cross at a share of 0.5 and veer by ``coupling`` instead; damped."""
    ends = [np.array([[1e6 - 2e5 * (share - 0.5), coupling], [coupling, 1e6 + 2e5 * (share - 0.5)]])
            for share in (0.0, 1.0)]
    drag = np.diag([-1.0, -1.0])
    return FrictionSystem(*(((np.eye(2), drag, end), None) for end in ends))


def test_a_veering_is_followed_where_distances_in_the_complex_plane_jump():
    """The upper of two frequencies stays the upper one; straight on, the next root is that of the other."""
    coupling, shares = 3e3, np.linspace(1, 0, 17)
    system = veering(coupling)
    exact = {share: 1j * np.sqrt(np.linalg.eigvalsh(system(share)[0][2]) - 0.25) + 0.5 for share in shares}
    by_distance = follow_roots(np.array([exact[share] for share in shares]))
    assert by_distance[-1, 1] == exact[0.0][0]                 # has jumped to the lower one
    vector = np.linalg.eigh(system(1.0)[0][2])[1][:, 1]
    path = friction_path(system, exact[1.0][1], vector)
    upper = [np.sqrt(np.linalg.eigvalsh(system(share)[0][2])[1] - 0.25) for share in path.share]
    np.testing.assert_allclose(path.root.imag, upper, rtol=1e-12)


def test_a_mode_that_falling_friction_feeds_meets_no_other():
    """m s^2 + (c - share g) s + k = 0: unstable from share c / g on."""
    drag, fall = np.diag([3.0, 4.0]), np.diag([8.0, 1.0])
    stiffness = np.diag([1e6, 1.05e6])
    system = FrictionSystem(((np.eye(2), drag, stiffness), None), ((np.eye(2), drag - fall, stiffness), None))
    path = friction_path(system, *unstable(system))
    assert path.critical == pytest.approx(3 / 8, abs=3e-4)     # growth counts from 1e-6 of the frequency on
    assert path.alike < 1e-12
    alone = FrictionSystem(*(((np.eye(1), end[:1, :1], stiffness[:1, :1]), None) for end in (drag, drag - fall)))
    path = friction_path(alone, *unstable(alone))
    assert path.alike == 0 and not path.meeting.any() and not path.start[:, 1].any()


def test_a_mode_that_grows_without_friction_is_critical_from_none_on():
    system = FrictionSystem(*(((np.eye(1), -np.eye(1) * rate, np.eye(1) * 1e4), None) for rate in (1.0, 2.0)))
    assert friction_path(system, *unstable(system)).critical == 0


def test_loss_factors_add_at_every_share():
    system = flutter().with_losses(0 * np.eye(2), 0.01j * np.diag([K11, K22]))
    (_, _, stiffness), _ = system(0.25)
    assert stiffness[0, 0] == pytest.approx(K11 * (1 + 0.01j))
    assert stiffness[0, 1] == pytest.approx(K12 - 0.25 * OPERATING * K_FRICTION)


def test_states_that_settle_scale_with_the_friction():
    still = Settling(np.array([[0.0]]), np.array([[1.0]]), np.array([[2.0]]), np.array([3.0]))
    full = Settling(np.array([[8.0]]), still.by_place, still.by_speed, still.decay)
    matrices = np.eye(1), np.eye(1), np.eye(1)
    beside = FrictionSystem((matrices, still), (matrices, full))(0.25)[1]
    assert beside.push == 2.0 and beside.decay == 3.0


def test_a_root_that_the_system_has_not_is_refused():
    system = flutter()
    root, vector = unstable(system)
    with pytest.raises(ConvergenceError, match="path over friction"):
        friction_path(system, root * 1.001, vector)


def test_an_enriched_basis_holds_the_shapes_and_stays_orthonormal():
    random = np.random.default_rng(1)
    half = random.standard_normal((9, 9))
    mass = half @ half.T + np.eye(9)
    basis = scipy.linalg.eigh(np.diag(np.arange(1.0, 10)), mass)[1][:, :4]
    shapes = random.standard_normal((9, 2)) + 1j * random.standard_normal((9, 2))
    shapes[:, 1] = basis[:, 0]                                  # nothing new
    whole = enriched(basis, mass, shapes)
    assert whole.shape == (9, 6)
    np.testing.assert_allclose(whole.T @ mass @ whole, np.eye(6), atol=1e-12)
    np.testing.assert_allclose(whole @ (whole.T @ mass @ shapes), shapes, atol=1e-10)


def test_frequencies_within_half_a_percent_are_one_mode():
    roots = np.array([9 + 1000j, 8 + 1004j, 7 + 1007j, 6 + 996j, 5 + 1009j])
    assert first_of_each(roots).tolist() == [0, 0, 2, 0, 2]
    assert first_of_each(np.empty(0, complex)).shape == (0,)
