"""A channel whose sign is reversed: it shows `factor` = -1 times what it should, its gain known to 2 %."""

from pipeline.effects.attached import scaled_channel
from pipeline.effects.effect import Effect
from pipeline.inference.priors import Factors, Parameter


def parameters(typical):
    return (Parameter("factor", "1", -1.0, Factors((-1.0,), 0.02), null=1.0),)


def apply(bench, location, values):
    return scaled_channel(bench, location, values["factor"])


EFFECT = Effect(
    name="reversed_channel", summary="a channel with the wrong sign", location="channel", stage="measurement",
    kind="sensor", parameters=parameters, apply=apply,
    source="D. J. Ewins, Modal Testing, 2nd ed. (2000): polarity of transducers",
    valid="Valid while the sign is the same in all runs.")
