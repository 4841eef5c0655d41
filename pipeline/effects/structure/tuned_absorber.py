"""A hidden mass on a spring and a damper at a point: a tuned absorber, or a part that rattles along.

    m_a u'' + c_a (u' - v) + k_a (u - x) = 0,    k_a = m_a (2 pi f)^2,    c_a = 2 zeta m_a 2 pi f

x is the motion along the direction of the sensor, which feels the force of spring and damper.
"""

from dataclasses import replace

import numpy as np

from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, LogNormal, Parameter
from pipeline.physics.sliding.model import Joints

#: largest damping ratio of a part on rubber, of a loss factor of 0.6; what is damped more is a damper
_MOST_DAMPED = 0.3


def parameters(typical):
    frequency = 1 / (2 * np.pi * typical.period)
    return (Parameter("mass", "kg", 0.05 * typical.mass, HalfNormal(0.1 * typical.mass), null=0.0),
            Parameter("frequency", "Hz", frequency, LogNormal(frequency, 0.7)),
            Parameter("damping_ratio", "1", 0.03, LogNormal(0.03, 1.0), within=(0.0, _MOST_DAMPED)))


def apply(bench, location, values):
    if values["mass"] == 0:
        return bench
    row, angular = bench.sensor(location), 2 * np.pi * values["frequency"]
    model = bench.model.projected(np.eye(bench.model.size, bench.model.size + 1))
    mass, joints = model.mass.copy(), model.joints
    mass[-1, -1] = values["mass"]
    joints = Joints((*joints.name, f"absorber at {location}"), np.vstack((joints.rows, np.append(-row, 1.0))),
                    np.append(joints.stiffness, values["mass"] * angular**2),
                    np.append(joints.damping, 2 * values["damping_ratio"] * values["mass"] * angular))
    bodies = np.append(bench.model.coordinate_body, len(model.body_name))
    return replace(bench, model=replace(model, body_name=(*model.body_name, f"absorber at {location}"),
                                        coordinate_body=bodies, mass=mass, joints=joints))


EFFECT = Effect(
    name="tuned_absorber", summary="a hidden mass on a spring at a point", location="point", stage="structure",
    parameters=parameters, apply=apply, elaborate=True,
    source="J. P. Den Hartog, Mechanical Vibrations (1934): the dynamic vibration absorber",
    valid="Valid while one mode of what is hidden matters, along the sensor only, damped to 30 % of critical at most.")
