"""Clearance of contacts: every gap of the group is wider by d, or narrower where d < 0.

N acts where gap + d < 0: contacts that were thought closed may open, and the other way round.
"""

from dataclasses import replace

import numpy as np

from pipeline.effects.effect import Effect
from pipeline.inference.priors import Normal, Parameter


def parameters(typical):
    size = 0.3 * typical.length
    return (Parameter("gap", "m", size, Normal(0.0, 2 * size), null=0.0),)


def apply(bench, place, values):
    gap = np.array(np.broadcast_to(np.asarray(bench.law.gap, float), len(bench.model.contacts.area)))
    gap[bench.contacts(place)] += values["gap"]
    return replace(bench, law=replace(bench.law, gap=gap))


EFFECT = Effect(
    name="clearance", summary="contacts that close later, or earlier, than thought", place="contact", stage="contact",
    parameters=parameters, apply=apply,
    source="A. Signorini, Atti Soc. Ital. Progr. Sci. (1933): unilateral contact, with an initial gap",
    valid="Valid while the gap is the same all over the group.")
