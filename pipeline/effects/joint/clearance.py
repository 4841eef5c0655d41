"""Clearance of contacts: every gap of the group is wider by d, or narrower where d < 0.

N acts where gap + d < 0: contacts that were thought closed may open, and the other way round.
"""

from dataclasses import replace

from pipeline.effects.effect import Effect
from pipeline.inference.priors import Normal, Parameter
from pipeline.physics.contact.groups import read, with_field


def parameters(typical):
    size = 0.3 * typical.length
    return (Parameter("gap", "m", size, Normal(0.0, 2 * size), null=0.0, threshold=True),)


def apply(bench, location, values):
    gap = read(bench.law, "gap", len(bench.model.contacts.area))
    gap[bench.contacts(location)] += values["gap"]
    return replace(bench, law=with_field(bench.law, gap=gap))


EFFECT = Effect(
    name="clearance", summary="contacts that close later, or earlier, than thought",
    location="pressed contact", stage="contact", parameters=parameters, apply=apply,
    family="nonlinear stiffness",
    source="A. Signorini, Atti Soc. Ital. Progr. Sci. (1933): unilateral contact, with an initial gap",
    valid="Valid while the gap is the same all over the group.")
