"""A sharp resonance of unknown mass and damping, in closed form: its steady answer to tones, seen by one sensor."""

import numpy as np

from pipeline.inference.priors import HalfNormal, LogNormal, Normal, Parameter
from pipeline.inference.problem import Hypothesis, Observed, Problem

STIFFNESS, NOISE = 100.0, 2e-4
#: angular frequencies of the tones, rad/s, about that of a mass of 1 kg
TONES = np.linspace(6.0, 14.0, 400)
NOMINAL = Hypothesis("nominal", (), (Parameter("mass", "kg", 1.2, LogNormal(1.2, 0.2)),
                                     Parameter("damping", "N s/m", 0.35, LogNormal(0.35, 0.2))))
CATALOGUE = (
    Hypothesis("gain", (("gain", "x"),), (Parameter("gain", "1", 0.0, Normal(0.0, 0.2), 0.0),), "sensor"),
    Hypothesis("stiffness", (("stiffness", "mount"),),
               (Parameter("added_stiffness", "N/m", 10.0, HalfNormal(40.0), 0.0),)))


def predict(hypothesis, values, run):
    """Real and imaginary parts (2, n) of displacement per newton."""
    answer = (1 + values.get("gain", 0.0)) / (STIFFNESS + values.get("added_stiffness", 0.0)
                                              - values["mass"] * TONES**2 + 1j * values["damping"] * TONES)
    return np.array([answer.real, answer.imag])[:, :run.samples.shape[1]]


def problem(gain=1.0, seed=1):
    """Problem of a mass of 1 kg and a damper of 0.4 N s/m, seen with a gain."""
    clean = gain * predict(None, {"mass": 1.0, "damping": 0.4}, Observed("", {}, ("re", "im"), np.zeros((2, 400))))
    samples = clean + NOISE * np.random.default_rng(seed).standard_normal(clean.shape)
    return Problem((Observed("a", {}, ("re", "im"), samples, 1.0, noise_std=np.full(2, NOISE)),), predict, NOMINAL)
