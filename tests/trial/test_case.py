"""Cases: the same seed gives the same case, hidden physics changes it by what is wanted, controls hide nothing."""

import numpy as np

from pipeline.trial.case import CHANGE, LEVELS, SAMPLES, made
from pipeline.trial.rig import drawn


def test_a_control_is_repeatable_and_noisy_by_its_level():
    first, again = made(5, masses=1, level=0.1), made(5, masses=1, level=0.1)
    assert all(np.array_equal(a, b) for (_, a), (_, b) in zip(first.runs, again.runs, strict=True))
    quiet = made(5, masses=1, level=1e-6)
    left = np.array([a - b for (_, a), (_, b) in zip(first.runs, quiet.runs, strict=True)])
    assert first.hidden == first.place == "" and first.change == 0 and len(first.runs) == len(LEVELS)
    np.testing.assert_allclose(np.sqrt(np.mean(left**2)), first.noise[0], rtol=0.05)


def test_hidden_physics_changes_one_run_as_wanted():
    hidden, bare = (made(7, name, level=1e-6, masses=1) for name in ("cubic_stiffness", ""))
    assert hidden.place == "link_0" and hidden.truth == bare.truth == drawn(np.random.default_rng(7), 1)
    (_, with_it), (_, without) = hidden.runs[0], bare.runs[0]
    change = np.sqrt(np.mean((with_it - without) ** 2) / np.mean(without**2))
    assert CHANGE[0] / 1.4 < change < 1.4 * CHANGE[1] and with_it.shape == (1, SAMPLES)


def test_a_change_can_be_asked_for():
    (first, _), (second, _) = ((made(7, "cubic_stiffness", level=1e-6, masses=1, change=c), c) for c in (0.1, 0.3))
    assert abs(np.log(first.change / 0.1)) < 0.3 and abs(np.log(second.change / 0.3)) < 0.3


def test_a_law_that_would_be_a_wrong_value_has_that_value_exact():
    found = made(9, "joint_damping", masses=1)
    assert found.exact == ("damping_0",) and found.belief.links[0].damping == found.truth.links[0].damping
    assert found.belief.links[0].stiffness != found.truth.links[0].stiffness
