"""A spring from a point to the ground: F = k x along the direction of its sensor, as of a fixture or a cable."""

from pipeline.effects.attached import at_point
from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, Parameter


def parameters(typical):
    return (Parameter("stiffness", "N/m", 0.1 * typical.holding, HalfNormal(0.4 * typical.holding), null=0.0),)


def apply(bench, location, values):
    return at_point(bench, "stiffness", location, values["stiffness"])


EFFECT = Effect(
    name="added_stiffness", summary="a support at a point that the model leaves out", location="point",
    stage="structure", parameters=parameters, apply=apply, linear=("stiffness",),
    source="D. J. Ewins, Modal Testing, 2nd ed. (2000): supports of the structure",
    valid="Valid while the support is elastic and does not lift off.")
