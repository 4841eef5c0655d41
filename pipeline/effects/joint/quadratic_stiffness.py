"""Quadratic stiffness of a joint: F = k_2 e^2, stiffer one way than the other."""

from pipeline.effects.attached import beside_joint
from pipeline.effects.effect import Effect
from pipeline.inference.priors import Normal, Parameter
from pipeline.physics.time_stepping.elements import Polynomial


def parameters(typical):
    size = 0.1 * typical.force / typical.length**2
    return (Parameter("coefficient", "N/m^2", size, Normal(0.0, 10 * size), null=0.0),)


def apply(bench, location, values):
    return beside_joint(bench, "quadratic_stiffness", location, Polynomial(quadratic=values["coefficient"]))


EFFECT = Effect(
    name="quadratic_stiffness", summary="a joint that is stiffer one way than the other", location="joint",
    stage="structure", parameters=parameters, apply=apply, linear=("coefficient",),
    family="nonlinear stiffness",
    source="H. von Helmholtz, Die Lehre von den Tonempfindungen (1863)",
    valid="Valid while the force grows with deflection: k + 2 k_2 e > 0.")
