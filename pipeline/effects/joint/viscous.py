"""Friction that rises with the sliding speed: mu(v) = mu_0(v) (1 + b |v|), a lubricating film in the contact."""

import numpy as np

from pipeline.effects.effect import Effect
from pipeline.effects.friction.friction_table import times
from pipeline.inference.priors import HalfNormal, Parameter

#: speeds that the law spans, as multiples of the largest sliding speed of the drive or 1 m/s
_SPAN, _SAMPLES = 20.0, 2


def parameters(typical):
    size = 0.2 / typical.speed
    return (Parameter("slope", "s/m", size, HalfNormal(2 * size), null=0.0),)


def apply(bench, location, values):
    fastest = _SPAN * max(1.0, abs(bench.model.sliding_speed).max())
    samples = np.linspace(0, fastest, _SAMPLES)
    return bench.with_friction(location, lambda friction: times(friction, "speed", samples,
                                                             lambda speed: 1 + values["slope"] * speed))


EFFECT = Effect(
    name="viscous", summary="friction that rises with the sliding speed", location="contact", stage="friction",
    parameters=parameters, apply=apply, linear=("slope",),
    family="damping",
    source="R. Stribeck, Z. VDI 46 (1902) 1341: the branch of full film",
    valid="Valid below 20 m/s and 20 times the speed of the drive, beyond which friction stays the same.")
