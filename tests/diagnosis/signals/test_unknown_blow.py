"""Blows of unknown size, time and contact time: a ring-down gives them back, and laws behind them are told right."""

import numpy as np
import pytest

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.runs import recorded
from pipeline.contract import ConfigError
from pipeline.diagnosis.signals.start_states import begun, start_parameters, started
from pipeline.diagnosis.signals.unknown_blow import Blow, run_blows, struck, within
from pipeline.inference.problem import Hypothesis
from pipeline.physics.virtual_rig.half_sine import spectrum
from pipeline.physics.virtual_rig.response import Run, respond
from tests.diagnosis import small_rig
from tests.diagnosis.decays import DAMPING, MASS, RATE, STIFFNESS, problem, recording
from tests.physics.virtual_rig.test_half_sine import answer

IMPULSE, TIME, WIDTH = 0.9, 0.2031, 0.01
RUN = Run("a", 4.0, RATE)


def ringing(impulse=IMPULSE, time=TIME, width=WIDTH, duration=4.0):
    """(displacement,) of the mass of 1 kg at rest that a half sine strikes."""
    decay = DAMPING / (2 * MASS)
    root = -decay + 1j * np.sqrt(STIFFNESS / MASS - decay**2)
    grid = np.arange(round(duration * RATE) + 1) / RATE
    return (impulse / MASS * answer(root, grid - time, width),)


def rig(motion, **bench):
    section = small_rig.laid_out(channels={"x": {"quantity": "displacement", "source": "block"}}, inputs={},
                                 blow="shaker", **bench)
    given, _ = recording(motion, noise=0.0)
    return benches.built(small_rig.model(), section), recorded(given, section), section


@pytest.mark.parametrize("time, width", [(0.5, 0.01), (-1.0, 0.01), (9.0, 0.01), (0.1, 1.0), (3.9, 1.0), (2.0, 50.0)])
def test_a_pulse_lies_within_its_run(time, width):
    pulse = within(RUN, IMPULSE, time, width)
    force = pulse.force(RUN.samples, RATE)
    assert force.sum() / RATE == pytest.approx(IMPULSE) and abs(force[[0, -1]]).max() < 1e-9 * abs(force).max()
    assert (pulse.time == time) == (time in (0.5, 2.0)) and (pulse.width == width) == (width < RUN.duration)


def test_a_blow_adds_to_what_acts_already():
    run = Run("a", 4.0, RATE, {"shaker": 3.0})
    hit = struck(struck(run, blow("a", 5.0, 2.0, 0.1)), blow("a", 2.0, 1.0, 0.1) | blow("b", 1.0, 1.0, 0.1))
    bench = small_rig.laid_out(channels={"force": {"quantity": "input", "source": "shaker"}}, inputs={})
    seen = respond(benches.built(small_rig.model(), bench), hit)["force"]
    assert seen[0] == 3.0 and (seen - 3.0).sum() / RATE == pytest.approx(2.0, rel=1e-3), "in place of the first blow"
    assert run_blows("b", blow("b", 1.0, 1.0, 0.1)) == ["shaker"] and struck(RUN, {}) is RUN


def blow(run, *numbers):
    return {f"blow@{run}.{part} on shaker": value
            for part, value in zip(("impulse", "time of the blow", "contact time"), numbers, strict=True)}


def test_the_estimate_finds_the_blow_and_its_parameters_strike_the_run():
    bench, runs, section = rig({"a": ringing()})
    given = started(bench, runs, section)["a"]
    assert isinstance(given.unknown, Blow) and given.run.start is None
    assert given.unknown.impulse == pytest.approx(IMPULSE, rel=0.1), "contact times trade with impulses"
    assert given.unknown.time == pytest.approx(TIME, abs=1.5 / RATE), "in whole samples, of another stiffness"
    own = start_parameters(bench, given, True)
    assert [p.unit for p in own] == ["N s", "s", "s"] and {p.run for p in own} == {"a"}
    hypothesis = Hypothesis("nominal", (), own)
    hit = begun(given.run, hypothesis, hypothesis.values(hypothesis.nominal)).pulses["shaker"]
    assert (hit.impulse, hit.time, hit.width) == pytest.approx([p.nominal for p in own])
    natural = np.sqrt(400.0) / (2 * np.pi)
    assert spectrum(natural * own[2].prior.quantile(0.95)) == pytest.approx(0.1)


