"""Shear limit: the spots yield in something else than the disc, and the harder they are pressed, the later.

    tau = f tau_0 + a p

f is the shear strength of what lies between the bodies (the third body) over that of the model, a what each pressure
adds: in full slip mu = f tau_0 A / P + a, A the real area share and P the nominal pressure.
"""

from dataclasses import replace

from pipeline.effects.effect import Effect
from pipeline.effects.typical import ASPERITIES
from pipeline.inference.priors import HalfNormal, LogNormal, Parameter


def parameters(typical):
    return (Parameter("factor", "1", 1.0, LogNormal(1.0, 1.0), null=1.0),
            Parameter("pressure_coefficient", "1", 0.0, HalfNormal(0.1), null=0.0))


def apply(rubbing, location, values):
    shearing = rubbing.shearing
    changed = replace(shearing, limit=values["factor"] * shearing.limit,
                      pressure_coefficient=shearing.pressure_coefficient + values["pressure_coefficient"])
    return replace(rubbing, shearing=changed)


EFFECT = Effect(
    name="shear_limit", summary="a third body that shears at another limit than the disc", location=ASPERITIES,
    stage="friction", parameters=parameters, apply=apply,
    source="M. Godet, Wear 100 (1984) 437: the third body; B. J. Briscoe, D. C. B. Evans, Proc. R. Soc. A 380"
           " (1982) 389: tau = tau_0 + a p",
    valid="Valid while every spot slips, so that only the limit decides its shear.")
