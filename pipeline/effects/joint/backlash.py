"""Backlash in a joint: no force within +-g, F = k (e -+ g) beyond; as a change, F = -k clip(e, -g, g)."""

from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, Parameter
from pipeline.physics.time_stepping.elements import Element, Gap


def parameters(typical):
    size = 0.2 * typical.length
    return (Parameter("gap", "m", size, HalfNormal(2 * size), null=0.0, threshold=True),)


def apply(bench, location, values):
    row, stiffness, _ = bench.joint(location)
    law = Gap(inner=-stiffness, lower=values["gap"], upper=values["gap"])
    return bench.with_elements(Element(f"backlash {location}", row, law))


EFFECT = Effect(
    name="backlash", summary="free play in a joint", location="joint", stage="structure", parameters=parameters,
    family="nonlinear stiffness",
    apply=apply, source="S. Dubowsky, F. Freudenstein, J. Eng. Ind. 93 (1971) 305",
    valid="Valid while the damper of the joint works within the gap as beyond it.")
