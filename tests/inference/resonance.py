"""An oscillator of unknown mass and damping, in closed form: its ring-down after a known blow, seen by one sensor."""

import numpy as np

from pipeline.inference.priors import Factors, HalfNormal, LogNormal, Normal, Parameter
from pipeline.inference.problem import Hypothesis, Observed, Problem

STIFFNESS, NOISE = 100.0, 1e-3
#: s; 64 periods of a mass of 1 kg
TIME = np.arange(1000) / 25.0
NOMINAL = Hypothesis("nominal", (), (Parameter("mass", "kg", 1.2, LogNormal(1.2, 0.2)),
                                     Parameter("damping", "N s/m", 0.06, LogNormal(0.06, 0.2))))
CATALOGUE = (
    Hypothesis("gain", (("gain", "x"),), (Parameter("gain", "1", 0.0, Normal(0.0, 0.2), 0.0),), "sensor"),
    Hypothesis("stiffness", (("stiffness", "mount"),),
               (Parameter("added_stiffness", "N/m", 10.0, HalfNormal(40.0), 0.0),)))


#: a channel whose sign is wrong
SIGN = Hypothesis("sign", (("sign", "x"),), (Parameter("sign", "1", -1.0, Factors((-1.0,), 0.02), 1.0),), "sensor")


def predict(hypothesis, values, run):
    """Displacement (1, n) in m after a blow of 1 N s."""
    decay = values["damping"] / (2 * values["mass"])
    angular = np.sqrt((STIFFNESS + values.get("added_stiffness", 0.0)) / values["mass"] - decay**2)
    free = np.exp(-decay * TIME) * np.sin(angular * TIME) / (values["mass"] * angular)
    return values.get("sign", 1.0) * (1 + values.get("gain", 0.0)) * free[None, :run.samples.shape[1]]


def problem(gain=1.0, mass=1.0, seed=1):
    """Problem of a ``mass`` in kg and a damper of 0.05 N s/m, seen with a gain."""
    clean = gain * predict(None, {"mass": mass, "damping": 0.05}, Observed("", {}, ("x",), np.zeros((1, len(TIME)))))
    samples = clean + NOISE * np.random.default_rng(seed).standard_normal(clean.shape)
    return Problem((Observed("a", {}, ("x",), samples, 25.0, noise_std=np.full(1, NOISE)),), predict, NOMINAL)
