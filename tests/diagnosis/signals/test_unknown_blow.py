"""Blows of unknown size and time: their impulse is exact, and a ring-down gives them back."""

import numpy as np
import pytest

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.runs import recorded
from pipeline.contract import ConfigError
from pipeline.diagnosis.signals.start_states import begun, start_parameters, started
from pipeline.diagnosis.signals.unknown_blow import Blow, answered, pulse, run_blows, struck
from pipeline.inference.problem import Hypothesis
from pipeline.physics.virtual_rig.response import Run
from tests.diagnosis import small_rig
from tests.diagnosis.decays import MASS, RATE, STIFFNESS, problem, recording
from tests.diagnosis.signals.test_start_states import exact

IMPULSE, TIME = 0.9, 0.2031
RUN = Run("a", 4.0, RATE)


def ringing(impulse=IMPULSE, time=TIME, duration=4.0):
    """(displacement, velocity, acceleration) of the decay after an impulse on the mass of 1 kg at rest."""
    grid = np.arange(round(duration * RATE) + 1) / RATE
    fine = exact((0.0, impulse), duration, rate=8000)
    return tuple(np.interp(grid - time, np.arange(len(part)) / 8000, part, left=0.0) for part in fine)


def rig(motion, **bench):
    section = small_rig.laid_out(channels={"x": {"quantity": "displacement", "source": "block"}}, inputs={},
                                 blow="shaker", **bench)
    given, _ = recording(motion, noise=0.0)
    return benches.built(small_rig.model(), section), recorded(given, section), section


@pytest.mark.exact
@pytest.mark.parametrize("time", [0.04, 0.5, 0.5039, 1.99999])
def test_a_pulse_has_its_impulse_and_its_time(time):
    force = pulse(RUN, IMPULSE, time)
    assert force.sum() / RATE == pytest.approx(IMPULSE) and np.count_nonzero(force) <= 3
    assert (force * RUN.time).sum() / force.sum() == pytest.approx(time, abs=1e-12)
    assert (force * (RUN.time - time) ** 2).sum() / force.sum() * RATE**2 == pytest.approx(0.25), "one shape everywhere"


def test_a_blow_adds_to_what_acts_already():
    values = {"blow@a.impulse on shaker": 2.0, "blow@a.time of the blow on shaker": 1.0, "blow@b.impulse on arm": 1.0}
    hit = struck(Run("a", 4.0, RATE, {"shaker": 3.0}), values).inputs["shaker"]
    assert hit[0] == 3.0 and (hit - 3.0).sum() / RATE == pytest.approx(2.0)
    assert run_blows("b", values) == ["arm"] and struck(RUN, {}) is RUN


def test_the_estimate_finds_the_blow_and_its_parameters_strike_the_run():
    bench, runs, section = rig({"a": ringing()})
    given = started(bench, runs, section)["a"]
    assert isinstance(given.unknown, Blow) and given.run.start is None
    assert given.unknown.impulse == pytest.approx(IMPULSE, rel=0.05)
    assert given.unknown.time == pytest.approx(TIME, abs=1 / RATE)
    own = start_parameters(bench, given, True)
    assert [p.unit for p in own] == ["N s", "s"] and {p.run for p in own} == {"a"}
    hypothesis = Hypothesis("nominal", (), own)
    hit = begun(given.run, hypothesis, hypothesis.values(hypothesis.nominal)).inputs["shaker"]
    assert hit.sum() / RATE == pytest.approx(given.unknown.impulse)


def test_blows_of_a_linear_rig_leave_nothing_missing():
    strokes = {"a": (0.9, 0.2031), "b": (-1.6, 0.15), "c": (0.4, 0.31), "last": (1.2, 0.171)}
    whole = problem({name: ringing(*stroke, duration=5.0) for name, stroke in strokes.items()}, blow="shaker",
                    weighed=["cubic_stiffness", "coulomb"])
    found = whole.solved()
    assert found.decision.verdict == "parameters", found.decision.reasons
    values, spread = found.completed.values, found.completed.spread(found.weights)
    for name, (impulse, time) in list(strokes.items())[:3]:
        what = f"blow@{name}.impulse on shaker", f"blow@{name}.time of the blow on shaker"
        felt = answered(RATE * 2 * np.pi / np.sqrt(STIFFNESS / MASS)) * values[what[0]]
        assert abs(felt - impulse) < 3 * spread[what[0]], name
        assert abs(values[what[1]] - time) < 3 * spread[what[1]]


def test_blows_that_cannot_be_found_are_refused():
    bench, runs, section = rig({"a": ringing(time=2.5)})
    with pytest.raises(ConfigError, match=r"run a: blow: expected a blow within the first .*begin shortly before"):
        started(bench, runs, section)
    with pytest.raises(ConfigError, match=r"bench.blow: expected an input that is a force.*shaker, found 'hammer'"):
        started(bench, runs, section.model_copy(update={"blow": "hammer"}))
    with pytest.raises(ConfigError, match=r"bench.blow: expected none where starts are fitted"):
        started(bench, runs, section.model_copy(update={"start": "fitted"}))
