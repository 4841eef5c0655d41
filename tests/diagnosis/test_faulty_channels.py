"""A channel of reversed sign, or in another unit than stated, is named as such, be it among the whole catalogue."""

from dataclasses import replace
from functools import cache

import pytest

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.runs import recorded
from pipeline.contract.settings import fill
from pipeline.diagnosis.forced_response import forced_problem
from pipeline.diagnosis.settings import Settings
from tests.diagnosis.small_rig import NOISE, laid_out, model, recording

ASKED = {"parameters": {"joints.mount.stiffness": {"spread": 0.1}, "joints.mount.damping": {"spread": 0.3}},
         "held_out": ["level_3"]}


@cache
def sound():
    """Recording of the small rig whose channel shows what it should."""
    return recording(levels=(2.0, 9.0, 7.0))


def problem(factor, weighed=()):
    """DiagnosisProblem of the small rig whose channel shows ``factor`` times what it should, its noise too."""
    given, section = sound(), laid_out()
    runs = {name: replace(run, channels={**run.channels, "x": replace(
        run.channels["x"], samples=factor * run.channels["x"].samples)}) for name, run in given.runs.items()}
    asked = {**ASKED, "noise": {"std": {"x": f"{abs(factor) * NOISE} m"}}, "effects": list(weighed)}
    return forced_problem(benches.built(model(), section), recorded(replace(given, runs=runs), section),
                          fill(Settings, asked, "diagnosis"))


@pytest.mark.parametrize("factor, name", [
    (-1.0, "reversed_channel"), (0.1, "unit_factor"), pytest.param(1000.0, "unit_factor", marks=pytest.mark.slow)])
def test_among_faults_of_channels_the_right_one_is_named(factor, name):
    told = problem(factor, ("sensor_gain", "reversed_channel", "unit_factor", "coulomb")).solved()
    assert told.decision.verdict == "sensor" and [c.name for c in told.decision.named] == [f"{name} at x"]
    assert told.named[0].fit.values[f"{name}@x.factor"] == pytest.approx(factor, rel=0.01)


@pytest.mark.slow
@pytest.mark.study
@pytest.mark.parametrize("factor, name", [(-1.0, "reversed_channel"), (1000.0, "unit_factor")])
def test_among_the_whole_catalogue_it_is_named(factor, name):
    told = problem(factor).solved()
    assert told.decision.verdict == "sensor" and [c.name for c in told.decision.named] == [f"{name} at x"]
