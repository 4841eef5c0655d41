"""Taper wear: a group of contacts wears more at one end than at the other, which tilts what is in contact.

    h_i' = |r| (1 - sgn(r) s_i) p_i |v_i|

s_i goes from -1 at the smallest angle to 1 at the largest, so that one end does not wear at all: r > 0 wears the end
that a positive drive reaches first.
"""

import numpy as np

from pipeline.effects.contact.contact_surface import sliding_angle, with_wear
from pipeline.effects.contact.wear import typical_rate
from pipeline.effects.effect import Effect
from pipeline.inference.priors import Normal, Parameter


def parameters(typical):
    size = typical_rate(typical)
    return (Parameter("rate", "m^2/N", size, Normal(0.0, size), null=0.0),)


def apply(bench, location, values):
    angle = sliding_angle(bench.model.contacts, bench.contacts(location))
    place_along = 2 * (angle - angle.min()) / np.ptp(angle) - 1
    return with_wear(bench, location, abs(values["rate"]) * (1 - np.sign(values["rate"]) * place_along))


EFFECT = Effect(
    name="taper_wear", summary="contacts that wear more at one end", location="contact row", stage="contact",
    parameters=parameters, apply=apply, small=False,
    source="J. F. Archard, J. Appl. Phys. 24 (1953) 981, with a rate that is linear along the sliding",
    valid="Valid while the rate is linear along the sliding; every run starts unworn.")
