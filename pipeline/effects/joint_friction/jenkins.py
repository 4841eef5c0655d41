"""A Jenkins element beside a joint: one spring in series with one dry slider.

    F = clip(F + k de, -L, L)

The joint is stiffer by k while the slider sticks, and loses 4 L (X - L / k) in a cycle of amplitude X > L / k.
"""

import numpy as np

from pipeline.effects.attached import beside_joint
from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, LogNormal, Parameter
from pipeline.physics.time_stepping.elements import Sliders


def parameters(typical):
    size, limit = 0.1 * typical.holding, 0.1 * typical.force
    return (Parameter("stiffness", "N/m", size, HalfNormal(3 * size), null=0.0),
            Parameter("limit", "N", limit, LogNormal(limit, 1.0)))


def apply(bench, location, values):
    law = Sliders(np.array([values["stiffness"]]), np.array([values["limit"]]))
    return beside_joint(bench, "jenkins", location, law)


EFFECT = Effect(
    name="jenkins", summary="a spring with a dry slider beside a joint", location="joint", stage="structure",
    parameters=parameters, apply=apply,
    extends=("coulomb",),
    family="dry friction",
    source="G. M. Jenkins, Br. J. Appl. Phys. 13 (1962) 30",
    valid="Valid while the whole contact slips at once.")
