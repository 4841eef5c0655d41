"""Where tones begin: frequency, amplitude and phase of one that stands out of what the null leaves, in closed form."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.inference.fitting.calibration import calibrate
from pipeline.inference.fitting.noise import budget
from pipeline.inference.fitting.tone_starts import Tone, modulations, standing_out, starts, tone_of
from pipeline.inference.priors import HalfNormal, LogNormal, Normal, Parameter, Uniform
from pipeline.inference.problem import Hypothesis, Observed, Problem
from tests.inference.tones import DRAG, RATE, RIPPLE, SAMPLES, TIME, TRUE, null_of

SWING = Hypothesis("swing", (("swing", "here"),), (
    Parameter("share", "1", 0.1, HalfNormal(0.2), null=0.0), Parameter("frequency", "Hz", 2.0, LogNormal(3.0, 1.5)),
    Parameter("phase", "rad", 0.0, Uniform(-np.pi, np.pi))))


def test_a_tone_has_one_size_one_frequency_and_one_phase_at_most():
    assert tone_of(RIPPLE) == Tone(0, 1, 2) and tone_of(DRAG) is None
    resonance = replace(RIPPLE, parameters=RIPPLE.parameters[:2])
    assert tone_of(resonance) == Tone(0, 1, None)
    assert tone_of(SWING) == Tone(0, 1, 2, modulates=True)


def swinging(hypothesis, values, run):
    """A carrier of 9 Hz of known level that swings, the nominal model without."""
    angle = 2 * np.pi * values.get("frequency", 1.0) * TIME - values.get("phase", 0.0)
    swing = values.get("share", 0.0) * np.cos(angle)
    return values["level"] * ((1 + swing) * np.cos(2 * np.pi * 9.0 * TIME))[None]


@pytest.mark.exact
@pytest.mark.parametrize("frequency", [1.37, 6.2, 23.4])
def test_a_modulation_begins_at_its_own_frequency_and_not_at_those_that_are_heard(frequency):
    true, random = {"level": 1.2, "share": 0.3, "frequency": frequency, "phase": 0.8}, np.random.default_rng(0)
    nominal = Hypothesis("nominal", (), (Parameter("level", "m", 1.0, Normal(1.0, 0.3)),))
    run = Observed("one", {}, ("x",), np.zeros((1, SAMPLES)), RATE, noise_std=np.array([0.02]))
    run = replace(run, samples=swinging(nominal, true, run) + 0.02 * random.standard_normal((1, SAMPLES)))
    problem = Problem((run,), swinging, nominal)
    null = calibrate(problem, tuple(budget(problem)[r.name] for r in problem.training), nominal, [nominal.nominal],
                     problem.training)
    width = RATE / SAMPLES
    assert abs(modulations(null) - frequency).min() < width / 2
    assert abs(standing_out(null) - frequency).min() > width
    found = problem.nominal.joined(SWING).values(starts(problem, null, SWING)[0])
    assert found["frequency"] == pytest.approx(frequency, abs=width / 2)
    assert found["share"] == pytest.approx(0.3, rel=0.3)


@pytest.mark.exact
def test_a_resonance_begins_at_the_peak_that_is_there():
    problem, null = null_of(TRUE | {"phase": 0.0})
    resonance = replace(RIPPLE, parameters=RIPPLE.parameters[:2])
    found = problem.nominal.joined(resonance).values(starts(problem, null, resonance)[0])
    assert found["frequency"] == pytest.approx(TRUE["frequency"], abs=0.25 * RATE / SAMPLES)
    assert 0.3 * TRUE["force"] < found["force"] < 1.2 * TRUE["force"]      # less where its phase runs away


@pytest.mark.exact
def test_peaks_stand_where_they_are_when_half_of_the_samples_are_missing():
    problem, null = null_of(TRUE)
    seen = np.random.default_rng(1).uniform(size=SAMPLES) < 0.5
    noises = tuple(replace(n, usable=n.usable & seen) for n in null.noises)
    lost = replace(null, noises=noises, residuals=tuple(r[seen] for r in null.residuals))
    assert standing_out(lost)[0] == pytest.approx(TRUE["frequency"], abs=0.25 * RATE / SAMPLES)


@pytest.mark.exact
def test_a_fit_begins_at_the_tone_that_is_there():
    problem, null = null_of(TRUE)
    assert standing_out(null)[0] == pytest.approx(TRUE["frequency"], abs=0.25 * RATE / SAMPLES)
    first = starts(problem, null, RIPPLE)[0]
    found = problem.nominal.joined(RIPPLE).values(first)
    assert found["frequency"] == pytest.approx(TRUE["frequency"], abs=0.25 * RATE / SAMPLES)
    half = SAMPLES / RATE / 2       # about the middle of the run the phase is that of the frequency found
    turned = 2 * np.pi * (found["frequency"] - TRUE["frequency"]) * half - found["phase"] + TRUE["phase"]
    assert abs((turned + np.pi) % (2 * np.pi) - np.pi) < 0.05
    assert found["force"] == pytest.approx(TRUE["force"], rel=0.15)


def test_where_nothing_sounds_or_samples_have_no_order_nothing_is_promised():
    problem, null = null_of({})
    whole = problem.nominal.joined(RIPPLE)
    assert max(whole.values(latent)["force"] for latent in starts(problem, null, RIPPLE)) < 0.05
    assert starts(problem, null, DRAG) == []
    unordered = replace(null, noises=tuple(replace(n, ordered=False) for n in null.noises))
    assert starts(problem, unordered, RIPPLE) == []


@pytest.mark.exact
def test_nominal_values_give_way_to_the_tone():
    """Beside a tone of less than two periods the constant was off; where the tone begins it is what it is."""
    slow = TRUE | {"frequency": 0.33}
    problem, null = null_of(slow)
    assert abs(null.values["level"] - 1.2) > 0.05
    whole = problem.nominal.joined(RIPPLE)
    near = min(starts(problem, null, RIPPLE), key=lambda u: abs(whole.values(u)["frequency"] - 0.33))
    assert abs(whole.values(near)["level"] - 1.2) < abs(null.values["level"] - 1.2)
