"""Tests of a bench from its recording: a cycle beside a silent test, and runs at one operating point each."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.diagnosis.published.line_tests import cycle_tests, grouped, record_tests, run_tests
from pipeline.products import Channel, Condition, Lines, Recording, Run
from tests.views import products_for_views as small
from tests.views.products_for_views import filled

PRESSURE = np.array([0.5e6, 1e6, 2e6])
SETTINGS = SimpleNamespace(run="bench", runs=("low", "high", "quiet"), list="laser", low=1e3, high=20e3,
                           model_error=0.01, silent_up_to=0.6e6, constant_speed=8.0, cycle_speed=6.0,
                           pressure_factor=1.0, pressure_within=0.05)


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


def channel(samples, unit, measures):
    return filled(Channel, samples=samples, missing=np.empty((0, 2), int), unit=unit, measures=measures, rate=10.0,
                  role="response")


#: two stops, of which one states its conditions and the other has channels for them
RECORDED = recording(
    stop_1=replace(run(pressure=10e6), lines={}),
    stop_2=Run(description="", repeat_of="", channels={
        "line": channel(np.full(20, 5.1e6), "Pa", "pressure"), "mic": channel(np.ones(20), "Pa", "sound_pressure"),
        "wheel": channel(np.linspace(3.9, 4.1, 20), "rad/s", "angular_velocity")}))
PADS = SimpleNamespace(**{**vars(SETTINGS), "runs": (), "pressure_factor": 0.2, "low": 2e3})


def test_squeal_of_records_is_what_was_heard_at_their_conditions():
    """Of stop_1 the microphone counts, without its harmonic; of a line pressure a fifth acts on the pads."""
    made = record_tests(RECORDED, small.noise_events(), PADS, PRESSURE)
    assert made.name == ("stop_1", "stop_2") and made.state.tolist() == [2, 1]
    np.testing.assert_allclose(made.heard.lines, [2780.0, 7340.0])
    np.testing.assert_array_equal(made.heard.tests, [[1, 0], [0, 1]])
    np.testing.assert_allclose(made.speed, [4.0, 4.0], atol=0.02)
    assert made.reading == pytest.approx(7340e-3 / np.sqrt(3))


def test_a_stop_over_many_speeds_unsearched_runs_and_a_band_that_nobody_searched_are_refused():
    moving = replace(RECORDED.runs["stop_2"], channels={**RECORDED.runs["stop_2"].channels, "wheel": channel(
        np.linspace(9.0, 1.0, 20), "rad/s", "angular_velocity")})
    events = small.noise_events()
    with pytest.raises(ConfigError, match="stop_2: expected one speed, .*cut the record into runs"):
        record_tests(recording(**{**RECORDED.runs, "stop_2": moving}), events, PADS, PRESSURE)
    with pytest.raises(ConfigError, match="runs with a microphone or an accelerometer: stop_1, stop_2, found drag"):
        record_tests(RECORDED, events, SimpleNamespace(**{**vars(PADS), "runs": ("drag",)}), PRESSURE)
    with pytest.raises(ConfigError, match="line_evidence.low: expected at least 2000 Hz"):
        record_tests(RECORDED, events, SimpleNamespace(**{**vars(PADS), "low": 1e3}), PRESSURE)
    with pytest.raises(ConfigError, match="a pressure that the model was computed at"):
        record_tests(RECORDED, events, SimpleNamespace(**{**vars(PADS), "pressure_factor": 0.3}), PRESSURE)
