"""Rate-and-state friction of a joint, ageing law: the contact strengthens with time, and forgets with the way.

    F = F_0 (1 + a ln(v / v_0) + b ln(v_0 theta / D_c)),    theta' = 1 - |v| theta / D_c

F_0 is the force of slow sliding at v_0 = 1 um/s; near rest the force is regularised, so that it changes sign with v.
After a step of the speed friction jumps by F_0 a ln(v / v_before) and evolves over the way D_c to a change of
F_0 (a - b) ln(v / v_before).
"""

from pipeline.effects.attached import beside_joint
from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, LogNormal, Parameter
from pipeline.physics.time_stepping.elements import RateState


def parameters(typical):
    way = 0.02 * typical.length
    return (Parameter("force", "N", 0.2 * typical.force, HalfNormal(0.3 * typical.force), null=0.0),
            Parameter("direct", "1", 0.02, LogNormal(0.02, 0.8)),
            Parameter("evolution", "1", 0.02, LogNormal(0.02, 0.8)),
            Parameter("length", "m", way, LogNormal(way, 1.5)))


def apply(bench, location, values):
    return with_states(bench, "rate_state_ageing", location, values, slip=0.0)


def with_states(bench, effect, location, values, slip):
    """The bench with rate-and-state friction beside a joint; ``slip``: 1 for the slip law, 0 for ageing."""
    if values["force"] == 0:
        return bench
    return beside_joint(bench, effect, location, RateState(values["force"], values["direct"], values["evolution"],
                                                           values["length"], slip))


EFFECT = Effect(
    name="rate_state_ageing", summary="friction that follows speed and age of the contact, which ages at rest too",
    location="joint", stage="friction", parameters=parameters, apply=apply, small=False, linear=("force",),
    elaborate=True, extends=("coulomb",),
    family="dry friction",
    source="J. H. Dieterich, J. Geophys. Res. 84 (1979) 2161; J. R. Rice, N. Lapusta, K. Ranjith, J. Mech. Phys. Solids"
           " 49 (2001) 1865: regularised",
    valid="Valid while the normal force in the joint stays the same and every run begins settled at its first speed.")
