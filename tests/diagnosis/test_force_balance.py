"""The question of measured motions: named without any simulation of the runs."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.effect_block import with_effects
from pipeline.case_models.runs import recorded
from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from pipeline.diagnosis.force_balance import force_balance_problem
from pipeline.diagnosis.settings import Settings
from pipeline.diagnosis.signals.forward_model import completed
from pipeline.inference import long_records
from pipeline.inference.search.score_screen import directions
from pipeline.physics.time_stepping.simulate import Start
from pipeline.physics.virtual_rig.response import Run, respond
from stages.lumped import Settings as LumpedSettings
from stages.lumped import lumped
from stages.reduced_model import Settings as ReductionSettings
from stages.reduced_model import reduced_model
from tests.case_models.test_force_balance import BALANCED
from tests.diagnosis.small_rig import HIDDEN, LUMPED, RATE, SAMPLES, effects, laid_out, model, recording

ASKED = {"parameters": {"joints.mount.stiffness": {"spread": 0.1}, "joints.mount.damping": {"spread": 0.3}},
         "held_out": ["level_4"], "noise": {"std": {"force on block": "0.2 N"}},
         "effects": ["cubic_stiffness", "coulomb", "quadratic_damping", "moving_base"]}


def asked(hidden=None, **more):
    settings = laid_out(**BALANCED)
    return force_balance_problem(benches.built(model(), settings), recorded(recording(hidden, noise=1e-5), settings),
                    fill(Settings, {**ASKED, **more}, "diagnosis"), settings.equation)


def test_cubic_stiffness_is_named_with_its_value():
    given = asked(HIDDEN)
    found = given.solved()
    assert found.decision.verdict == "missing" and found.named[0].candidate.effects == (("cubic_stiffness", "mount"),)
    assert found.named[0].fit.values["cubic_stiffness@mount.coefficient"] == pytest.approx(15000.0, rel=0.02)
    base, = (c for c in given.candidates if c.name == "moving_base at mount")
    assert "give all 2 coordinates" in directions(given.problem, found.null, base).failure, "it is not measured"


def test_long_records_are_diagnosed_on_their_beginnings(monkeypatch):
    given = asked(HIDDEN, effects=["cubic_stiffness", "coulomb"])
    for name, value in (("MANY", 270), ("_FEWEST", 90), ("_LIVELY", 0.0)):
        monkeypatch.setattr(long_records, name, value)
    found = given.solved()
    assert [c.name for c in found.decision.named] == ["cubic_stiffness at mount"]
    assert [run.samples.shape for run in found.null.runs] == [run.samples.shape for run in given.problem.training]


def decays(force_noise):
    """Free decays under Coulomb friction of 1 N, beside a force channel that shows noise alone (N)."""
    whole = with_effects(benches.built(model(), laid_out()), effects({"coulomb": {"mount": {"force": "1 N"}}}))
    given, random = recording(levels=(1.0, 2.0, 3.0)), np.random.default_rng(3)
    for name, amplitude in (("level_1", 0.1), ("level_2", 0.05), ("level_3", 0.2)):
        run = Run(name, (SAMPLES - 1) / RATE, RATE, start=Start(np.array([amplitude]), np.zeros(1)))
        channels = given.runs[name].channels
        shown = {"x": respond(whole, run)["x"] + 1e-4 * random.standard_normal(SAMPLES),
                 "force": force_noise * random.standard_normal(SAMPLES)}
        given.runs[name] = replace(given.runs[name], channels={
            key: replace(channel, samples=shown[key]) for key, channel in channels.items()})
    return given


def asked_of(given):
    settings = laid_out(**BALANCED)
    section = {**ASKED, "held_out": ["level_3"], "noise": {"std": {"force on block": "0.05 N"}},
               "effects": ["cubic_stiffness", "quadratic_damping", "sensor_gain"]}
    return force_balance_problem(benches.built(model(), settings), recorded(given, settings),
                                 fill(Settings, section, "diagnosis"), settings.equation)


@pytest.mark.parametrize("force_noise", [0.0, 2e-3])
def test_a_free_decay_is_refused_before_anything_is_fitted(force_noise):
    with pytest.raises(ConfigError, match="run level_1: .*a run with an applied force, found at most 0.* N.*"
                                          "bench.forward: simulation, where bench.start: fitted"):
        asked_of(decays(force_noise))


def test_no_gain_explains_a_decay_by_making_it_small():
    """The gain at the end of its prior once had a posterior of 1.000 here: it took half of what was left."""
    found = asked_of(decays(force_noise=0.1)).solved()
    gain, = (w for w in found.weighed if "sensor_gain" in w.candidate.name)
    assert found.decision.verdict != "sensor" and gain.statistics.posterior < 0.5
    assert gain.fit.objective > 0.97 * found.null.objective, "it takes the noise of the force channel at most"


def test_a_gain_beside_free_masses_is_told_and_not_weighed():
    spreads = {name: {"spread": 0.3} for name in ("masses.block", "joints.mount.stiffness", "joints.mount.damping")}
    found = asked(HIDDEN, parameters=spreads, effects=["coulomb", "sensor_gain", "unit_factor"]).solved()
    assert {"sensor_gain at x", "unit_factor at x"} <= set(found.failures)
    assert "a gain of x cannot be told from the masses" in found.failures["sensor_gain at x"]
    assert found.decision.verdict != "sensor" and not any(w.candidate.kind == "sensor" for w in found.weighed)


def test_places_that_are_one_coordinate_are_one_place_and_no_tie():
    wall = {"between": ["block.x", "ground"], "damping": "0.1 N s/m"}
    rig = {**LUMPED, "springs": {**LUMPED["springs"], "wall": wall}}
    rubbing = reduced_model(lumped(settings=fill(LumpedSettings, rig, "lumped")), settings=ReductionSettings())
    settings = laid_out(**BALANCED)
    section = {**ASKED, "effects": ["cubic_stiffness", "coulomb"]}
    found = force_balance_problem(benches.built(rubbing, settings), recorded(recording(HIDDEN, noise=1e-5), settings),
                                  fill(Settings, section, "diagnosis"), settings.equation).solved()
    assert found.decision.verdict == "missing" and found.named[0].candidate.effects[0][0] == "cubic_stiffness"
    assert found.decision.named[0].posterior == pytest.approx(1.0)
    assert any("is the same coordinate: one place with two names" in why for why in found.decision.reasons)


def test_a_gain_beside_known_masses_is_named():
    given = recording(noise=1e-5)
    for run in given.runs.values():
        run.channels["x"] = replace(run.channels["x"], samples=1.2 * run.channels["x"].samples)
    settings = laid_out(**BALANCED)
    section = {**ASKED, "effects": ["cubic_stiffness", "coulomb", "sensor_gain"]}
    found = force_balance_problem(benches.built(model(), settings), recorded(given, settings),
                                  fill(Settings, section, "diagnosis"), settings.equation).solved()
    assert found.decision.verdict == "sensor"
    assert found.named[0].fit.values["sensor_gain@x.error"] == pytest.approx(0.2, abs=0.01)


def test_errors_that_are_told_are_those_of_the_balance_alone():
    """Noise stands in for what friction at rest takes off it in fits only: stage bench shows the same error."""
    given = asked(HIDDEN, effects=["coulomb"])
    hypothesis, (run, *_) = given.problem.nominal.joined(given.candidates[0]), given.problem.runs
    values = hypothesis.values(np.full(len(hypothesis.parameters), 1.5))
    fitted, told = (predict(hypothesis, values, run) for predict in (given.problem.predict, given.problem.shown))
    balance = given.problem.predict.balances[run.name]
    bench = completed(given.problem.predict.bench, hypothesis, values)
    np.testing.assert_array_equal(told, replace(balance, noise=0.0).predicted(bench))
    assert (fitted != told).any() and (fitted == told).any()


def test_the_noise_is_that_of_the_forces():
    found = asked()
    assert found.units == {"force on block": "N"} and found.budget["level_1"].std == pytest.approx([0.2])
    with pytest.raises(ConfigError, match="noise.std"):
        asked(noise={"std": {"x": "0.2 mm"}})


def test_the_place_and_the_size_of_the_missing_force_are_told():
    given = asked(HIDDEN)
    found = given.solved()
    axes = given.locator.located(found)
    assert axes["place"][0].significant() == ("block",) and {"stage", "run", "band"} <= set(axes)
    told = given.latent.described(found, axes)
    assert told.location == "block" and {"amplitude", "velocity", "time"} <= set(told.regimes)
    follows = {f.name: f.p_value for f, _ in told.follows}
    assert follows["displacement"] <= 0.01, "a cubic spring follows the displacement"


def test_where_nothing_is_missing_no_place_is_told_and_no_force():
    given = asked(effects=["cubic_stiffness", "coulomb"])
    found = given.solved()
    axes = given.locator.located(found)
    assert not axes["place"][0].significant() and given.latent.described(found, axes) is None
