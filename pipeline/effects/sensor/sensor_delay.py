"""A delay that is not accounted for: the channel shows x(t - d)."""

from dataclasses import replace

from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, Parameter


def parameters(typical):
    size = 2 * typical.interval
    return (Parameter("delay", "s", size, HalfNormal(2 * size), null=0.0),)


def apply(bench, location, values):
    return bench.with_channels(lambda c: replace(c, delay=c.delay + values["delay"]) if c.name == location else c)


EFFECT = Effect(
    name="sensor_delay", summary="a channel that is late", location="channel", stage="measurement", kind="sensor",
    parameters=parameters, apply=apply, source="group delay of anti-aliasing filters: IEEE 1057 (2017)",
    valid="Valid while all frequencies are late by the same time.")
