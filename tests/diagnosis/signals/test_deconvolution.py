"""From residuals back to force and motion: receptances in closed form, a hidden force comes back."""

import numpy as np
import pytest

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.effect_block import with_effects
from pipeline.case_models.runs import recorded
from pipeline.diagnosis.signals.deconvolution import FADE, deconvolved, motion, moved, receptances
from pipeline.diagnosis.signals.forward_model import observed
from pipeline.inference.fitting.noise import whitening
from pipeline.inference.problem import Observed
from pipeline.physics.virtual_rig.response import respond
from tests.diagnosis import pin_rig
from tests.diagnosis.small_rig import FINE, HIDDEN, NOISE, effects, laid_out, model, recording


def test_the_receptance_of_one_mass():
    """1 / (k - m w^2 + i w c)."""
    bench, one = benches.built(model(), laid_out()), recorded(recording(levels=(2.0,)), laid_out())["level_1"]
    frequency = np.array([0.0, 2.0, 5.0])
    own, shown = receptances(bench, one.run, np.ones(1), ("x",), frequency)
    omega = 2 * np.pi * np.array([0.002, 2.0, 5.0])
    np.testing.assert_allclose(own, 1 / (400.0 - omega**2 + 1.2j * omega), rtol=1e-9)
    np.testing.assert_allclose(shown[0], own, rtol=1e-9)


def test_the_motion_of_the_truth_comes_back():
    """The model moves by half the way elsewhere; corrected, within 2 %."""
    bench, one = benches.built(model(), laid_out()), recorded(recording(HIDDEN, levels=(5.0,)), laid_out())["level_1"]
    seen = observed(one, {"x": NOISE})
    found = deconvolved(bench, np.ones(1), one.run, seen, whitening(seen, np.full((1, 1), NOISE**2)))
    kept = slice(int(FADE * one.run.samples), -int(FADE * one.run.samples))
    truth = one.samples[0]
    error = np.std((found.displacement - truth)[kept]) / np.std(truth)
    assert error < 0.02 < 0.5 < np.std(moved(bench, one.run, np.ones(1))[0] - truth) / np.std(truth)
    assert found.velocity[kept] == pytest.approx(np.gradient(found.displacement, one.run.time)[kept], abs=0.05)


def test_what_an_accelerometer_hardly_shows_is_no_giant_force():
    """Constant and slow forces: noise over next to nothing was 1e14 times the force that is hidden."""
    channels = {"x": {"quantity": "acceleration", "source": "block"}}
    bench, finely = (benches.built(model(), laid_out(channels=channels, step=step)) for step in ("2.5 ms", FINE))
    run = recorded(recording(HIDDEN, levels=(5.0,)), laid_out())["level_1"].run
    shown = {name: respond(with_effects(finely, effects(hidden)), run)["x"]
             for name, hidden in (("truth", HIDDEN), ("nominal", {}))}
    noise = 0.05 * shown["truth"].std()
    samples = shown["truth"] + noise * np.random.default_rng(3).standard_normal(run.samples)
    seen = Observed("level_1", {}, ("x",), samples[None], run.sample_rate, noise_std=np.array([noise]))
    found = deconvolved(bench, np.ones(1), run, seen, whitening(seen, np.full((1, 1), noise**2)))
    force = -1.5e4 * respond(with_effects(benches.built(model(), laid_out(step=FINE)), effects(HIDDEN)), run)["x"]**3
    kept = slice(int(FADE * run.samples), -int(FADE * run.samples))
    assert np.std((found.force - force)[kept]) < 0.4 * np.std(force[kept])


def test_noise_alone_is_no_force():
    bench, one = benches.built(model(), laid_out()), recorded(recording(levels=(5.0,)), laid_out())["level_1"]
    seen = observed(one, {"x": NOISE})
    assert deconvolved(bench, np.ones(1), one.run, seen, whitening(seen, np.full((1, 1), NOISE**2))) is None


def test_the_motion_of_a_bench_without_sensors_of_motion_is_that_of_the_model():
    bench, one = pin_rig.bench(), recorded(pin_rig.recording((5.0,), (4e-4,), noise=0.0), pin_rig.laid_out())["run_1"]
    seen = observed(one, {"friction": pin_rig.NOISE})
    found = motion(bench, np.ones(1), one.run, seen, whitening(seen, np.full((1, 1), pin_rig.NOISE**2)))
    np.testing.assert_array_equal(found, moved(bench, one.run, np.ones(1)))
