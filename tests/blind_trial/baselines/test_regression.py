"""Equations in weak form: a motion that is known gives back the values that made it."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.blind_trial.baselines.regression import Term, equations
from pipeline.blind_trial.baselines.rig import Rig, Run, read
from pipeline.blind_trial.generators.spring_mass.rig import drawn

RATE, MASS, STIFFNESS, DAMPING, CUBIC = 100.0, 1.3, 250.0, 1.7, 4e4
TIME = np.arange(600) / RATE


def known(cubic=0.0, free=("masses.body", "joints.tie.stiffness", "joints.tie.damping")):
    """Rig and run of x = 0.03 sin 9t + 0.02 cos 14t: its force follows from the equation of motion."""
    x = 0.03 * np.sin(9 * TIME) + 0.02 * np.cos(14 * TIME)
    v = 0.27 * np.cos(9 * TIME) - 0.28 * np.sin(14 * TIME)
    a = -2.43 * np.sin(9 * TIME) - 3.92 * np.cos(14 * TIME)
    force = MASS * a + DAMPING * v + STIFFNESS * x + cubic * x**3
    run = Run("one", force[None], x[None], None, 0.0)
    return Rig(("body",), ("tie",), ("x",), np.array([MASS]), np.ones((1, 1)), np.array([STIFFNESS]),
               np.array([DAMPING]), ((0.0, np.inf),), None, frozenset(free), RATE, (run,), ())


@pytest.mark.exact
def test_values_of_a_linear_rig_come_back():
    rig = known()
    found = equations(rig, rig.runs)
    np.testing.assert_allclose(found.fit(), [MASS, STIFFNESS, DAMPING], rtol=5e-5)     # sums of samples for integrals
    assert np.linalg.norm(found.residual()) < 5e-5 * np.linalg.norm(found.target)


@pytest.mark.exact
def test_a_law_of_the_library_comes_back_with_its_coefficient():
    rig, term = known(CUBIC), Term("cubic_stiffness", "tie")
    found = equations(rig, rig.runs)
    np.testing.assert_allclose(found.fit((term,)), [MASS, STIFFNESS, DAMPING, CUBIC], rtol=2e-3)
    assert np.linalg.norm(found.residual((term,))) < 0.01 * np.linalg.norm(found.residual())


@pytest.mark.exact
def test_a_value_that_is_known_is_a_law_of_the_library_instead():
    rig = known(free=("masses.body", "joints.tie.stiffness"))
    off = replace(rig, damping=np.array([0.7]))
    found = equations(off, off.runs)
    assert found.fit((Term("joint_damping", "tie"),))[-1] == pytest.approx(1.0, rel=1e-2)


def test_delay_and_filter_of_the_sensor_are_undone(control):
    rig, true = read(control), drawn(np.random.default_rng(7), 1)
    whole, plain = (equations(r, r.runs).fit()[2] for r in (rig, replace(rig, sensors=((0.0, np.inf),))))
    assert whole == pytest.approx(true.links[0].damping, rel=0.05)
    assert abs(plain / true.links[0].damping - 1) > 0.1
