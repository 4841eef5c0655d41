"""A base that is shaken: the far end of a joint moves by u = a cos(2 pi f t - phase), F = -(k u + c u')."""

import numpy as np

from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, LogNormal, Parameter, Uniform
from pipeline.physics.time_stepping.elements import Element, Wave


def parameters(typical):
    size, frequency = 0.1 * typical.length, 1 / (2 * np.pi * typical.period)
    return (Parameter("amplitude", "m", size, HalfNormal(2 * size), null=0.0),
            Parameter("frequency", "Hz", frequency, LogNormal(frequency, 1.0)),
            Parameter("phase", "rad", 0.0, Uniform(-np.pi, np.pi)))


def apply(bench, location, values):
    row, stiffness, damping = bench.joint(location)
    law = Wave(stiffness, damping, values["amplitude"], 0.0, values["frequency"], values["phase"])
    return bench.with_elements(Element(f"base_shake {location}", row, law))


EFFECT = Effect(
    name="base_shake", summary="a floor or drive that shakes the far end of a joint", location="joint",
    stage="excitation", parameters=parameters, apply=apply, small=False, linear=("amplitude",),
    source="J. P. Den Hartog, Mechanical Vibrations (1934): motion of the support",
    valid="Valid while the shaking is one tone that the structure does not act back on.")
