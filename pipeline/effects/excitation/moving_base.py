"""A base that moves: behind a joint stands a mass on a spring, not the ground.

    m_b u'' + k_b u = joint force,    elongation of the joint b q - u,    m_b = k_b / (2 pi f)^2

The compliance 1 / k_b is 0 for a rigid base, f its frequency with the joint held.
"""

from dataclasses import replace

import numpy as np

from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, LogNormal, Parameter
from pipeline.physics.sliding.model import Joints


def parameters(typical):
    size, frequency = 0.1 / typical.holding, 1 / (2 * np.pi * typical.period)
    return (Parameter("compliance", "m/N", size, HalfNormal(2 * size), null=0.0),
            Parameter("frequency", "Hz", frequency, LogNormal(frequency, 0.7)))


def apply(bench, location, values):
    if values["compliance"] == 0:
        return bench
    model = bench.model.projected(np.eye(bench.model.size, bench.model.size + 1))
    rows = model.joints.rows.copy()
    rows[model.joints.name.index(location), -1] = -1.0
    stiffness = 1 / values["compliance"]
    mass, springs = model.mass.copy(), model.stiffness.copy()
    mass[-1, -1], springs[-1, -1] = stiffness / (2 * np.pi * values["frequency"]) ** 2, stiffness
    joints = Joints(model.joints.name, rows, model.joints.stiffness, model.joints.damping)
    bodies = np.append(bench.model.coordinate_body, len(model.body_name))
    return replace(bench, model=replace(model, body_name=(*model.body_name, f"base of {location}"), mass=mass,
                                        coordinate_body=bodies, stiffness=springs, joints=joints))


EFFECT = Effect(
    name="moving_base", summary="a base behind a joint that moves as well", location="joint", stage="structure",
    parameters=parameters, apply=apply, elaborate=True, extends=("compliant_arm",),
    source="J. P. Den Hartog, Mechanical Vibrations (1934): two masses in series",
    valid="Valid while one mode of the base matters, and the joint is fixed to nothing else than the base.")
