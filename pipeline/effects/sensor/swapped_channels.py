"""Two channels of one unit that are exchanged: each shows `gain` = 1 times what the other should, to 1 %.

A gain of 0 stands for channels that are not exchanged.
"""

from dataclasses import replace

from pipeline.effects.effect import Effect
from pipeline.effects.typical import PAIR_MARK
from pipeline.inference.priors import Factors, Parameter


def parameters(typical):
    return (Parameter("gain", "1", 1.0, Factors((1.0,), 0.01), null=0.0),)


def apply(bench, location, values):
    if values["gain"] == 0:
        return bench
    names = location.split(PAIR_MARK)
    pair = {c.name: c for c in bench.channels if c.name in names}
    other = {name: pair[shown] for name, shown in zip(names, reversed(names), strict=True) if len(pair) == 2}

    def exchanged(channel):
        shown = other.get(channel.name)
        return replace(shown, name=channel.name, gain=values["gain"] * shown.gain) if shown else channel

    return bench.with_channels(exchanged)


EFFECT = Effect(
    name="swapped_channels", summary="two channels that are exchanged", location="pair of channels",
    stage="measurement", kind="sensor", parameters=parameters, apply=apply,
    source="D. J. Ewins, Modal Testing, 2nd ed. (2000): checks of a measurement chain",
    valid="Valid while the same two channels are exchanged in all runs.")
