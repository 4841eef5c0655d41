"""Friction of a contact that rises with the logarithm of the sliding speed: mu(v) = mu_0(v) (1 + a ln(v / v_0)).

    ln(v / v_0) -> arcsinh(v / (2 v_c)) - arcsinh(v_0 / (2 v_c)), which ends near rest, below the speed v_c

v_0 is a typical speed of the recordings, at which friction is what it was. The direct effect of rate-and-state
friction without a state.
"""

from functools import partial

import numpy as np

from pipeline.effects.effect import Effect
from pipeline.effects.friction.friction_table import times
from pipeline.inference.priors import HalfNormal, LogNormal, Parameter

#: samples of the logarithm, over so many cut-off speeds
_SAMPLES, _SPAN = 600, 1e6


def parameters(typical):
    least = 1e-3 * typical.speed
    return (Parameter("slope", "1", 0.02, HalfNormal(0.1), null=0.0),
            Parameter("reference_speed", "m/s", typical.speed, LogNormal(typical.speed, 0.1)),
            Parameter("cutoff_speed", "m/s", least, LogNormal(least, 1.5)))


def apply(bench, location, values):
    samples = np.concatenate(([0.0], values["cutoff_speed"] * np.geomspace(1e-2, _SPAN, _SAMPLES)))
    return bench.with_friction(location, lambda friction: times(friction, "speed", samples, partial(_factor, values)))


def _factor(values, speed):
    slow, reference = 2 * values["cutoff_speed"], values["reference_speed"]
    return np.maximum(1 + values["slope"] * (np.arcsinh(speed / slow) - np.arcsinh(reference / slow)), 0.0)


EFFECT = Effect(
    name="velocity_strengthening", summary="contact friction that rises with the logarithm of the speed",
    location="contact", stage="friction", parameters=parameters, apply=apply, linear=("slope",),
    source="F. P. Bowden, D. Tabor, The Friction and Lubrication of Solids II (1964): thermally activated shear; J. R."
           " Rice, N. Lapusta, K. Ranjith, J. Mech. Phys. Solids 49 (2001) 1865: regularised",
    valid="Valid while the contact forgets within less way than the motion shows.")
