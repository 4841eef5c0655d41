"""Thickness variation: contacts are squeezed by a force that follows the angle of the drive, F_0 cos(n theta - phase).

A force, not a motion, as a stiff caliper answers a disc of uneven thickness; runout is the motion.
"""

import numpy as np

from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, Parameter, Uniform
from pipeline.physics.time_stepping.elements import Element, Wave


def parameters(typical):
    size = 0.05 * typical.force
    return (Parameter("force", "N", size, HalfNormal(2 * size), null=0.0),
            Parameter("order", "1", 1.0, Uniform(0.5, 8.5)), Parameter("phase", "rad", 0.0, Uniform(-np.pi, np.pi)))


def apply(bench, location, values):
    # minus: against the normal, so that the contact is pressed
    row = bench.model.contacts.normal[bench.contacts(location)].mean(axis=0)
    law = Wave(-1.0, 0.0, values["force"], values["order"], 0.0, values["phase"])
    return bench.with_elements(Element(f"thickness_variation {location}", row, law))


EFFECT = Effect(
    name="thickness_variation", summary="a squeezing force that follows the angle of the drive",
    location="pressed contact", stage="excitation", parameters=parameters, apply=apply, small=False, linear=("force",),
    source="H. Jacobsson, Proc. IMechE D 217 (2003) 419: disc thickness variation",
    valid="Valid while the support is stiff against the contacts.")
