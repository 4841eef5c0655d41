"""Runs, hypotheses and problems: what joins, and what is refused."""

import pickle
from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.inference.priors import LogNormal, Normal, Parameter
from pipeline.inference.problem import Hypothesis, Observed, Problem, operating_points
from tests.inference.oscillator import CATALOGUE, NOMINAL, predict


def run(name, **more):
    return Observed(name, {}, ("a",), more.pop("samples", np.zeros((1, 4))), 1.0, **more)


def test_hypotheses_join_their_effects_and_parameters():
    both = NOMINAL.joined(CATALOGUE[0]).joined(CATALOGUE[2])
    assert both.name == "cubic + coulomb" and both.effects == (("cubic", "mount"), ("coulomb", "mount"))
    assert list(both.values(both.nominal)) == ["stiffness", "damping", "cubic_stiffness", "friction_force"]
    assert both.values(both.nominal)["stiffness"] == pytest.approx(NOMINAL.parameters[0].nominal)
    assert NOMINAL.joined(CATALOGUE[-1]).kind == "sensor"


def test_laws_of_one_family_exclude_each_other():
    dry, lugre, dahl, spring = (Hypothesis(name, extends=extends) for name, extends in (
        ("coulomb at a", ()), ("lugre at a", ("dahl at a", "coulomb at a")), ("dahl at a", ("coulomb at a",)),
        ("cubic at a", ())))
    assert all(one.excludes(other) for one in (dry, lugre, dahl) for other in (dry, lugre, dahl))
    assert not spring.excludes(dry) and not dry.excludes(Hypothesis("lugre at b", extends=("coulomb at b",)))


def test_no_faulty_sensor_is_second_to_another():
    """Gains of two sensors shrink all data, which leaves less without explaining anything."""
    first, second = Hypothesis("gain at a"), Hypothesis("gain at b")
    faulty = replace(first, kind="sensor")
    assert not first.excludes(second) and not first.excludes(replace(second, kind="sensor"))
    assert not faulty.excludes(second) and faulty.excludes(replace(second, kind="sensor"))


def test_missing_samples_may_hold_anything_and_count_as_nothing():
    holed = run("a", samples=np.array([[1.0, np.nan, 2.0, 3.0]]), valid=np.array([[True, False, True, True]]))
    assert holed.samples[0, 1] == 0.0 and holed.valid.sum() == 3


def test_repeats_share_an_operating_point():
    assert operating_points((run("a"), run("b"), run("c", repeat_of="a"))) == {"a": [0, 2], "b": [1]}


def test_a_problem_can_be_sent_to_other_processes():
    whole = Problem((run("a"),), predict, NOMINAL)
    assert pickle.loads(pickle.dumps(whole)).nominal == NOMINAL


@pytest.mark.parametrize("make, told", [
    (lambda: run("a", samples=np.array([[np.nan, 1.0]])), "finite samples"),
    (lambda: run("a", samples=np.zeros((2, 4))), "samples and mask of 1 channels"),
    (lambda: Problem((), predict, NOMINAL), "at least one recorded run"),
    (lambda: Problem((run("a"), run("a")), predict, NOMINAL), "different names"),
    (lambda: Problem((run("a", held_out=True),), predict, NOMINAL), "at least one run to fit"),
    (lambda: Problem((run("a", repeat_of="b"),), predict, NOMINAL), "repeat_of: expected one of a"),
    (lambda: Hypothesis("h", (), (), "magic"), "physics, sensor or numerics"),
    (lambda: Hypothesis("h", (), (Parameter("a", "1", 0.0, Normal(0.0, 1.0)),) * 2), "parameters of different names"),
])
def test_bad_input_is_refused(make, told):
    with pytest.raises(ConfigError, match=told):
        make()


def test_what_is_of_one_run_changes_the_value_of_all_there():
    """By a factor where it cannot be negative, else by as much; other runs keep the value of all."""
    nominal = Hypothesis("nominal", (), (
        Parameter("stiffness", "N/m", 400.0, LogNormal(400.0, 0.1)), Parameter("offset", "N", 1.0, Normal(1.0, 1.0)),
        Parameter("factor", "1", 1.0, LogNormal(1.0, 0.02), run="warm", of="stiffness"),
        Parameter("shift", "N", 0.0, Normal(0.0, 0.5), run="warm", of="offset")))
    values = {"stiffness": 400.0, "offset": 1.0, "factor": 0.98, "shift": -0.25}
    assert nominal.in_run(values, "warm") == values | {"stiffness": 392.0, "offset": 0.75}
    assert nominal.in_run(values, "cold") == values
