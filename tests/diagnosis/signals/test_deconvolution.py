"""From residuals back to force and motion: receptances in closed form, a hidden force comes back."""

import numpy as np
import pytest

from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.runs import recorded
from pipeline.diagnosis.signals.deconvolution import FADE, deconvolved, motion, moved, receptances
from pipeline.diagnosis.signals.forward_model import observed
from pipeline.inference.fitting.noise import whitening
from tests.diagnosis import pin_rig
from tests.diagnosis.small_rig import HIDDEN, NOISE, laid_out, model, recording


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


def test_noise_alone_is_no_force():
    bench, one = benches.built(model(), laid_out()), recorded(recording(levels=(5.0,)), laid_out())["level_1"]
    seen = observed(one, {"x": NOISE})
    assert deconvolved(bench, np.ones(1), one.run, seen, whitening(seen, np.full((1, 1), NOISE**2))) is None


def test_the_motion_of_a_bench_without_sensors_of_motion_is_that_of_the_model():
    bench, one = pin_rig.bench(), recorded(pin_rig.recording((5.0,), (4e-4,), noise=0.0), pin_rig.laid_out())["run_1"]
    seen = observed(one, {"friction": pin_rig.NOISE})
    found = motion(bench, np.ones(1), one.run, seen, whitening(seen, np.full((1, 1), pin_rig.NOISE**2)))
    np.testing.assert_array_equal(found, moved(bench, one.run, np.ones(1)))
