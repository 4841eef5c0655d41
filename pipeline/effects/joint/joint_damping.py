"""Viscous damping in a joint: F = c v, on top of what the joint has."""

from dataclasses import replace

import numpy as np

from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, Parameter


def parameters(typical):
    size = 0.1 * typical.force / typical.speed
    return (Parameter("damping", "N s/m", size, HalfNormal(2 * size), null=0.0),)


def apply(bench, location, values):
    joints = bench.model.joints
    added = np.where([name == location for name in joints.name], values["damping"], 0.0)
    return replace(bench, model=replace(bench.model, joints=replace(joints, damping=joints.damping + added)))


EFFECT = Effect(
    name="joint_damping", summary="viscous damping in a joint", location="joint", stage="structure",
    parameters=parameters, apply=apply, linear=("damping",),
    family="damping",
    source="Lord Rayleigh, The Theory of Sound (1877), section 45",
    valid="Valid while losses grow with the square of amplitude and with frequency.")
