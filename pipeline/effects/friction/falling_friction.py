"""Friction that falls with the sliding speed: mu(v) = mu_0(v) (1 + r exp(-|v| / v_s)).

r = 0.2 is 20 % more friction at rest than at speed. The negative slope -r mu_0 / v_s drives vibration.
"""

import numpy as np

from pipeline.effects.effect import Effect
from pipeline.effects.friction.friction_table import times
from pipeline.inference.priors import HalfNormal, LogNormal, Parameter

#: samples of the exponential, over this many decay speeds: within 2e-4 of the rise
_SAMPLES, _SPAN = 601, 20.0


def parameters(typical):
    return (Parameter("rise", "1", 0.2, HalfNormal(0.5), null=0.0),
            Parameter("decay_speed", "m/s", typical.speed, LogNormal(typical.speed, 1.0)))


def apply(bench, location, values):
    samples = values["decay_speed"] * _SPAN * np.linspace(0, 1, _SAMPLES) ** 2

    def factor(speed):
        return 1 + values["rise"] * np.exp(-speed / values["decay_speed"])

    return bench.with_friction(location, lambda friction: times(friction, "speed", samples, factor))


EFFECT = Effect(
    name="falling_friction", summary="friction that falls as sliding gets faster", location="contact", stage="friction",
    parameters=parameters, apply=apply, linear=("rise",),
    source="L. C. Bo, D. Pavelescu, Wear 82 (1982) 277, with exponent 1; R. Stribeck, Z. VDI 46 (1902) 1341",
    valid="Valid while pressure, temperature and wear do not change friction as fast as speed does.")
