"""A joint that softens as it warms up: k(t) = k (1 - d (1 - exp(-t / tau)))."""

from pipeline.effects.effect import Effect
from pipeline.effects.warming import warming_time
from pipeline.inference.priors import Parameter, Uniform
from pipeline.physics.time_stepping.elements import Element, Softening


def parameters(typical):
    return (Parameter("drop", "1", 0.1, Uniform(0.0, 0.8), null=0.0),
            warming_time(typical))


def apply(bench, location, values):
    row, stiffness, _ = bench.joint(location)
    law = Softening(values["drop"] * stiffness, values["time"])
    return bench.with_elements(Element(f"thermal_softening {location}", row, law))


EFFECT = Effect(
    name="thermal_softening", summary="a joint that loses stiffness as it warms up", location="joint",
    stage="structure", parameters=parameters, apply=apply, small=False, linear=("drop",),
    source="one lumped heat capacity under constant power; modulus linear in temperature",
    valid="Valid while heating is steady from the begin of each run, which starts cold.")
