"""Runout: the surface under the contacts rises and falls with the angle of the drive, whatever the load.

    gap_i + a cos(n (theta - theta_i) - phase)

theta_i is the angle at which contact i sits, n the order (1: a tilted disc). Of a disc between two pads the far face
has the opposite phase: one entry for each pad.
"""

import numpy as np

from pipeline.effects.contact.contact_surface import with_wave
from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, Parameter, Uniform


def parameters(typical):
    size = 0.1 * typical.length
    return (Parameter("amplitude", "m", size, HalfNormal(2 * size), null=0.0),
            Parameter("order", "1", 1.0, Uniform(0.5, 8.5)), Parameter("phase", "rad", 0.0, Uniform(-np.pi, np.pi)))


def apply(bench, location, values):
    return with_wave(bench, location, values["amplitude"], values["order"], values["phase"])


EFFECT = Effect(
    name="runout", summary="a surface that runs out: its motion follows the angle of the drive",
    location="pressed contact", stage="excitation", parameters=parameters, apply=apply, small=False,
    source="H. Jacobsson, Proc. IMechE D 217 (2003) 419: side-face runout",
    valid="Valid while contacts are short against the wave, and waves small against radii.")
