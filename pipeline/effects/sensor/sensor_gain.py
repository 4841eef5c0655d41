"""A gain that is off: the channel shows (1 + g) times what it should."""

from pipeline.effects.attached import scaled_channel
from pipeline.effects.effect import Effect
from pipeline.inference.priors import Parameter, Uniform


def parameters(typical):
    return (Parameter("error", "1", 0.1, Uniform(-0.9, 1.0), null=0.0),)


def apply(bench, location, values):
    return scaled_channel(bench, location, 1 + values["error"])


EFFECT = Effect(
    name="sensor_gain", summary="a channel with a wrong gain", location="channel", stage="measurement", kind="sensor",
    parameters=parameters, apply=apply, source="calibration: ISO 16063-21 (2003)",
    valid="Valid while the gain is the same in all runs and at all frequencies.")
