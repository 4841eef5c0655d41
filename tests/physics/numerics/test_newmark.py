"""Newmark's rule on one oscillator: its amplitude, its frequency error and its damping, known in closed form."""

import numpy as np
import pytest

from pipeline.physics.numerics.compiled import njit
from pipeline.physics.numerics.newmark import beta_of, correct, corrected, predict, predicted

pytestmark = pytest.mark.exact
OMEGA = 2 * np.pi


def step_matrix(step, gamma):
    """(2, 2) over displacement and velocity of a'' = -OMEGA^2 q."""
    columns = []
    for q, v in np.eye(2):
        ahead, fast = predicted(q, v, -OMEGA**2 * q, step, gamma)
        rate = -OMEGA**2 * ahead / (1 + beta_of(gamma) * step**2 * OMEGA**2)
        columns.append(corrected(ahead, fast, rate, step, gamma))
    return np.array(columns).T


@pytest.mark.parametrize("step", [0.01, 0.1, 3.0])
def test_the_trapezoidal_rule_keeps_the_amplitude_and_shortens_the_angle_as_stated(step):
    """tan(angle / 2) = OMEGA step / 2."""
    root = np.linalg.eigvals(step_matrix(step, 0.5))
    assert abs(root) == pytest.approx(1, abs=1e-12)
    assert abs(np.angle(root[0])) == pytest.approx(2 * np.arctan(OMEGA * step / 2), rel=1e-9)


def test_a_larger_gamma_damps_stiff_modes_without_a_spurious_root():
    root = np.linalg.eigvals(step_matrix(1e3, 1.0))
    assert abs(root).max() == pytest.approx(1 / 3, rel=1e-3)     # (1 - 1/2) / (1 + 1/2)


def test_compiled_scalars_have_the_bits_of_arrays():
    @njit
    def both(q, v, a, h):
        ahead, fast = predict(q, v, a, h)
        return correct(ahead, fast, a, h)

    ahead, fast = predicted(0.3, -1.7, 2.9, 1e-3)
    assert both(0.3, -1.7, 2.9, 1e-3) == corrected(ahead, fast, 2.9, 1e-3)
