"""A pad that relaxes: a spring in series with a damper beside a joint, the standard linear solid.

    F' = s k v - F / tau,    complex stiffness of the joint k (1 + s i w tau / (1 + i w tau))

Slow motion meets the stiffness k of the joint, fast motion (1 + s) k; the loss is largest at w tau = 1.
"""

import numpy as np

from pipeline.effects.attached import beside_joint
from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, LogNormal, Parameter
from pipeline.physics.time_stepping.elements import Maxwell


def parameters(typical):
    return (Parameter("share", "1", 0.2, HalfNormal(1.0), null=0.0),
            Parameter("time", "s", typical.period, LogNormal(typical.period, 1.0)))


def apply(bench, location, values):
    law = Maxwell(np.array([values["share"] * bench.joint(location)[1]]), np.array([values["time"]]))
    return beside_joint(bench, "viscoelastic_pad", location, law)


EFFECT = Effect(
    name="viscoelastic_pad", summary="a pad that relaxes: stiffer and lossier for fast motion", location="joint",
    stage="structure", parameters=parameters, apply=apply, linear=("share",),
    extends=("joint_damping",),
    family="damping",
    source="C. Zener, Elasticity and Anelasticity of Metals (1948): standard linear solid",
    valid="Valid while one relaxation matters, and runs whose start is known begin relaxed.")
