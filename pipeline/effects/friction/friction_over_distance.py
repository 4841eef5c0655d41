"""Friction that changes over the sliding distance: mu(s) = mu_0 (1 + r exp(-s / d)), s since the run began.

Bedding in: r < 0 starts low, r > 0 high; after some d friction is what it was.
"""

import numpy as np

from pipeline.effects.effect import Effect
from pipeline.effects.friction.friction_table import times
from pipeline.inference.priors import LogNormal, Parameter, Uniform
from pipeline.physics.friction.state_variables import Distance

#: samples of the exponential, over this many decay distances: within 2e-4 of the rise
_SAMPLES, _SPAN = 601, 20.0


def parameters(typical):
    size = 0.5 * typical.speed * typical.time
    return (Parameter("rise", "1", 0.2, Uniform(-0.9, 0.9), null=0.0),
            Parameter("distance", "m", size, LogNormal(size, 1.0)))


def apply(bench, location, values):
    if values["rise"] == 0:
        return bench
    samples = values["distance"] * _SPAN * np.linspace(0, 1, _SAMPLES) ** 2

    def factor(distance):
        return 1 + values["rise"] * np.exp(-distance / values["distance"])

    return bench.with_friction(location, lambda friction: _slid(times(friction, "distance", samples, factor)))


def _slid(friction):
    return friction if Distance() in friction.states else friction.with_state(Distance())


EFFECT = Effect(
    name="friction_over_distance", summary="friction that changes over the sliding distance", location="contact",
    stage="friction", parameters=parameters, apply=apply, linear=("rise",),
    source="A. J. Day, Braking of Road Vehicles (2014), chapter 2: bedding-in of friction pairs",
    valid="Valid while what the surfaces went through before the run is the same; roots take friction where it begins.")
