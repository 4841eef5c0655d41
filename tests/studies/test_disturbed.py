"""The study of disturbed controls: its plan, motion in closed form, noise as stated, its score, one case."""

import numpy as np
import pytest

from pipeline.effects import CATALOGUE
from tests.diagnosis.decays import UNITS
from tests.studies.disturbed import DISTURBANCES, Row, disturbed, made, plans, results_of, scored, solved, table
from tests.studies.sharp import Plan


def test_a_rate_of_one_in_a_hundred_can_be_told():
    """None of 381 leaves less than 1 % within the 95 % interval."""
    names = [plan.name for plan in plans()]
    assert len(set(names)) == len(names) >= 381
    assert {name for allowed in DISTURBANCES.values() for name in allowed} <= {effect.name for effect in CATALOGUE}


@pytest.mark.exact
def test_a_body_under_a_constant_force_moves_as_in_closed_form():
    row, time = Row(np.array([2.0]), np.array([800.0]), np.array([4.0])), np.linspace(0, 1, 50)
    seen = row.motion(lambda t: 8.0, time)
    decay, omega = 1.0, np.sqrt(400.0 - 1.0)
    expected = 0.01 * (1 - np.exp(-decay * time) * (np.cos(omega * time) + decay / omega * np.sin(omega * time)))
    np.testing.assert_allclose(seen["displacement"][0], expected, atol=1e-10)
    np.testing.assert_allclose(2 * seen["acceleration"][0] + 4 * seen["velocity"][0] + 800 * seen["displacement"][0],
                               8.0, atol=1e-8)
    assert row.frequencies == pytest.approx([20 / (2 * np.pi)])


@pytest.mark.parametrize("kind", [k for k in DISTURBANCES if k not in ("rounded", "lost")])
def test_noise_has_the_size_that_is_stated(kind):
    std = np.array([0.5, 2.0])
    noise = disturbed(kind, np.zeros((2, 4000)), std, np.random.default_rng(0))
    assert np.sqrt(np.mean((noise / std[:, None])**2)) == pytest.approx(1.0)


def test_rounding_leaves_what_is_stated_and_samples_are_lost():
    values = np.sin(np.linspace(0, 40, 4000))[None]
    std, random = np.array([0.01]), np.random.default_rng(0)
    assert np.std(disturbed("rounded", values, std, random) - values) == pytest.approx(0.01, rel=0.05)
    assert 20 < np.isnan(disturbed("lost", values, std, random)).sum() < 360


def test_a_joint_that_softens_moves_otherwise():
    row, time = Row(np.array([1.0]), np.array([1e4]), np.array([1.0])), np.linspace(0, 3, 2000)
    softer, same = (row.motion(lambda t: np.cos(99.0 * t), time, share)["displacement"] for share in (0.005, 0.0))
    np.testing.assert_allclose(softer[0, :20], same[0, :20], rtol=1e-3, atol=1e-9)
    assert 0.02 < np.std(softer - same) / np.std(same) < 0.5


@pytest.mark.parametrize("kind", ["clock", "reassembled"])
def test_a_case_has_four_runs_of_one_quantity(kind):
    case = made(Plan(kind, 1, 0.01))
    quantities = {sensor["quantity"] for sensor in case.document["lumped"]["sensors"].values()}
    assert len(quantities) == 1 and quantities <= set(UNITS) and len(case.recording.runs) == 4


def test_a_run_lies_beyond_the_others():
    strength = [np.std(r.channels["force"].samples) for r in made(Plan("beyond", 2, 0.01)).recording.runs.values()]
    assert strength[3] > 3 * max(strength[:3])


def test_what_states_the_disturbance_is_no_false_alarm():
    def answer(verdict, *names):
        return {"verdict": verdict, "effects": [{"name": n, "place": "joint_1"} for n in names]}

    warming, white = Plan("warming", 0, 0.01), Plan("white", 0, 0.01)
    assert scored(warming, answer("missing", "thermal_softening")) == (False, False)
    assert scored(white, answer("missing", "thermal_softening")) == (False, True)
    assert scored(white, answer("unknown")) == (False, False) and scored(white, answer("parameters")) == (True, False)
    assert "false alarms" in table([(white, True, False)])[0]


def test_rows_of_the_ledger_count_as_answers():
    row = {"verdict": "missing", "named": "thermal_softening at joint_1", "cpu_seconds": "9"}
    told = results_of({Plan(kind, 0, 0.01).name: row for kind in ("warming", "white")})
    assert [(plan.kind, alarm) for plan, _, alarm in told] == [("warming", False), ("white", True)]


@pytest.mark.parametrize("kind", ["bursts", "lost"])
def test_a_disturbed_control_is_told_as_it_is(kind):
    plan = Plan(kind, 0, 0.01)
    effects = ["coulomb", "viscous", "added_stiffness", "sensor_gain", "sensor_delay"]
    assert scored(plan, solved(made(plan), 2, effects=effects)) == (True, False)
