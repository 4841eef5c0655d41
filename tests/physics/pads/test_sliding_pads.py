"""Pads at rest and in steady sliding: closed forms, SciPy's equilibria of the compiled forces, their tangent."""

import numpy as np
import pytest
import scipy

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.pads.pad_system import force, pad_elements, tangent
from pipeline.physics.pads.patch_contact import contact_state
from pipeline.physics.pads.sliding_pads import linearised, sliding_state, static_start
from pipeline.physics.time_stepping.elements import Dry, Element, Polynomial, Power
from tests.physics.small_pads import block_on_belt, flutter, random_assembly


def burdened(speed=9.0, dry=2.0):
    """A random assembly with friction in full at ``speed`` rad/s, an open contact, waves of the disc, a hardening
    spring, a damper, and a joint with ``dry`` friction in N."""
    system, rng = random_assembly(), np.random.default_rng(8)
    contact = system.contact._replace(ramp=0.0, disc_speed=speed, waviness=np.array([[1.0, 2e-8, 3.0, 0.0, 0.4, 0.0]]))
    laws = (Polynomial(linear=2e6, cubic=1e20), Dry(1e6, dry, dry), Power(30.0))
    elements = pad_elements([Element(f"joint {k}", rng.normal(size=12), law) for k, law in enumerate(laws)], 12)
    return system._replace(contact=contact, elements=elements, load=system.load + 300 * contact.rows[0, 0])


def balanced(system, start):
    """Displacement (n,) at which the compiled forces vanish, by SciPy's hybrid method from ``start`` (n,)."""
    scale, rest = np.linalg.norm(system.load), np.zeros(len(start))
    solution = scipy.optimize.root(lambda q: force(system, 0.0, 1e-8 * q, rest) / scale, 1e8 * start, tol=1e-13)
    assert abs(solution.fun).max() < 1e-10
    return 1e-8 * solution.x


@pytest.mark.exact
@pytest.mark.parametrize("solve", [static_start, sliding_state])
def test_equilibria_are_those_of_the_compiled_forces(solve):
    """Dry friction of joints bears nothing there."""
    acting, still = burdened(), burdened(dry=0.0)
    place = solve(acting)
    if solve is static_start:
        still = still._replace(contact=still.contact._replace(ramp=1e-3))     # no friction yet at time 0
    np.testing.assert_allclose(place, balanced(still, 0.9 * place), atol=1e-9 * abs(place).max())
    normal = contact_state(still.contact, 0.0, place, 0 * place).normal
    assert 0 < np.sum(normal == 0) < 8
    assert abs(place - solve(acting._replace(elements=pad_elements((), 12)))).max() > 0.01 * abs(place).max()


@pytest.mark.exact
@pytest.mark.parametrize("speed", [9.0, -9.0, 3e-3], ids=["forwards", "backwards", "creeping"])
def test_the_linearisation_is_the_tangent_of_the_compiled_forces(speed):
    system = burdened(speed)
    place = sliding_state(system)
    pairs = zip(linearised(system, place), tangent(system, 0.0, place, 0 * place), strict=True)
    for ours, compiled in pairs:
        np.testing.assert_allclose(ours, compiled, atol=1e-12 * abs(compiled).max())


@pytest.mark.exact
def test_static_start_of_a_block_is_load_over_stiffness_without_friction():
    start = static_start(block_on_belt(load=50.0, stiffness=1e8))
    np.testing.assert_allclose(start, [0, -50e-8], rtol=1e-12, atol=1e-20)


@pytest.mark.exact
def test_steady_sliding_of_a_block_carries_friction_times_load():
    system = block_on_belt(load=50.0, friction=0.3, spring=1e5)
    state = sliding_state(system)
    assert state[0] == pytest.approx(0.3 * 50 / 1e5, rel=1e-12)


@pytest.mark.exact
def test_static_start_of_a_curved_law_is_an_equilibrium_with_open_contacts():
    system = random_assembly(count=8)
    system = system._replace(load=system.load + 300 * system.contact.rows[0, 0])
    start = static_start(system)
    normal = contact_state(system.contact, 0.0, start, 0 * start).normal
    assert 0 < np.sum(normal == 0) < 8
    np.testing.assert_allclose(system.stiffness @ start, system.load + normal @ system.contact.rows[0],
                               atol=1e-11 * np.linalg.norm(system.load))


@pytest.mark.exact
def test_linearised_stiffness_is_the_closed_form_of_flutter():
    k11, k22, k12, k_friction, mu = 9e6, 1.1e7, 5e5, 4e6, 0.45
    system = flutter(k11, k22, k12, k_friction, mu)
    stiffness, damping = linearised(system, sliding_state(system))
    np.testing.assert_allclose(stiffness, [[k11, k12 - mu * k_friction], [k12, k22]], rtol=1e-9)
    np.testing.assert_allclose(damping, 0, atol=1e-12)


def test_an_assembly_that_nothing_holds_does_not_pass():
    loose = block_on_belt()
    loose = loose._replace(load=np.array([0.0, 50.0]))
    with pytest.raises(ConvergenceError, match="static start"):
        static_start(loose)
