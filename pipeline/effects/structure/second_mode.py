"""A second mode of a body that the model takes as rigid: all that is fixed to a point moves with it.

    eta'' + 2 zeta w eta' + w^2 eta = phi f,    x + phi eta in place of x,    phi^2 = s / m,    w = 2 pi f

m is the mass felt along the sensor of the point. Joints, inputs, contacts and sensors take part by the share of their
motion that a force at the point makes, beside the motion of the point itself.
"""

from dataclasses import replace

import numpy as np

from pipeline.effects.effect import Effect
from pipeline.effects.resolved import felt_mass
from pipeline.inference.priors import HalfNormal, LogNormal, Parameter

#: largest damping ratio of a mode of a body, with layers that damp; what is damped more is a damper, not a mode
_MOST_DAMPED = 0.3


def parameters(typical):
    natural = 1 / (2 * np.pi * typical.period)      # of the body on its joints, which is rigid in its mode there
    return (Parameter("share", "1", 0.3, HalfNormal(0.5), null=0.0),
            Parameter("frequency", "Hz", 2 * natural, LogNormal(2 * natural, 0.7), within=(natural, np.inf)),
            Parameter("damping_ratio", "1", 0.02, LogNormal(0.02, 1.0), within=(0.0, _MOST_DAMPED)))


def apply(bench, location, values):
    if values["share"] == 0:
        return bench
    model, row, angular = bench.model, bench.sensor(location), 2 * np.pi * values["frequency"]
    mass = felt_mass(bench, row)
    along = mass * np.linalg.solve(model.mass, row)
    flexible = model.projected(np.column_stack((np.eye(model.size), np.sqrt(values["share"] / mass) * along)))
    rigid = model.projected(np.eye(model.size, model.size + 1))
    matrices = {name: getattr(rigid, name).copy() for name in ("mass", "damping", "stiffness")}
    for name, value in (("mass", 1.0), ("damping", 2 * values["damping_ratio"] * angular), ("stiffness", angular**2)):
        matrices[name][-1, -1] = value
    return replace(bench, model=replace(
        flexible, **matrices, gyroscopic=rigid.gyroscopic, centrifugal=rigid.centrifugal,
        body_name=(*model.body_name, f"mode at {location}"),
        coordinate_body=np.append(model.coordinate_body, len(model.body_name))))


EFFECT = Effect(
    name="second_mode", summary="a mode of a body that the model takes as rigid", location="point", stage="structure",
    parameters=parameters, apply=apply, elaborate=True,
    source="D. J. Ewins, Modal Testing, 2nd ed. (2000): the sum of modes of a free body",
    valid="Valid while one further mode of the body matters, above its mode on the joints and below the highest mode "
          "that the step resolves, damped to 30 % of critical at most.")
