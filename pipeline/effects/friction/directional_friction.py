"""Friction of contacts that depends on the direction: (1 + a) mu forwards, (1 - a) mu backwards.

Forwards is slip along the tangent of the contact, with the drive turning as it counts.
"""

from dataclasses import replace

from pipeline.effects.effect import Effect
from pipeline.inference.priors import Parameter, Uniform


def parameters(typical):
    return (Parameter("asymmetry", "1", 0.1, Uniform(-0.5, 0.5), null=0.0),)


def apply(bench, location, values):
    asymmetry = values["asymmetry"]
    if asymmetry == 0:
        return bench
    return bench.with_friction(location, lambda friction: _leaning(friction, asymmetry))


def _leaning(friction, asymmetry):
    law = replace(friction.law, friction=(1 + asymmetry) * friction.law.friction)
    return replace(friction, law=law, backward=friction.backward * (1 - asymmetry) / (1 + asymmetry))


EFFECT = Effect(
    name="directional_friction", summary="contacts whose friction depends on the direction of sliding",
    location="contact", stage="friction", parameters=parameters, apply=apply, linear=("asymmetry",),
    source="B. Armstrong-Helouvry, P. Dupont, C. Canudas de Wit, Automatica 30 (1994) 1083",
    valid="Valid while surfaces keep their texture; simulation, roots and equation see it.")
