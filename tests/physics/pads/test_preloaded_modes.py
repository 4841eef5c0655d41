"""Modal coordinates of the preloaded pads: the same system, the same roots with few coordinates."""

import numpy as np
import pytest

from pipeline.physics.modal.quadratic_eigenproblem import quadratic_roots
from pipeline.physics.pads.pad_system import force
from pipeline.physics.pads.preloaded_modes import preloaded_modes
from pipeline.physics.pads.sliding_pads import linearised, sliding_state, static_start
from pipeline.physics.pads.stability_map import on_average, sliding_roots
from tests.physics.small_pads import random_assembly


@pytest.mark.exact
def test_all_modes_are_the_same_system():
    system = random_assembly()
    start = static_start(system)
    modal, basis = preloaded_modes(system, start)
    rng = np.random.default_rng(2)
    moved, velocity = 1e-8 * rng.normal(size=start.size), 0.1 * rng.normal(size=start.size)
    np.testing.assert_allclose(basis.T @ system.mass @ basis, modal.mass, atol=1e-12)
    expected = basis.T @ force(system, 2e-3, start + basis @ moved, basis @ velocity)
    np.testing.assert_allclose(force(modal, 2e-3, moved, velocity), expected, atol=1e-9 * np.linalg.norm(expected))
    assert np.linalg.norm(force(modal, 0.0, 0 * moved, 0 * moved)) < 1e-9 * np.linalg.norm(system.load)


@pytest.mark.exact
def test_few_modes_and_corrections_have_unit_masses_and_do_not_couple_elastically():
    system = random_assembly(size=40, count=6)
    start = static_start(system)
    modal, basis = preloaded_modes(system, start, 3e3)
    np.testing.assert_allclose(basis.T @ system.mass @ basis, np.eye(basis.shape[1]), atol=1e-9)
    rest = np.zeros(basis.shape[1])
    stiffness = linearised(modal, rest, friction=False)[0]
    np.testing.assert_allclose(stiffness, np.diag(np.diag(stiffness)), atol=1e-7 * stiffness.max())
    assert basis.shape[1] < 40 and (np.diff(np.sqrt(np.diag(stiffness))) > -1e-6).all()


@pytest.mark.exact
def test_static_answers_to_contact_forces_are_exact_with_few_modes():
    system = random_assembly(size=40, count=6)
    start = static_start(system)
    modal, basis = preloaded_modes(system, start, 3e3)
    rest = np.zeros(basis.shape[1])
    whole = linearised(system, start, friction=False)[0]
    few = linearised(modal, rest, friction=False)[0]
    for rows, push in ((0, 3), (1, 5)):
        exact = np.linalg.solve(whole, system.contact.rows[rows, push])
        answer = basis @ np.linalg.solve(few, modal.contact.rows[rows, push])
        np.testing.assert_allclose(answer, exact, atol=1e-6 * np.abs(exact).max())


@pytest.mark.exact
def test_static_answers_make_the_growth_rates_converge():
    system = on_average(random_assembly(size=40, count=6))
    state = sliding_state(system)
    stiffness, damping = linearised(system, state)
    exact = quadratic_roots(system.mass, damping, stiffness)
    exact = exact[exact.imag > 0][:6]
    found = sliding_roots(system, 4e3)
    found = found[np.argsort(found.imag)][:6]
    np.testing.assert_allclose(found, exact, atol=5e-3 * np.abs(exact).max())
