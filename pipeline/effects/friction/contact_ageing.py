"""Contact ageing: friction grows with the age of the contact spots, as in rate-and-state friction.

    mu (1 + b ln(1 + v_0 theta / L)),    theta' = 1 - |v| theta / L

In steady sliding theta = L / |v|: friction is mu (1 + b ln(1 + v_0 / |v|)), and gets there over the way L after a
change. The direct effect of the speed is left to the law of friction itself.
"""

from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, LogNormal, Parameter
from pipeline.physics.friction.state_variables import Healing

#: sampling intervals that the typical delay takes
_DELAY = 5


def parameters(typical):
    size = _DELAY * typical.speed * typical.interval
    return (Parameter("share", "1", 0.05, HalfNormal(0.1), null=0.0),
            Parameter("speed", "m/s", typical.speed, LogNormal(typical.speed, 1.0)),
            Parameter("length", "m", size, LogNormal(size, 1.0)))


def apply(bench, location, values):
    if values["share"] == 0:
        return bench
    state = Healing(values["share"], values["speed"], values["length"])
    return bench.with_friction(location, lambda friction: friction.with_state(state))


EFFECT = Effect(
    name="contact_ageing", summary="friction that grows with the age of the contact", location="contact",
    stage="friction", parameters=parameters, apply=apply, linear=("share",),
    source="J. H. Dieterich, J. Geophys. Res. 84 (1979) 2161; A. Ruina, J. Geophys. Res. 88 (1983) 10359, ageing law",
    valid="Valid while contact spots age by the time that they meet; simulation, roots and equation see it.")
