"""Moisture: friction depends on the humidity h of the run, mu (1 + s (h - 1/2)), never below 0.

h is the condition ``humidity`` of a run, relative, 0 to 1. Runs without it are refused.
"""

from dataclasses import replace

from pipeline.effects.effect import Effect
from pipeline.inference.priors import Normal, Parameter
from pipeline.physics.friction.dry_friction import Condition

#: relative humidity at which nominal friction holds
_REFERENCE = 0.5


def parameters(typical):
    return (Parameter("slope", "1", 0.2, Normal(0.0, 0.5), null=0.0),)


def apply(bench, location, values):
    if values["slope"] == 0:
        return bench
    damp = Condition("humidity", values["slope"], _REFERENCE)
    return bench.with_friction(location, lambda friction: replace(friction, conditions=(*friction.conditions, damp)))


EFFECT = Effect(
    name="moisture", summary="friction that depends on the humidity of the air", location="contact", stage="friction",
    parameters=parameters, apply=apply, linear=("slope",), conditions=("humidity",),
    source="P. J. Blau, Friction Science and Technology (2009): humidity",
    valid="Valid while humidity is the same all over a run; simulation, roots and equation see it.")
