"""A load that acts through fluid."""

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.effects import named
from pipeline.physics.virtual_rig.response import Run, respond
from pipeline.physics.virtual_rig.roots import roots
from tests.effects.benches import RATE, evolved, let_go, sprung


def through_fluid(stiffness, time):
    return named("hydraulic_compliance").on(sprung(damping=4.0), "input_0", {"stiffness": stiffness, "time": time})


@pytest.mark.exact
def test_a_step_of_load_falls_and_recovers():
    """x'' + c x' + k x + z = F, z' = k_f x' - z / tau from rest: the exponential of its matrix."""
    bench, run = through_fluid(300.0, 0.2), Run("step", 2.0, RATE, {"input_0": 4.0})
    matrix = np.array([[0, 1, 0, 0], [-400, -4, -1, 4], [0, 300, -5, 0], [0, 0, 0, 0.0]])
    exact = evolved(matrix, [0, 0, 0, 1.0], run)[0]
    np.testing.assert_allclose(respond(bench, run)["x"], exact, atol=2e-6 * 0.01)


@pytest.mark.exact
def test_a_closed_line_is_a_spring_and_a_wide_one_is_nothing():
    closed, wide = (roots(through_fluid(300.0, time), let_go(0.01))[-1] for time in (1e6, 1e-9))
    assert closed == pytest.approx(-2 + 1j * np.sqrt(700 - 4), rel=1e-6)
    assert wide == pytest.approx(-2 + 1j * np.sqrt(400 - 4), rel=1e-6)


def test_a_load_does_not_rise_as_the_pad_moves_on():
    with pytest.raises(ConfigError, match="stiffness"):
        through_fluid(-1.0, 0.2)
