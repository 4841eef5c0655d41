"""Wear law: depths that go with another power of the nominal pressure P than Archard's.

    dh = k (P / P_0)^a p ds

p is the pressure of the node: the volume worn per sliding distance goes with P^(1 + a).
"""

from dataclasses import replace

from pipeline.effects.effect import Effect
from pipeline.effects.typical import ASPERITIES
from pipeline.inference.priors import LogNormal, Normal, Parameter


def parameters(typical):
    return (Parameter("exponent", "1", 0.0, Normal(0.0, 0.5), null=0.0),
            Parameter("pressure", "Pa", typical.pressure, LogNormal(typical.pressure, 0.1)))


def apply(rubbing, location, values):
    law = {"exponent": values["exponent"], "reference_pressure": values["pressure"]}
    return replace(rubbing, wearing=replace(rubbing.wearing, **law))


EFFECT = Effect(
    name="wear_law", summary="wear that is not in proportion to the pressure", location=ASPERITIES, stage="contact",
    parameters=parameters, apply=apply, source="S. K. Rhee, Wear 16 (1970) 431: W = K F^a v^b t^c of brake linings",
    valid="Valid while both surfaces follow the same power, within the pressures that were recorded.")
