"""Rate-and-state friction of a joint, slip law: the state of the contact changes with the way alone.

    F = F_0 (1 + a ln(v / v_0) + b ln(v_0 theta / D_c)),    theta' = -(|v| theta / D_c) ln(|v| theta / D_c)

v_0 = 1 um/s. Steady sliding and the jump at a step of the speed are those of the ageing law; friction evolves over the
same way D_c whether the speed steps up or down, and does not change at rest.
"""

from pipeline.effects.effect import Effect
from pipeline.effects.joint_friction.rate_state_ageing import parameters, with_states


def apply(bench, location, values):
    return with_states(bench, "rate_state_slip", location, values, slip=1.0)


EFFECT = Effect(
    name="rate_state_slip", summary="friction that follows speed and state of the contact, which slip alone changes",
    location="joint", stage="friction", parameters=parameters, apply=apply, small=False, linear=("force",),
    elaborate=True, extends=("coulomb",),
    family="dry friction",
    source="A. Ruina, J. Geophys. Res. 88 (1983) 10359; J. R. Rice, N. Lapusta, K. Ranjith, J. Mech. Phys. Solids 49"
           " (2001) 1865: regularised",
    valid="Valid while the normal force in the joint stays the same and every run begins settled at its first speed.")
