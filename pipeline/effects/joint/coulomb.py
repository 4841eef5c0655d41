"""Coulomb friction in a joint: F = F_c sgn(v).

Before it slides the joint gives way elastically, by as little as the step of the bench resolves: 8 steps in a period
of the mass on that spring, which is numerics, no physics. Friction of guide pins under a steady load is this effect at
the joint of the pins.
"""

from pipeline.effects.effect import Effect
from pipeline.effects.joint.stick import stick_stiffness
from pipeline.inference.priors import HalfNormal, Parameter
from pipeline.physics.time_stepping.elements import Dry, Element


def parameters(typical):
    return (Parameter("force", "N", 0.2 * typical.force, HalfNormal(0.3 * typical.force), null=0.0),)


def apply(bench, location, values):
    row, _, _ = bench.joint(location)
    law = Dry(stick_stiffness(bench, row), values["force"], values["force"])
    return bench.with_elements(Element(f"coulomb {location}", row, law))


EFFECT = Effect(
    name="coulomb", summary="dry friction of one size in both directions", location="joint", stage="friction",
    parameters=parameters, apply=apply, small=False, linear=("force",),
    source="C.-A. Coulomb, Theorie des machines simples (1785)",
    valid="Valid while the normal force in the joint stays the same and the joint slides more than it sticks.")
