"""Tests of a bench from its recording: a cycle beside a silent test, and runs at one operating point each."""

from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.diagnosis.published.line_tests import cycle_tests, grouped, run_tests
from pipeline.products import Condition, Lines, Recording, Run
from tests.views.products_for_views import filled

PRESSURE = np.array([0.5e6, 1e6, 2e6])
SETTINGS = SimpleNamespace(run="bench", runs=("low", "high", "quiet"), list="laser", low=1e3, high=20e3,
                           model_error=0.01, silent_up_to=0.6e6, constant_speed=8.0, cycle_speed=6.0)


def run(*lines, pressure=1e6, unit="Pa"):
    """A Run with lines, read to 30 Hz, at a pressure and 4 rad/s."""
    listed = filled(Lines, label=[""] * len(lines), frequency=list(lines), frequency_tolerance=[30.0] * len(lines),
                    place="")
    given = {"pressure": Condition(value=[pressure], time=[0.0], unit=unit),
             "speed": Condition(value=[4.0], time=[0.0], unit="rad/s")}
    return Run(description="", repeat_of="", lines={"laser": listed}, conditions=given)


def recording(**runs):
    return Recording(source=[], runs=runs)


BENCH = recording(bench=run(9e3, 5e3), low=run(5e3), high=run(5.02e3, 9e3, pressure=2.01e6), quiet=run())


def test_a_cycle_is_one_test_beside_a_silent_one():
    made = cycle_tests(BENCH, SETTINGS, PRESSURE)
    np.testing.assert_array_equal(made.heard.lines, [5e3, 9e3])
    np.testing.assert_array_equal(made.silent, [False, True])
    np.testing.assert_array_equal(made.test, [1, 0, 0])
    np.testing.assert_array_equal(made.changing, [False, True, True])
    np.testing.assert_allclose(made.speed, [8, 12, 6])
    assert made.reading == pytest.approx(30 / np.sqrt(3))


def test_runs_are_tests_at_their_conditions_and_equal_frequencies_are_one_line():
    made = run_tests(BENCH, SETTINGS, PRESSURE)
    np.testing.assert_allclose(made.heard.lines, [5.01e3, 9e3])
    np.testing.assert_array_equal(made.heard.tests, [[1, 1, 0], [0, 1, 0]])
    np.testing.assert_array_equal(made.state, [1, 2, 1])
    assert made.name == ("low", "high", "quiet") and not made.changing.any() and list(made.silent) == [0, 0, 1]


def test_groups_are_cut_where_neighbours_are_apart():
    groups = grouped(np.array([3e3, 1e3, 1.005e3, 1.012e3]), 0.01)
    assert [list(g) for g in groups] == [[1, 2, 3], [0]] and not grouped(np.empty(0), 0.01)


@pytest.mark.parametrize(("runs", "where"), [
    ({"high": run(30e3)}, "line_evidence.low"), ({"high": run(5e3, pressure=1.5e6)}, "high.conditions.pressure"),
    ({"high": run(5e3, unit="N")}, "high.conditions"), ({"low": run(), "high": run(), "quiet": run()}, "runs"),
    ({"low": Run(description="", repeat_of="")}, "line_evidence.runs")])
def test_runs_that_do_not_fit_are_refused(runs, where):
    with pytest.raises(ConfigError, match=where):
        run_tests(recording(**{**BENCH.runs, **runs}), SETTINGS, PRESSURE)


@pytest.mark.parametrize(("pressure", "lines", "where"), [
    (PRESSURE[:1], (5e3,), "structure.pressures"), (PRESSURE, (), "line_evidence.list"),
    (PRESSURE, (30e3,), "line_evidence.low")])
def test_cycles_that_do_not_fit_are_refused(pressure, lines, where):
    with pytest.raises(ConfigError, match=where):
        cycle_tests(recording(bench=run(*lines)), SETTINGS, pressure)
