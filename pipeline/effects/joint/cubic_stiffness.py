"""Cubic stiffness of a joint: F = k_3 e^3, hardening for k_3 > 0."""

from pipeline.effects.attached import beside_joint
from pipeline.effects.effect import Effect
from pipeline.inference.priors import Normal, Parameter
from pipeline.physics.time_stepping.elements import Polynomial


def parameters(typical):
    size = 0.1 * typical.force / typical.length**3
    return (Parameter("coefficient", "N/m^3", size, Normal(0.0, 10 * size), null=0.0),)


def apply(bench, location, values):
    return beside_joint(bench, "cubic_stiffness", location, Polynomial(cubic=values["coefficient"]))


EFFECT = Effect(
    name="cubic_stiffness", summary="a joint that gets stiffer (or softer) with deflection, alike both ways",
    location="joint", stage="structure", parameters=parameters, apply=apply, linear=("coefficient",),
    family="nonlinear stiffness",
    source="G. Duffing, Erzwungene Schwingungen bei veraenderlicher Eigenfrequenz (1918)",
    valid="Valid while the force grows with deflection: k + 3 k_3 e^2 > 0.")
