"""Coulomb friction in a joint: F = F_c sgn(v), and at rest whatever up to F_c keeps it there.

Friction of guide pins under a steady load is this effect at the joint of the pins.
"""

from pipeline.effects.attached import beside_joint
from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, Parameter
from pipeline.physics.time_stepping.elements import Dry


def parameters(typical):
    return (Parameter("force", "N", 0.2 * typical.force, HalfNormal(0.3 * typical.force), null=0.0),)


def apply(bench, location, values):
    return beside_joint(bench, "coulomb", location, Dry(forward=values["force"], backward=values["force"]))


EFFECT = Effect(
    name="coulomb", summary="dry friction of one size in both directions", location="joint", stage="friction",
    parameters=parameters, apply=apply, small=False, linear=("force",),
    family="dry friction",
    source="C.-A. Coulomb, Theorie des machines simples (1785)",
    valid="Valid while the normal force in the joint stays the same and the joint slides more than it sticks.")
