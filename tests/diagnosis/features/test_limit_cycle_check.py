"""Squeals of a small bench: what squeals in recording and model, and that features agree only where they should."""

from dataclasses import replace
from functools import cache

import numpy as np

from pipeline.case_models.runs import Recorded
from pipeline.contract.settings import fill
from pipeline.diagnosis.features.limit_cycle_check import Squeals, simulated
from pipeline.diagnosis.output.product import squeal_check
from pipeline.diagnosis.settings import SaturatedSqueal
from pipeline.physics.virtual_rig.response import Run
from tests.diagnosis.small_bench import bench

RATE = 4096.0
FALLING = {"falling_friction": {"contact": {"rise": 1.5, "decay_speed": "0.1 m/s"}}}
ASKED = {"duration": "1.5 s", "stretch": "50 ms", "lowest": "40 Hz", "kick": "2 mm/s"}
CHANNELS = {"laser": "m/s", "accelerometer": "m/s^2", "cell": "N"}


def told(**more):
    return fill(SaturatedSqueal, {**ASKED, **more}, "diagnosis.saturated_squeal")


@cache
def recorded(hidden=True):
    """{run: Recorded} of two records of sliding, simulated from other starts than those of the repeats."""
    whole = bench(FALLING if hidden else None)
    run = Run("slide", 1.5, RATE, conditions={"press": 10.0, "speed": 0.5})
    blank = Recorded(run, tuple(CHANNELS), tuple(CHANNELS.values()), np.zeros((3, run.samples)),
                     np.ones((3, run.samples), bool), "")
    first, again, _ = simulated(whole, blank, told(), seed=7)
    made = {name: replace(blank, samples=np.array([one[c] for c in CHANNELS]), repeat_of=of,
                          run=replace(run, name=name))
            for name, one, of in (("slide", first, ""), ("slide_again", again, "slide"))}
    still = replace(blank, run=replace(run, name="still", conditions={"press": 10.0, "speed": 0.0}))
    return {**made, "still": still}


def compared(hidden, **models):
    """Compared of the run under Benches {who: Bench}."""
    squeals = Squeals(bench(), recorded(hidden), told())
    (name, records), = squeals._points().items()
    assert name == "slide" and len(records) == 2, "runs at rest are left out, repeats belong to what they repeat"
    return squeals._compared(models, records)


def test_the_model_that_made_the_squeal_agrees_and_the_nominal_one_is_quiet():
    found = compared(True, recalibrated=bench(), completed=bench(FALLING))
    squealing = {who: (one.squealing, len(one.states)) for who, one in found.heard.items()}
    assert squealing == {"recorded": (2, 2), "recalibrated": (0, 3), "completed": (3, 3)}
    assert "only one of recording and recalibrated model" in found.sentence and "completed model" not in found.sentence
    assert len(found.agrees["completed"]) == 9 and all(found.agrees["completed"].values())
    assert not found.agrees["recalibrated"], "nothing to compare"


def test_another_squeal_does_not_agree():
    """A pin of a frequency 5 % higher squeals as loud, higher by as much as it stands for of the motion."""
    found = compared(True, completed=bench(FALLING, corrections={"bodies.pin.frequency": 1.05}))
    assert found.heard["completed"].squealing == 3 and not found.agrees["completed"]["frequency of laser"]
    means = [found.heard[who].values["frequency of laser"].mean() for who in ("recorded", "completed")]
    assert 1.01 < means[1] / means[0] < 1.05


def test_nothing_squeals_in_either():
    found = compared(False, recalibrated=bench())
    assert found.heard["recorded"].squealing == found.heard["recalibrated"].squealing == 0
    assert "only one" not in found.sentence and not found.heard["recorded"].values


def test_the_product_holds_what_is_known_of_each():
    found = squeal_check(compared(True, recalibrated=bench(), completed=bench(FALLING)))
    assert list(found.who) == ["recorded", "recalibrated", "completed"] and found.squealing.tolist() == [2, 0, 3]
    row = list(found.feature).index("frequency of laser")
    assert found.known[:, row].tolist() == [1, 0, 1] and found.agrees[:, row].tolist() == [0, 0, 1]
    open_share = list(found.feature).index("share of time open")
    assert found.known[:, open_share].tolist() == [0, 0, 1], "no sensor shows it"


def test_points_may_be_chosen():
    assert not Squeals(bench(), recorded(), told(runs=["still"]))._points(), "it does not slide"
    assert list(Squeals(bench(), recorded(), told(runs=["slide"]))._points()) == ["slide"]
