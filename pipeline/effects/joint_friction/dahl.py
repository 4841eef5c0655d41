"""Dahl friction in a joint: it is built up over a way, whatever the speed.

    F = F_c y,    dy/de = (1 - y sgn(v)) / L

Small motions meet a spring F_c / L, long ones Coulomb friction.
"""

from pipeline.effects.attached import beside_joint
from pipeline.effects.effect import Effect
from pipeline.effects.resolved import resolved_stiffness
from pipeline.inference.priors import HalfNormal, LogNormal, Parameter
from pipeline.physics.time_stepping.elements import Presliding


def parameters(typical):
    way = 0.05 * typical.length
    return (Parameter("force", "N", 0.2 * typical.force, HalfNormal(0.3 * typical.force), null=0.0),
            Parameter("length", "m", way, LogNormal(way, 1.0)))


def apply(bench, location, values):
    if values["force"] == 0:
        return bench
    shortest = values["force"] / resolved_stiffness(bench, bench.joint(location)[0])
    return beside_joint(bench, "dahl", location, Presliding(values["force"], max(values["length"], shortest)))


EFFECT = Effect(
    name="dahl", summary="dry friction that is built up over a way", location="joint", stage="friction",
    parameters=parameters, apply=apply, small=False, linear=("force",),
    extends=("coulomb",),
    family="dry friction",
    source="P. R. Dahl, Aerospace Corporation report TOR-0158(3107-18)-1 (1968), exponent 1",
    valid="Valid while the normal force in the joint stays the same; a spring F_c / L that the step does not resolve is"
          " taken as the stiffest that it does.")
