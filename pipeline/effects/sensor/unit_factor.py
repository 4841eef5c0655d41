"""A channel in another unit than stated: it shows 10 or 1,000 times, g or degree over radian times, or their inverses.

The factor is one of these to .3 %, so that 10 and 9.80665 are told apart.
"""

import numpy as np

from pipeline.effects.attached import scaled_channel
from pipeline.effects.effect import Effect
from pipeline.inference.priors import Factors, Parameter

#: m/s^2 of standard gravity, and degrees of a radian
_GRAVITY, _DEGREES = 9.80665, 180 / np.pi
FACTORS = (1e-3, 1 / _DEGREES, 0.1, 1 / _GRAVITY, _GRAVITY, 10.0, _DEGREES, 1e3)


def parameters(typical):
    return (Parameter("factor", "1", 1e3, Factors(FACTORS, 0.003), null=1.0),)


def apply(bench, location, values):
    return scaled_channel(bench, location, values["factor"])


EFFECT = Effect(
    name="unit_factor", summary="a channel in another unit than stated", location="channel", stage="measurement",
    kind="sensor", parameters=parameters, apply=apply,
    source="Bureau International des Poids et Mesures, The International System of Units, 9th ed. (2019)",
    valid="Valid while the unit is the same in all runs.")
