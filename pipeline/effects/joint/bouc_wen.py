"""Hysteresis of Bouc and Wen in a joint: a share of its stiffness yields, and gives way once more on the way back.

    F = -s k e + s k z,    dz = (1 - |z / d| (c + (1 - c) sgn(z de))) de

The joint is as stiff as before for small motion and softens over the yield displacement d; a shape c = 0.5 unloads as
stiff as it began, c = 1 as Dahl's friction does.
"""

from pipeline.effects.attached import beside_joint
from pipeline.effects.effect import Effect
from pipeline.inference.priors import LogNormal, Parameter, Uniform
from pipeline.physics.time_stepping.elements import BoucWen


def parameters(typical):
    way = 2 * typical.length
    return (Parameter("share", "1", 0.3, Uniform(0.0, 1.0), null=0.0),
            Parameter("yield_displacement", "m", way, LogNormal(way, 1.2)),
            Parameter("shape", "1", 0.75, Uniform(0.5, 1.0)))


def apply(bench, location, values):
    yielding = values["share"] * bench.joint(location)[1]
    law = BoucWen(-yielding, yielding, values["yield_displacement"], 1.0, values["shape"])
    return beside_joint(bench, "bouc_wen", location, law)


EFFECT = Effect(
    name="bouc_wen", summary="a joint that yields smoothly and recovers on the way back", location="joint",
    stage="structure", parameters=parameters, apply=apply, small=False,
    family="dry friction",
    source="R. Bouc, Proc. 4th Conf. Nonlinear Oscillations (1967) 315; Y.-K. Wen, J. Eng. Mech. Div. ASCE 102 (1976)"
           " 249, exponent 1",
    valid="Valid while the preload of the joint stays the same.")
