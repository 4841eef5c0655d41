"""Runs, channels and inputs that tell nothing: one sentence each, and the diagnosis that is still possible."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.runs import recorded
from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from pipeline.diagnosis.forced_response import forced_problem
from pipeline.diagnosis.settings import Settings
from pipeline.diagnosis.signals.start_states import started
from pipeline.diagnosis.signals.usable_runs import doubts, usable, without
from tests.diagnosis import decays, two_masses
from tests.diagnosis.small_rig import laid_out, model

STARTS = {"a": (0.1, 0.3), "b": (-0.03, 1.2), "last": (0.02, -1.6)}


def bench_of_decays():
    section = laid_out(channels={"x": {"quantity": "displacement", "source": "block"}}, inputs={})
    return benches.built(model(), section), section


def decayed(**samples):
    """{name: Recorded} of decays of 3 s, runs named cut to so many samples."""
    given, _ = decays.recording({name: tuple(part[:samples.get(name)] for part in decays.decay(
        decays.linear, start, 3.0)) for name, start in STARTS.items()})
    return recorded(given, bench_of_decays()[1])


def test_a_run_whose_start_cannot_be_estimated_is_left_out_and_told():
    whole, section = bench_of_decays()
    runs = decayed(b=9)
    with pytest.raises(ConfigError, match="run b.*at least one period"):
        started(whole, runs, section)
    begun = started(whole, runs, section, refused := {})
    assert list(begun) == ["a", "last"] and list(refused) == ["b"]
    assert refused["b"].startswith("left out, run b: start: expected a run of at least one period")
    asked = without(fill(Settings, {"held_out": ["b", "last"], "noise": {"std": {"x": "1 mm"}}}, "d"), refused)
    assert asked.held_out == ("last",)
    problem = forced_problem(whole, begun, asked, tuple(refused.values()))
    assert problem.remarks == tuple(refused.values())
    with pytest.raises(ConfigError, match="at least one period"):
        started(whole, decayed(a=9, b=9, last=9), section, {})


def test_runs_without_a_sample_that_counts_are_left_out_and_what_repeats_them_stands_alone():
    runs = decayed()
    runs = {"a": replace(runs["a"], valid=np.zeros_like(runs["a"].valid)), "b": replace(runs["b"], repeat_of="a")}
    made, refused = usable(runs)
    assert list(made) == ["b"] and not made["b"].repeat_of
    assert "run a: expected samples that count, found none" in refused["a"]
    with pytest.raises(ConfigError, match="samples that count"):
        usable({"a": runs["a"]})


def test_copies_dead_channels_and_inputs_that_do_nothing_are_told():
    runs = recorded(two_masses.recording({}, levels=(1.0,)), two_masses.LAID)
    run = runs["level_1"]
    assert not list(doubts(runs, ("shaker",)))
    copy = replace(run, samples=run.samples[[0, 0]])
    dead = replace(run, samples=run.samples * [[1.0], [0.0]])
    still = replace(run, run=replace(run.run, inputs={"shaker": np.zeros(run.samples.shape[1])}))
    copied, = doubts({"level_1": copy})
    assert copied.startswith("channels left and right of run level_1 are copies of one another")
    off, = doubts({"level_1": dead})
    assert off.startswith("channel right of run level_1 holds one value throughout")
    nothing, = doubts({"level_1": still}, ("shaker",))
    assert nothing.startswith("input shaker is zero in all runs")
