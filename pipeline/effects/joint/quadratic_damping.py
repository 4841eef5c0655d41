"""Quadratic damping of a joint: F = c_2 |v| v, as of a turbulent fluid."""

from pipeline.effects.attached import beside_joint
from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, Parameter
from pipeline.physics.time_stepping.elements import Power


def parameters(typical):
    size = 0.1 * typical.force / typical.speed**2
    return (Parameter("coefficient", "N s^2/m^2", size, HalfNormal(10 * size), null=0.0),)


def apply(bench, location, values):
    return beside_joint(bench, "quadratic_damping", location, Power(values["coefficient"], 2.0))


EFFECT = Effect(
    name="quadratic_damping", summary="a joint whose damping grows with speed", location="joint", stage="structure",
    parameters=parameters, apply=apply, small=False, linear=("coefficient",),
    family="damping",
    source="J. R. Morison et al., Petroleum Trans. AIME 189 (1950) 149: the drag term",
    valid="Valid while the flow that resists is turbulent.")
