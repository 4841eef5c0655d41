"""Contact memory: friction follows pressure and sliding speed over a memory length L.

    T = mu(p_m, v_m) A p_m,    p_m' = (|v| / L) (p - p_m),    v_m' = (|v| / L) (|v| - v_m)

Growth rates against speed show it: the delay is L / |v|. L = 0 is friction without delay.
"""

from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, Parameter
from pipeline.physics.friction.state_variables import Memory

#: sampling intervals that the typical delay takes
_DELAY = 5


def parameters(typical):
    size = _DELAY * typical.speed * typical.interval
    return (Parameter("length", "m", size, HalfNormal(2 * size), null=0.0),)


def apply(bench, location, values):
    if values["length"] == 0:
        return bench
    return bench.with_friction(location, lambda friction: friction.with_state(Memory(values["length"])))


EFFECT = Effect(
    name="contact_memory", summary="friction that follows pressure and speed with a delay", location="contact",
    stage="friction", parameters=parameters, apply=apply,
    source="V. Prakash, J. Tribol. 120 (1998) 97; for the speed A. Ruina, J. Geophys. Res. 88 (1983) 10359, slip law",
    valid="Valid on contacts that yield (Penalty, Table); simulation, roots and equation see it.")
