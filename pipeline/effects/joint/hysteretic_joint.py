"""Micro-slip in a joint: sliders in parallel, whose slip ways are spread as phi^x, take over a share of its stiffness.

    F = sum_j clip(F_j + k_j de, -L_j, L_j) - s k e,    k_j = s k / n

Of many sliders the loss of a cycle grows as the power x + 3 of its amplitude, and the joint softens; of a few (Jenkins
elements in parallel) each slips at a way of its own. Their number n need not be whole: the last, of the longest way,
carries what is left. Nothing changes for small motion.
"""

from pipeline.effects.attached import beside_joint
from pipeline.effects.effect import Effect
from pipeline.inference.priors import LogNormal, Parameter, Uniform
from pipeline.physics.time_stepping.elements import iwan

#: number of sliders from which on they are a continuum
_MOST = 40.0


def parameters(typical):
    return (Parameter("share", "1", 0.3, Uniform(0.0, 1.0), null=0.0),
            Parameter("slip_force", "N", typical.force, LogNormal(typical.force, 1.2)),
            Parameter("exponent", "1", -0.3, Uniform(-0.9, 1.0)),
            Parameter("sliders", "1", 6.0, LogNormal(6.0, 0.9)))


def apply(bench, location, values):
    law = iwan(values["share"] * bench.joint(location)[1], values["slip_force"], values["exponent"],
               min(max(values["sliders"], 1.0), _MOST), elastic=True)
    return beside_joint(bench, "hysteretic_joint", location, law)


EFFECT = Effect(
    name="hysteretic_joint", summary="micro-slip in a joint: loss and softening that grow with amplitude",
    location="joint", stage="structure", parameters=parameters, apply=apply, small=False,
    family="dry friction",
    source="W. D. Iwan, J. Appl. Mech. 33 (1966) 893; D. J. Segalman, J. Appl. Mech. 72 (2005) 752; for"
           " few sliders G. M. Jenkins, Br. J. Appl. Phys. 13 (1962) 30",
    valid="Valid while the preload of the joint stays the same and its share slips within the joint.")
