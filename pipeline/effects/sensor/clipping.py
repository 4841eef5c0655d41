"""An amplifier that clips: the channel never shows more than its limit, given as 1 / limit (0: no limit)."""

from dataclasses import replace

import numpy as np

from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, Parameter


def parameters(typical):
    size = 1 / typical.shown        # a limit shows as the largest sample
    return (Parameter("inverse_limit", "1 per unit of the channel", size, HalfNormal(size), null=0.0),)


def apply(bench, location, values):
    limit = 1 / values["inverse_limit"] if values["inverse_limit"] > 0 else np.inf
    return bench.with_channels(lambda c: replace(c, limit=min(c.limit, limit)) if c.name == location else c)


EFFECT = Effect(
    name="clipping", summary="a channel that clips", location="channel", stage="measurement", kind="sensor",
    parameters=parameters, apply=apply, source="overrange of recorders: IEEE 1057 (2017)",
    valid="Valid while clipping is even on both sides and follows all filters.")
