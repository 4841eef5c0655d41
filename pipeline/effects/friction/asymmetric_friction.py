"""Dry friction that a joint has in one direction only: F = F_a for v > 0 (F_a > 0), or for v < 0 (F_a < 0).

It comes on top of what resists in both directions; either sign takes energy out.
"""

from pipeline.effects.attached import beside_joint
from pipeline.effects.effect import Effect
from pipeline.inference.priors import Normal, Parameter
from pipeline.physics.time_stepping.elements import Dry


def parameters(typical):
    return (Parameter("force", "N", 0.1 * typical.force, Normal(0.0, 0.2 * typical.force), null=0.0),)


def apply(bench, location, values):
    law = Dry(forward=max(values["force"], 0.0), backward=max(-values["force"], 0.0))
    return beside_joint(bench, "asymmetric_friction", location, law)


EFFECT = Effect(
    name="asymmetric_friction", summary="dry friction that is larger in one direction", location="joint",
    stage="friction", parameters=parameters, apply=apply, small=False, linear=("force",),
    family="dry friction",
    source="B. Armstrong-Helouvry, P. Dupont, C. Canudas de Wit, Automatica 30 (1994) 1083",
    valid="Valid while the normal force in the joint stays the same.")
