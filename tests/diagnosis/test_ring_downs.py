"""Ring-downs whose starts nobody states, at 20 samples a period with 1 % noise: the hidden law is named, or none.

SciPy makes them; the nominal stiffness and damping are 3 and 9 % off.
"""

import numpy as np
import pytest

from pipeline.diagnosis.output.product import product
from pipeline.inference.fitting import calibration
from pipeline.inference.fitting.calibration import recalibrate
from pipeline.inference.fitting.fit_state import linearised
from pipeline.inference.fitting.run_parameters import with_own_parameters
from pipeline.inference.rules import DEFAULTS
from tests.diagnosis import two_mass_decays
from tests.diagnosis.decays import decay, duffing, jenkins, linear, problem

STARTS = {"a": (0.1, 0.3), "b": (-0.03, 1.2), "c": (0.05, -0.2), "last": (0.02, -1.6)}
WEIGHED = ("coulomb", "cubic_stiffness", "hysteretic_joint", "quadratic_damping", "quadratic_stiffness", "sensor_delay",
           "added_stiffness")
#: N/m and N of the Jenkins elements
SLIDERS = np.full(8, 15.0), 15.0 * np.linspace(0.005, 0.1, 8)


def solved(law, quantity, seed, memory=lambda x: (), before=0, runs=tuple(STARTS)):
    """(DiagnosisProblem, Diagnosis) of ring-downs of 5 s, of which the first ``before`` samples were not recorded."""
    motions = {name: tuple(part[before:] for part in decay(law, STARTS[name], 5.0 + before / 64,
                                                           memory(STARTS[name][0]))) for name in runs}
    whole = problem(motions, quantity, seed=seed, weighed=WEIGHED)
    return whole, whole.solved()


@pytest.mark.slow
@pytest.mark.parametrize("quantity, seed", [
    ("displacement", 1), ("velocity", 2), pytest.param("acceleration", 3, marks=pytest.mark.study)])
def test_a_duffing_oscillator_is_named(quantity, seed):
    whole, found = solved(duffing, quantity, seed)
    assert found.decision.verdict == "missing", found.decision.reasons
    assert [w.candidate.name for w in found.named] == ["cubic_stiffness at mount"]
    spread, values = found.completed.spread(found.weights), found.completed.values
    for name, true in (("cubic_stiffness@mount.coefficient", 15000.0), ("joints.mount.stiffness", 412.0)):
        assert abs(values[name] - true) < 3 * spread[name], (name, values[name], spread[name])
    told = product(whole, found)
    assert not any("start" in str(name) for name in told.parameter), "no value of the model"
    assert list(told.start_run) == ["a"] * 3 + ["b"] * 3 + ["c"] * 3
    assert [str(what) for what in told.start_quantity[:2]] == ["displacement of block", "velocity of block"]
    assert (abs(told.start_value[:2] - STARTS["a"]) < 3 * told.start_std[:2]).all()


@pytest.mark.parametrize("quantity, before, seed, runs", [
    ("displacement", 0, 1, ("a", "b", "last")), pytest.param("velocity", 0, 2, tuple(STARTS), marks=pytest.mark.slow),
    pytest.param("displacement", 40, 4, tuple(STARTS), marks=pytest.mark.slow)])
def test_an_iwan_joint_is_named_wherever_the_record_begins(quantity, before, seed, runs):
    """Jenkins elements that were loaded to the start, or whose first two periods were not recorded.

    No set of other laws takes their place.
    """
    stiffness, limit = SLIDERS
    _, found = solved(jenkins(*SLIDERS), quantity, seed, lambda x: np.clip(stiffness * x, -limit, limit), before,
                      runs)
    assert found.decision.verdict == "missing", found.decision.reasons
    assert [w.candidate.name for w in found.named] == ["hysteretic_joint at mount"]


@pytest.mark.parametrize("quantity, seed", [("displacement", 1), ("velocity", 2)])
def test_nothing_is_missing_in_a_linear_decay(quantity, seed):
    _, found = solved(linear, quantity, seed)
    assert found.decision.verdict == "parameters", "its stiffness and damping are other ones"
    spread, values = found.completed.spread(found.weights), found.completed.values
    assert abs(values["joints.mount.stiffness"] - 412.0) < 3 * spread["joints.mount.stiffness"]


@pytest.mark.parametrize("friction", [0.0, 0.5])
def test_a_recalibration_is_never_worse_than_the_given_values(friction, monkeypatch):
    """Two coordinates whose stiffness is 5 % off. A fit that ends in a wrong optimum, one stiffness eight standard
    deviations off and the start states with it, does not stand beside the given values with start states of their own.
    """
    starts = {"a": (0.03, 0.0, 0.2, -0.4), "b": (-0.02, 0.03, 0.0, 0.5)}
    posed = two_mass_decays.problem(*two_mass_decays.decays((945.0, 480.0), (2.4, 0.9), friction, starts, 100.0, 300))
    problem, budget = posed.problem, posed.budget
    noises = tuple(budget[run.name] for run in problem.training)
    given = with_own_parameters(problem, noises, problem.nominal, problem.nominal.nominal, problem.training)
    right = recalibrate(problem, budget, DEFAULTS.calibration).null
    far = given.copy()
    far[0] = 8.0
    wrong = linearised(problem, noises, problem.nominal, with_own_parameters(
        problem, noises, problem.nominal, far, problem.training), problem.training)
    assert wrong.objective > 3 * linearised(problem, noises, problem.nominal, given, problem.training).objective
    monkeypatch.setattr(calibration, "calibrate", lambda *_: wrong)
    again = recalibrate(problem, budget, DEFAULTS.calibration).null
    assert again.objective == pytest.approx(right.objective, rel=1e-3)
    if not friction:
        assert abs(again.values["joints.mount.stiffness"] - 945) < 4 * again.spread()["joints.mount.stiffness"]
