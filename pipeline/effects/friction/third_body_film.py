"""Third-body film: wear particles build a film in the contact that adds to friction.

    mu (1 + g x),    x' = (|v| / d) (p / p_0 - x)

The film grows over the sliding way d to a thickness in proportion to the pressure; every run starts without it. At
asperities it is a factor on their shear limit.
"""

from dataclasses import replace

from pipeline.effects.effect import Effect
from pipeline.effects.typical import ASPERITIES
from pipeline.inference.priors import HalfNormal, LogNormal, Parameter
from pipeline.physics.friction.state_variables import Film


def parameters(typical):
    size = 0.5 * typical.speed * typical.time
    return (Parameter("gain", "1", 0.2, HalfNormal(0.4), null=0.0),
            Parameter("distance", "m", size, LogNormal(size, 1.0)),
            Parameter("pressure", "Pa", typical.pressure, LogNormal(typical.pressure, 0.1)))


def apply(model, location, values):
    if values["gain"] == 0:
        return model
    state = Film(values["gain"], values["distance"], values["pressure"])
    if location == ASPERITIES:
        return replace(model, shearing=replace(model.shearing, film=state))
    return model.with_friction(location, lambda friction: friction.with_state(state))


EFFECT = Effect(
    name="third_body_film", summary="a film of wear particles that adds to friction", location="contact",
    stage="friction", parameters=parameters, apply=apply, small=False, linear=("gain",), micro=True,
    source="M. Godet, Wear 100 (1984) 437: the third body; its growth with load and way after J. F. Archard (1953)",
    valid="Valid while particles leave the contact as the film slides; roots take friction where a run begins.")