def test_a_blow_keeps_its_sign_where_the_nominal_frequency_is_far_off():
    """Half a period later the upside-down blow explained more of a velocity, of a rig 40 % stiffer than stated."""
    decay = DAMPING / (2 * MASS)
    root = -decay + 1j * np.sqrt(1.4 * STIFFNESS / MASS - decay**2)
    grid = np.arange(round(4 * RATE) + 1) / RATE
    motion = IMPULSE / MASS * answer(root, grid - TIME, WIDTH)
    bench, runs, section = rig({"a": (motion, np.gradient(motion, 1 / RATE))})
    given = started(bench, runs, section)["a"].unknown
    assert given.impulse > 0 and given.time == pytest.approx(TIME, abs=0.1)


@pytest.mark.parametrize("first, second", [(-1.0, 1.0), (1.0, -1.0), (1e3, 1.0), (-1.0, -1.0)])
def test_a_channel_that_is_reversed_or_in_other_units_does_not_move_the_blow(first, second):
    """Where channels disagree, the hammer pushes as the input says; where they agree it may come from behind."""
    motion = ringing()[0]
    shown, moving = (recording({"a": (first * motion, second * np.gradient(motion, 1 / RATE))}, quantity, 0.0)[0]
                     for quantity in ("displacement", "velocity"))
    shown.runs["a"].channels["v"] = moving.runs["a"].channels["x"]
    section = small_rig.laid_out(channels={"x": {"quantity": "displacement", "source": "block"},
                                           "v": {"quantity": "velocity", "source": "block"}}, inputs={}, blow="shaker")
    given = started(benches.built(small_rig.model(), section), recorded(shown, section), section)["a"].unknown
    assert (given.impulse > 0) == (max(first, second) > 0)
    assert given.time == pytest.approx(TIME, abs=2.5 / RATE)


def test_blows_of_a_linear_rig_leave_nothing_missing():
    """Contact times of 1 to 6 samples and a third of a period; the held-out run is fitted to its first quarter."""
    strokes = {"a": (0.9, 0.2031, 0.015), "b": (-1.6, 0.15, 0.06), "c": (0.4, 0.31, 0.1), "last": (1.2, 0.171, 0.08)}
    whole = problem({name: ringing(*stroke, duration=5.0) for name, stroke in strokes.items()}, blow="shaker",
                    weighed=["cubic_stiffness", "coulomb"])
    solved = whole.solved()
    assert solved.decision.verdict == "parameters", solved.decision.reasons
    values, spread = solved.completed.values, solved.completed.spread(solved.weights)
    for name, stroke in list(strokes.items())[:3]:
        for what, true in blow(name, *stroke).items():
            assert abs(values[what] - true) < 3 * spread[what], what
    assert spread["blow@b.contact time on shaker"] < 0.1 * strokes["b"][2], "the recording tells it"
    assert "last; the recalibrated nominal model predicts them to the noise" in " ".join(solved.decision.reasons)


def test_blows_that_cannot_be_found_are_refused():
    bench, runs, section = rig({"a": ringing(time=2.5)})
    with pytest.raises(ConfigError, match=r"run a: blow: expected a blow within the first .*begin shortly before"):
        started(bench, runs, section)
    with pytest.raises(ConfigError, match=r"bench.blow: expected an input that is a force.*shaker, found 'hammer'"):
        started(bench, runs, section.model_copy(update={"blow": "hammer"}))
    with pytest.raises(ConfigError, match=r"bench.blow: expected none where starts are fitted"):
        started(bench, runs, section.model_copy(update={"start": "fitted"}))
