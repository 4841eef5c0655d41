"""Tones in what a fit leaves: told with frequency and channel, seldom by chance whatever the colour of the noise."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import scipy

from pipeline.inference.decision.steady_tones import steady_tones, told
from tests.inference.tones import RATE, SAMPLES, TIME, TRUE, null_of


def left(seed, colour=0.0, hum=0.0, channels=("a", "b"), samples=600, rate=200.0):
    """What three runs leave: noise whose neighbours have this correlation, and hum at 31.4 Hz and its triple in b."""
    random, time, runs, noises, residuals = np.random.default_rng(seed), np.arange(samples) / rate, [], [], []
    for k in range(3):
        noise = scipy.signal.lfilter([np.sqrt(1 - colour**2)], [1, -colour],
                                     random.standard_normal((len(channels), samples)))
        phase = random.uniform(0, 2 * np.pi)
        noise[-1] += hum * sum(a * np.sin(2 * np.pi * m * 31.4 * time + phase) for m, a in ((1, 1.0), (3, 0.6)))
        runs.append(SimpleNamespace(name=f"run_{k}", rate=rate, channels=channels, samples=noise))
        noises.append(SimpleNamespace(ordered=True, over_time=lambda white, shape=noise.shape: white.reshape(shape)))
        residuals.append(noise.ravel())
    return SimpleNamespace(runs=tuple(runs), noises=tuple(noises), residuals=tuple(residuals))


@pytest.mark.parametrize("colour", [0.0, 0.8])
def test_noise_of_any_colour_holds_no_tone(colour):
    """Of 150 fits one has a line where the level were right; three at most (Poisson, .1 % beyond)."""
    assert sum(bool(steady_tones(left(seed, colour))) for seed in range(150)) <= 3


@pytest.mark.parametrize("colour", [0.0, 0.8])
def test_hum_is_told_with_its_multiple_and_its_channel(colour):
    found = sorted(steady_tones(left(7, colour, hum=0.5)))
    assert [t.frequency for t in found] == pytest.approx([31.4, 94.2], abs=200 / 600 / 2)
    assert {t.channels for t in found} == {("b",)} and min(t.level for t in found) > 5
    sentence = told(left(7, colour, hum=0.5))
    assert sentence.startswith("a steady tone at 31.") and "(3 times that)" in sentence and "left in b:" in sentence


def test_a_resonance_that_decays_is_no_tone():
    """Broad against the resolution: a tenth of critical damping in records of a hundred periods."""
    pole = np.exp((-0.1 + 1j) * 2 * np.pi * 31.4 / 200)
    random = np.random.default_rng(3)
    fit = left(3)
    for run in fit.runs:
        force = random.standard_normal((2, 600))
        run.samples[:] = scipy.signal.lfilter([1.0], np.poly([pole, pole.conj()]).real, force)
    assert steady_tones(fit) == []


def test_the_tone_of_a_fitted_problem_is_told_and_its_absence_as_well():
    _, with_tone = null_of(TRUE)
    assert steady_tones(with_tone)[0].frequency == pytest.approx(TRUE["frequency"], abs=0.5 * RATE / SAMPLES)
    assert f"{TIME[-1]:.0f}" == "5" and told(null_of({})[1]) == ""


def test_features_have_no_tones():
    fit = left(1, hum=1.0)
    unordered = SimpleNamespace(runs=fit.runs, residuals=fit.residuals,
                                noises=tuple(SimpleNamespace(**vars(n) | {"ordered": False}) for n in fit.noises))
    assert steady_tones(unordered) == [] and told(unordered) == ""
    _, null = null_of(TRUE)
    assert told(replace(null, noises=tuple(replace(n, ordered=False) for n in null.noises))) == ""
