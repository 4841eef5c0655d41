"""Friction that depends on the position along a joint: F = F_c max(0, 1 + g e) sgn(v).

A guide that is tighter at one end, or a bearing surface of uneven finish, has a gradient g. At rest the joint creeps by
a tenth of what friction takes off the speed within one step, which is numerics, no physics.
"""

from pipeline.effects.attached import beside_joint
from pipeline.effects.effect import Effect
from pipeline.effects.resolved import felt_mass
from pipeline.inference.priors import HalfNormal, Normal, Parameter
from pipeline.physics.time_stepping.elements import Positional

#: speed of creep, as a fraction of the change of speed in one step
_CREEP = 0.1


def parameters(typical):
    return (Parameter("force", "N", 0.2 * typical.force, HalfNormal(0.3 * typical.force), null=0.0),
            Parameter("gradient", "1/m", 0.0, Normal(0.0, 0.7 / typical.length)))


def apply(bench, location, values):
    if values["force"] == 0:
        return bench
    creep = _CREEP * values["force"] * bench.step / felt_mass(bench, bench.joint(location)[0])
    return beside_joint(bench, "position_friction", location, Positional(values["force"], values["gradient"], creep))


EFFECT = Effect(
    name="position_friction", summary="dry friction that is larger at one end of a joint", location="joint",
    stage="friction", parameters=parameters, apply=apply, small=False, linear=("force",), elaborate=True,
    extends=("coulomb",),
    family="dry friction",
    source="B. Armstrong, Int. J. Robotics Research 7 (1988) 107: friction of a robot by position",
    valid="Valid while friction changes in proportion to the position over the whole motion.")
