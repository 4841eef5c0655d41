"""Balances of forces: a motion that the model makes needs the force that made it."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.corrections import corrected
from pipeline.case_models.effect_block import with_effects
from pipeline.case_models.force_balance import balance, channel_names, measured_start
from pipeline.case_models.runs import Recorded, recorded
from pipeline.contract import ConfigError
from pipeline.physics.virtual_rig.response import Run
from tests.diagnosis.small_rig import HIDDEN, effects, laid_out, model, recording

BALANCED = {"forward": "equation", "equation": {"corner": "20 Hz", "decimation": 4, "trim": 60}}


def rig(hidden=None, **more):
    """(Bench, {name: Recorded}, section) of noiseless recordings made with ``hidden`` effects."""
    settings = laid_out(**BALANCED, **more)
    return benches.built(model(), settings), recorded(recording(hidden, noise=0.0), settings), settings


def test_the_true_model_needs_the_force_that_was_applied():
    bench, runs, settings = rig(HIDDEN)
    one = balance(bench, runs["level_2"], settings.equation)
    nominal, complete = (one.predicted(b) for b in (bench, with_effects(bench, effects(HIDDEN))))
    size = one.seen.samples.std()
    assert (complete - one.seen.samples).std() < 0.03 * size, "central differences at the third harmonic of 4 Hz: 1.2 %"
    assert (nominal - one.seen.samples).std() > 0.1 * size


def test_channels_are_forces_at_the_lower_rate():
    bench, runs, settings = rig()
    seen = balance(bench, runs["level_1"], settings.equation).seen
    assert seen.channels == channel_names(bench) == ("force on block",) and seen.unit == ("N",)
    assert seen.run.sample_rate == 50.0 and seen.samples.shape == (1, (1200 - 120) // 4) == seen.valid.shape


@pytest.mark.exact
def test_no_gain_closes_the_balance_by_making_the_motion_small():
    """Of a free linear motion what is left does not depend on the gain, and under a force it grows with its error."""
    bench, runs, settings = rig(HIDDEN)
    one = balance(bench, runs["level_2"], settings.equation)
    idle = replace(one, run=replace(one.run, inputs={}), seen=replace(one.seen, samples=0 * one.seen.samples))
    still, twice, large = (idle.predicted(corrected(bench, {"channels.x.gain": gain})) for gain in (1.0, 2.0, 1e3))
    np.testing.assert_allclose(twice, still, rtol=1e-9, atol=1e-9 * abs(still).max())
    np.testing.assert_allclose(large, still, rtol=1e-9, atol=1e-9 * abs(still).max())
    errors = [(one.predicted(corrected(bench, {"channels.x.gain": gain})) - one.seen.samples).std()
              for gain in (1.0, 2.0, 1e3)]
    assert errors[0] < errors[1] < errors[2]


@pytest.mark.exact
def test_no_factor_on_all_terms_makes_what_is_left_less():
    """A gain of .1 beside masses, dampings and stiffnesses of a tenth once left a tenth of what was missing."""
    bench, runs, settings = rig(HIDDEN)
    one = balance(bench, runs["level_2"], settings.equation)
    tenth = {"masses.block": 0.1, "joints.mount.stiffness": 40.0, "joints.mount.damping": 0.12}

    def left(values):
        return one.predicted(corrected(bench, values)) - one.seen.samples

    np.testing.assert_allclose(left(tenth | {"channels.x.gain": 0.1}), left({}), atol=1e-9)
    np.testing.assert_allclose(left(tenth | {"inputs.shaker.gain": 0.1}), left({}), atol=1e-9)


def sticking(force=0.036, torque=0.05, inertia=2e-4, rate=250.0, count=1500):
    """(angle, torque) of a shaft under Coulomb friction that a slow torque turns to and fro: it rests a third of the
    time, exactly, and its angle is read in steps of 2 mrad."""
    steps, angle, speed = 80, np.empty(count), 0.0
    time = np.arange(count * steps) / (rate * steps)
    drive, place = torque * np.sin(np.pi * time), 0.0
    for k, applied in enumerate(drive):
        if k % steps == 0:
            angle[k // steps] = place
        free = speed + applied / inertia * time[1]
        speed = np.sign(free) * max(abs(free) - force / inertia * time[1], 0.0)
        place += speed * time[1]
    return 2e-3 * np.round(angle / 2e-3), drive[::steps]


def test_at_rest_only_what_exceeds_the_friction_is_left():
    """The sign of a rate that is noise once made this friction err by up to twice itself wherever the shaft rested."""
    angle, torque = sticking()
    bench = benches.built(model(), laid_out(**BALANCED, corrections={
        "masses.block": "0.2 g", "joints.mount.stiffness": "0 N/m", "joints.mount.damping": "0 N s/m"}))
    run = Run("slow", (len(angle) - 1) / 250.0, 250.0, {"shaker": torque})
    one = balance(bench, Recorded(run, ("x",), ("m",), angle[None], np.ones((1, len(angle)), bool), ""),
                  laid_out(**BALANCED).equation)
    rubbing = with_effects(bench, effects({"coulomb": {"mount": {"force": "36 mN"}}}))
    left = one.predicted(rubbing) - one.seen.samples
    as_sign = replace(one, rate_doubt=None).predicted(rubbing) - one.seen.samples
    assert left.std() < 0.04 * 0.036 and as_sign.std() > 0.3 * 0.036
    noisy = replace(one, noise=2e-3).predicted(rubbing) - one.seen.samples
    resting = abs(left[0]) < 1e-12
    assert 0.2 < resting.mean() < 0.5 and noisy[0, resting].std() == pytest.approx(2e-3, rel=0.2), "noise stays noise"


def test_a_run_without_a_force_is_refused_with_the_form_that_fits():
    bench, runs, settings = rig()
    one = runs["level_1"]
    free = replace(one, run=replace(one.run, inputs={}))
    with pytest.raises(ConfigError, match=r"run level_1: .*a run with an applied force, found at most 0 N.*"
                                          r"bench.forward: simulation, where bench.start: fitted"):
        balance(bench, free, settings.equation)


def test_a_run_may_start_where_it_was():
    bench, runs, _ = rig()
    one = runs["level_1"]
    later = replace(one, run=replace(one.run, duration=1.0), samples=one.samples[:, 300:501],
                    valid=one.valid[:, 300:501])
    start = measured_start(bench, later)
    assert start.displacement == pytest.approx(one.samples[:, 300], abs=1e-3 * one.samples.std())
    assert start.velocity == pytest.approx(np.gradient(one.samples[0], 1 / 200)[300:301], rel=0.05), \
        "(w T)^2 / 10 with T = 30 ms"


def test_gaps_and_short_runs_are_refused():
    bench, runs, settings = rig()
    one = runs["level_1"]
    valid = one.valid.copy()
    valid[0, 7] = False
    with pytest.raises(ConfigError, match="missing samples"):
        balance(bench, replace(one, valid=valid), settings.equation)
    with pytest.raises(ConfigError, match="trim"):
        balance(bench, one, settings.equation.model_copy(update={"trim": 599}))
