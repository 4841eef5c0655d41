"""A zero that is off and wanders: the channel shows o + d t on top."""

from dataclasses import replace

from pipeline.effects.effect import Effect
from pipeline.inference.priors import Normal, Parameter


def parameters(typical):
    size = 0.1 * typical.shown
    return (Parameter("offset", "unit of the channel", size, Normal(0.0, size), null=0.0),
            Parameter("drift", "unit of the channel per s", size / typical.time, Normal(0.0, size / typical.time),
                      null=0.0))


def apply(bench, location, values):
    return bench.with_channels(lambda c: replace(c, offset=c.offset + values["offset"], drift=c.drift + values["drift"])
                               if c.name == location else c)


EFFECT = Effect(
    name="sensor_offset_drift", summary="a channel whose zero is off or wanders", location="channel",
    stage="measurement", kind="sensor", parameters=parameters, apply=apply,
    source="zero drift of charge amplifiers and bridges: ISO 376 (2011)",
    valid="Valid while the zero wanders evenly and is the same at the begin of every run.")
