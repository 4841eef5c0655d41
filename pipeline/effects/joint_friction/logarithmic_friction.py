"""Friction of a joint that follows the logarithm of the speed: F = F_0 (1 + a ln(v / v_0)), v_0 = 1 um/s.

The direct effect of rate-and-state friction without a state; near rest F = F_0 a arcsinh(v / (2 v_0) exp(1 / a)).
"""

from pipeline.effects.attached import beside_joint
from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, LogNormal, Parameter
from pipeline.physics.time_stepping.elements import RateState


def parameters(typical):
    return (Parameter("force", "N", 0.2 * typical.force, HalfNormal(0.3 * typical.force), null=0.0),
            Parameter("direct", "1", 0.02, LogNormal(0.02, 1.0)))


def apply(bench, location, values):
    if values["force"] == 0:
        return bench
    return beside_joint(bench, "logarithmic_friction", location, RateState(values["force"], values["direct"]))


EFFECT = Effect(
    name="logarithmic_friction", summary="friction that rises with the logarithm of the speed", location="joint",
    stage="friction", parameters=parameters, apply=apply, small=False, linear=("force",),
    elaborate=True, extends=("coulomb",),
    family="dry friction",
    source="F. P. Bowden, D. Tabor, The Friction and Lubrication of Solids II (1964): thermally activated shear; J. R."
           " Rice, N. Lapusta, K. Ranjith, J. Mech. Phys. Solids 49 (2001) 1865: regularised",
    valid="Valid while the normal force in the joint stays the same and the contact forgets within less way than the"
          " motion shows.")
