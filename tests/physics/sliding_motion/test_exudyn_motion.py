"""The sliding motion of exudyn beside that of the exponential steps."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract import ConvergenceError
from pipeline.physics.sliding_motion.exudyn_motion import run as exudyn_run
from tests.physics.sliding.test_equilibrium import random_model
from tests.physics.sliding_motion.small_motion import sliding


@pytest.fixture(scope="module")
def moving():
    return sliding(random_model())


@pytest.mark.golden
def test_exudyn_moves_alike(moving):
    """Runge-Kutta steps of exudyn on the same right-hand side: within 0.1 %."""
    _, system = moving
    start = 2.0 * system.reach.astype(complex)
    run = system.run(start, 5e-7, 2e-3, every=20)
    other = exudyn_run(system, start, 5e-7, 2e-3, every=20)
    np.testing.assert_allclose(other.time, run.time, rtol=1e-9)
    velocity = [(system.velocity_rows(np.eye(12)) @ each.state.T).real for each in (run, other)]
    assert abs(velocity[0] - velocity[1]).max() < 1e-3 * abs(velocity[0]).max()


@pytest.mark.golden
def test_exudyn_keeps_the_same_book_and_goes_on_where_it_ended(moving):
    """Energies and shares within 0.1 %; two windows are one motion."""
    _, system = moving
    start = 2.0 * system.reach.astype(complex)
    run = system.run(start, 5e-7, 2e-3, every=20, book=True)
    whole = exudyn_run(system, start, 5e-7, 2e-3, every=20, book=True)
    for name in ("work", "loss", "stored", "open", "stick"):
        one, other = getattr(run, name), getattr(whole, name)
        assert abs(one - other).max() <= max(1e-3 * abs(one).max(), 1e-9), name
    assert whole.imbalance < 2e-3
    first = exudyn_run(system, start, 5e-7, 1e-3)
    second = exudyn_run(system, first.end, 5e-7, 1e-3)
    assert abs(second.end[0] - whole.end[0]).max() < 1e-9 * abs(whole.end[0]).max()


def test_steps_too_long_for_runge_kutta_are_cut(moving):
    """Ten times as long as the fastest mode turns by one: eight steps each, on the same grid of times."""
    _, system = moving
    step, start = 9.99 / abs(system.modes.root).max(), 2.0 * system.reach.astype(complex)
    cut, fine = exudyn_run(system, start, step, 50 * step), exudyn_run(system, start, step / 8, 50 * step, every=8)
    np.testing.assert_allclose(cut.time, fine.time, rtol=1e-9)
    np.testing.assert_allclose(cut.state, fine.state, rtol=1e-9, atol=1e-9 * abs(fine.state).max())


def test_a_motion_without_bound_is_told(moving):
    _, system = moving
    growing = replace(system, modes=replace(system.modes, root=system.modes.root + 1e6))
    with pytest.raises(ConvergenceError, match="expected a finite motion"):
        exudyn_run(growing, system.reach.astype(complex), 1e-6, 5e-3)
