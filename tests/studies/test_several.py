"""The study of several laws: its plan, its truth against a closed form; and, slow, one joint by simulation."""

import numpy as np
import pytest
from scipy.integrate import quad

from tests.studies.several import (
    DAMPING,
    LAWS,
    MASS,
    RATE,
    SIZE,
    STIFFNESS,
    Truth,
    answer,
    joint_force,
    motion,
    plans,
    problem,
    truth,
)


def test_twelve_draws_of_all_of_each_pair_and_of_each_alone():
    found = plans(12)
    assert len(found) == 84 and {laws for laws, _ in found} >= {LAWS, *((law,) for law in LAWS)}


def test_laws_are_wrong_by_two_to_five_per_cent_and_have_their_size():
    for seed in range(10):
        given = truth(LAWS, seed)
        assert all(0.02 <= abs(error) <= 0.05 for error in given.error.values())
        alone = Truth({"cubic_stiffness": given.force["cubic_stiffness"]}, given.error)
        assert joint_force(-SIZE, 0.0, alone) == pytest.approx(-given.force["cubic_stiffness"])


def test_the_truth_keeps_the_balance_of_work():
    """Work of the shaker = energy in mass, spring and law + loss in damper and friction, along one run."""
    given = truth(LAWS, 3)
    x, shaken = motion(given, 4.0, 1)
    v = np.gradient(x, 1 / RATE, edge_order=2)
    static = Truth({law: size for law, size in given.force.items() if law != "coulomb"}, given.error)
    dry = Truth({"coulomb": given.force["coulomb"]}, given.error)
    in_laws = quad(lambda e: joint_force(e, 0.0, static), 0, x[-1])[0]
    stored = MASS * v[-1] ** 2 / 2 + STIFFNESS * x[-1] ** 2 / 2 + in_laws
    lost = np.trapezoid(DAMPING * v**2 + np.array([joint_force(0.0, each, dry) for each in v]) * v, dx=1 / RATE)
    assert np.trapezoid(shaken * v, dx=1 / RATE) == pytest.approx(stored + lost, rel=5e-3)


@pytest.mark.slow
@pytest.mark.study
def test_three_laws_of_a_joint_are_named_by_simulation():
    assert answer(problem(truth(LAWS, 0), 0).solved()) == ("missing", tuple(sorted(LAWS)))
