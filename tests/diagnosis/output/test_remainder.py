"""What is left after naming: nothing beside noise; a small force that the catalogue lacks, by its band and its law."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.runs import recorded
from pipeline.contract.errors import ConvergenceError
from pipeline.contract.settings import fill
from pipeline.diagnosis.forced_response import forced_problem
from pipeline.diagnosis.output.combinations import NOT_REFITTED
from pipeline.diagnosis.output.product import product
from pipeline.diagnosis.output.remainder import remainder
from pipeline.diagnosis.settings import Settings
from pipeline.inference.several import Combination
from tests.diagnosis.small_rig import HIDDEN, NOISE, RATE, SAMPLES, laid_out, model, recording
from tests.diagnosis.solving import solved

ASKED = {"parameters": {"joints.mount.stiffness": {"spread": 0.1}, "joints.mount.damping": {"spread": 0.2}},
         "held_out": ["level_3"], "noise": {"std": {"x": f"{NOISE} m"}}, "draws": 2000, "solver": False,
         "effects": ["cubic_stiffness", "coulomb"]}


@cache
def weighed(tone):
    """(DiagnosisProblem, Diagnosis) of a rig with a cubic spring whose channel shows a ``tone`` of 20 Hz, in noises."""
    given = recording(HIDDEN, levels=(2.0, 9.0, 7.0))
    wave = tone * NOISE * np.sin(2 * np.pi * 20.0 * np.arange(SAMPLES) / RATE)
    runs = {name: replace(run, channels={**run.channels, "x": replace(
        run.channels["x"], samples=run.channels["x"].samples + wave)}) for name, run in given.runs.items()}
    asked = forced_problem(benches.built(model(), laid_out()), recorded(replace(given, runs=runs), laid_out()),
                           fill(Settings, ASKED, "d"))
    return asked, solved(asked, kept=2)


def test_beside_noise_nothing_is_left():
    told = remainder(*weighed(0.0))
    assert told.sentence == told.candidate == "" and told.floors == pytest.approx(1.0, abs=0.05)


def test_a_tone_that_the_named_effect_does_not_make_is_told_with_its_band_and_size():
    asked, found = weighed(1.5)
    told = remainder(asked, found)
    assert [c.name for c in found.decision.named] == ["cubic_stiffness at mount"]
    assert told.floors == pytest.approx(np.sqrt(1 + 1.5**2 / 2), rel=0.03)
    assert "between 12.5 and 25 Hz" in told.sentence
    written = product(asked, found)
    assert written.left_floors == told.floors and written.left_sentence == told.sentence
    assert list(written.noise_level) == [0.5, 2.0, 4.0] and "missing" in list(written.noise_verdict)


def test_a_fit_that_cannot_be_pushed_costs_no_verdict():
    class Stuck:
        def located(self, diagnosis):
            raise ConvergenceError("time stepping at t = 1 s", "a force that settles", "none")

    asked, found = weighed(1.5)
    told = remainder(replace(asked, locator=Stuck()), found)
    assert told.sentence.startswith("Where it lies could not be computed: time stepping at t = 1 s") and told.floors > 1


def test_the_best_set_that_was_tried_tells_what_comes_next():
    asked, found = weighed(1.5)
    name = found.named[0].candidate.name
    sets = (Combination((name, "coulomb at mount"), 30.0), Combination(("coulomb at mount",), 90.0),
            Combination((name, "clipping at x"), 20.0, 1.0, 1.2, "clipping at x adds an evidence of 1.0 nat"))
    told = [remainder(asked, replace(found, further=None, combinations=tried)).candidate
            for tried in (sets, sets[:2], sets[1:2])]
    assert told == ["clipping at x: clipping at x adds an evidence of 1.0 nat", f"coulomb at mount: {NOT_REFITTED}", ""]
