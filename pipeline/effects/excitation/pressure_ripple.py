"""Pressure ripple: an input presses by F_0 cos(2 pi f t - phase) more than its record says, as behind a pump.

The frequency is its own, whatever the drive does; a ripple that follows the angle of the drive is thickness_variation.
"""

import numpy as np

from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, LogNormal, Parameter, Uniform
from pipeline.physics.time_stepping.elements import Element, Wave


def parameters(typical):
    size, frequency = 0.05 * typical.force, 1 / (2 * np.pi * typical.period)
    return (Parameter("force", "N", size, HalfNormal(2 * size), null=0.0),
            Parameter("frequency", "Hz", frequency, LogNormal(frequency, 1.0)),
            Parameter("phase", "rad", 0.0, Uniform(-np.pi, np.pi)))


def apply(bench, location, values):
    row, _, _ = bench.input(location)
    law = Wave(1.0, 0.0, values["force"], 0.0, values["frequency"], values["phase"])
    return bench.with_elements(Element(f"pressure_ripple {location}", row, law))


EFFECT = Effect(
    name="pressure_ripple", summary="an input that ripples at a frequency of its own", location="input",
    stage="excitation", parameters=parameters, apply=apply, small=False, linear=("force",),
    source="K. A. Edge, D. N. Johnston, Proc. IMechE A 204 (1990) 33: pressure ripple of pumps",
    valid="Valid while the ripple is one tone that goes through the begin of each run with the same phase.")
