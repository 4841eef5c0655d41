"""Friction scatter around the disc: mu (1 + a cos(n (theta - theta_i) - phase)), locked to the angle of the drive.

theta_i is the angle at which contact i sits. Unlike runout it needs sliding, and turns with the sign of friction.
"""

import numpy as np

from pipeline.effects.effect import Effect
from pipeline.inference.priors import Parameter, Uniform
from pipeline.physics.friction.state_variables import Scatter


def parameters(typical):
    return (Parameter("amplitude", "1", 0.1, Uniform(0.0, 0.9), null=0.0),
            Parameter("order", "1", 1.0, Uniform(0.5, 8.5)), Parameter("phase", "rad", 0.0, Uniform(-np.pi, np.pi)))


def apply(bench, location, values):
    if values["amplitude"] == 0:
        return bench
    x, y = bench.model.contacts.position[:, :2].T
    state = Scatter(values["amplitude"], values["order"], values["order"] * np.arctan2(y, x) + values["phase"])
    return bench.with_friction(location, lambda friction: friction.with_state(state))


EFFECT = Effect(
    name="friction_scatter", summary="friction that varies around the disc", location="contact", stage="friction",
    parameters=parameters, apply=apply, small=False, linear=("amplitude",),
    source="H. Jacobsson, Proc. IMechE D 217 (2003) 419: order-locked excitation; here of the coefficient",
    valid="Valid while contacts are short against the variation; roots take its mean, which is none.")
