"""A mass at a point: m x'' along the direction of its sensor, as of an accelerometer that the model leaves out."""

from pipeline.effects.attached import at_point
from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, Parameter


def parameters(typical):
    return (Parameter("mass", "kg", 0.05 * typical.mass, HalfNormal(0.3 * typical.mass), null=0.0),)


def apply(bench, location, values):
    return at_point(bench, "mass", location, values["mass"])


EFFECT = Effect(
    name="attached_mass", summary="a mass that moves with a point", location="point", stage="structure",
    parameters=parameters, apply=apply, linear=("mass",),
    source="D. J. Ewins, Modal Testing, 2nd ed. (2000): mass loading by transducers",
    valid="Valid while the mass is rigid and moves along its sensor only.")
