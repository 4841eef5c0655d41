"""Wear: every contact of a group recedes by h' = r p |v|, with its own pressure p and sliding speed v.

What recedes is pressed less and wears less: pressure evens out, at a fixed distance as exp(-r k s / A) with the way s.
"""

from pipeline.effects.contact.contact_surface import with_wear
from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, Parameter


def typical_rate(typical):
    """Rate in m^2/N at which the longest run wears off 0.3 of the typical length."""
    return 0.3 * typical.length / (typical.pressure * typical.speed * typical.time)


def parameters(typical):
    size = typical_rate(typical)
    return (Parameter("rate", "m^2/N", size, HalfNormal(2 * size), null=0.0),)


def apply(bench, location, values):
    return with_wear(bench, location, values["rate"])


EFFECT = Effect(
    name="wear", summary="contacts that recede with pressure and sliding way", location="pressed contact",
    stage="contact",
    parameters=parameters, apply=apply, small=False, source="J. F. Archard, J. Appl. Phys. 24 (1953) 981",
    valid="Valid while the rate stays the same; every run starts unworn.")
