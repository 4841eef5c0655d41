"""Sliding on hard contacts: two-mode flutter in closed form, the limit of stiff penalties, jamming, criticality."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.closed_form.two_mode_flutter import onset_friction, roots_over_friction
from pipeline.physics.modal.quadratic_eigenproblem import quadratic_roots
from pipeline.physics.sliding.model import FrictionState
from pipeline.physics.stability.constrained_modes import allowed_motions, critical_friction, growth, hard_sliding
from tests.physics.lumps import lumps

#: two motions in the plane of the contact, and the normal one, which the contact forbids
SPRINGS = np.array([[100.0, 12.0, 0.0], [12.0, 130.0, 20.0], [0.0, 20.0, 500.0]])


def plane(speed=1.0, normal=(0, 0, 1.0), damping=0.0):
    model = lumps(np.ones(3), normal=[normal], tangent=[[1.0, 0, 0]], speed=speed)
    return replace(model, stiffness=SPRINGS, damping=damping * np.eye(3))


def roots(sliding):
    return quadratic_roots(np.eye(len(sliding.stiffness)), sliding.damping, sliding.stiffness)


def by_size(values):
    return values[np.lexsort((values.real.round(9), values.imag.round(9)))]


@pytest.mark.exact
@pytest.mark.parametrize("speed", [1.0, -1.0])
@pytest.mark.parametrize("friction", [0.0, 0.5, 1.5, 3.0, 5.0])
def test_two_mode_flutter(friction, speed):
    """Eliminating the normal force leaves k12 - mu k_zy in the row of the friction force."""
    found = roots(hard_sliding(plane(speed), friction))
    wanted = roots_over_friction(100.0, 130.0, 12.0, 20.0 * speed, friction)
    np.testing.assert_allclose(by_size(found), by_size(wanted), atol=2e-6)


@pytest.mark.exact
def test_critical_friction_by_bisection():
    wanted = onset_friction(100.0, 130.0, 12.0, 20.0)
    found = critical_friction(plane(), np.sqrt(115.0) / (2 * np.pi), 0.1, 5.0, width=0.3, tolerance=1e-8)
    assert found == pytest.approx(wanted, abs=1e-5)
    with pytest.raises(ConfigError, match="unstable"):
        critical_friction(plane(), np.sqrt(115.0) / (2 * np.pi), 0.1, 0.2, width=0.3)


@pytest.mark.exact
def test_mass_proportional_damping_moves_all_roots_to_the_left():
    """C = a M: s = -a / 2 +- sqrt(a^2 / 4 + s0^2) with the undamped s0."""
    drag = 3.0
    undamped = roots(hard_sliding(plane(), 4.0))
    damped = roots(hard_sliding(plane(damping=drag), 4.0))
    wanted = -drag / 2 + np.sqrt(drag**2 / 4 + undamped[undamped.imag > 0]**2 + 0j)
    for root in wanted:
        assert np.min(abs(damped - root)) < 1e-6
    assert growth(hard_sliding(plane(damping=drag), 4.0), 1.7, 0.3) == pytest.approx(wanted.real.max(), abs=1e-6)


@pytest.mark.exact
def test_stiff_penalty_has_hard_contact_as_its_limit():
    """Roots with a contact spring k approach those of the hard contact as 1 / k."""
    random = np.random.default_rng(2)
    base = random.standard_normal((6, 6))
    model = replace(lumps(1 + random.random(6), normal=random.standard_normal((2, 6)),
                          tangent=random.standard_normal((2, 6)), speed=-1.0),
                    stiffness=100 * (base @ base.T), damping=0.1 * (base @ base.T))
    hard = roots(hard_sliding(model, 0.3))
    errors = []
    for spring in (1e7, 1e8):
        stiff = replace(model, contacts=replace(model.contacts, stiffness=np.full(2, spring)))
        soft = quadratic_roots(*stiff.linearised(0.3, friction_damping=False))
        errors.append(max(np.min(abs(soft - root)) for root in hard))
    assert errors[0] / errors[1] == pytest.approx(10, rel=0.05) and errors[1] < 1e-3


@pytest.mark.exact
def test_allowed_motions_keep_the_contact_and_are_orthonormal():
    model = plane(normal=(0.3, 0.1, 1.0))
    basis = allowed_motions(model)
    np.testing.assert_allclose(model.contacts.normal @ basis, 0, atol=1e-12)
    np.testing.assert_allclose(basis.T @ model.mass @ basis, np.eye(2), atol=1e-12)
    stiffness = hard_sliding(model, 0.0, basis).stiffness
    np.testing.assert_allclose(stiffness, np.diag(np.diag(stiffness)), atol=1e-9)


@pytest.mark.exact
def test_friction_that_falls_with_speed_pushes():
    """N0 dmu/dslip t t^T joins the damping of the allowed motions."""
    model = plane()
    loaded = replace(model, contacts=replace(model.contacts, preload=np.array([7.0])))
    falling = hard_sliding(loaded, FrictionState(0.0, 0.0, -0.2), np.eye(3)[:, :2], friction_damping=False)
    np.testing.assert_allclose(falling.damping, [[-1.4, 0], [0, 0]], atol=1e-12)


def test_a_contact_that_jams_is_refused():
    leaning = plane(normal=(-0.5, 0, 1.0))
    hard_sliding(leaning, 2.4)
    with pytest.raises(ConfigError, match="jams"):
        hard_sliding(leaning, 2.6)
