"""An arm or fixture in series with a joint: 1 / k' = 1 / k + s,    c' = c / (1 + s k)^(2 b).

s is the compliance of the arm; the mass of the arm is left to the neighbours. b is the share of the damping that lies
behind the arm, in the joint itself: of a damper in series with the arm, as its spring is, the arm takes its part of the
velocity twice (to first order of the damping); one beside the arm (b = 0) goes on as before.
"""

from dataclasses import replace

import numpy as np

from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, Parameter, Uniform


def parameters(typical):
    size = 0.1 / typical.holding
    return (Parameter("compliance", "m/N", size, HalfNormal(2 * size), null=0.0),
            Parameter("behind", "1", 0.5, Uniform(0.0, 1.0)))


def apply(bench, location, values):
    joints = bench.model.joints
    series = 1 + np.where([name == location for name in joints.name], values["compliance"], 0.0) * joints.stiffness
    changed = replace(joints, stiffness=joints.stiffness / series,
                      damping=joints.damping / series ** (2 * values["behind"]))
    return replace(bench, model=replace(bench.model, joints=changed))


EFFECT = Effect(
    name="compliant_arm", summary="a support that gives way in series with a joint", location="joint",
    stage="structure", parameters=parameters, apply=apply,
    source="springs in series",
    valid="Valid below the first frequency of the arm itself.")
