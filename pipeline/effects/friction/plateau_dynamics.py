"""Plateau dynamics: contact plateaus grow by themselves and are worn off by friction power.

    mu x,    tau x' = 1 + k - (1 + k p |v| / q) x

Steady sliding gives x = (1 + k) / (1 + k p |v| / q), which is 1 at the power density p |v| = q: friction falls with
pressure and speed, and gets there with a delay of at most tau.
"""

from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, LogNormal, Parameter
from pipeline.physics.friction.state_variables import Plateaus


def parameters(typical):
    heat = typical.pressure * typical.speed
    return (Parameter("strength", "1", 0.3, HalfNormal(0.5), null=0.0),
            Parameter("heat", "W/m^2", heat, LogNormal(heat, 0.1)),
            Parameter("time", "s", 0.2 * typical.time, LogNormal(0.2 * typical.time, 1.0)))


def apply(bench, location, values):
    if values["strength"] == 0:
        return bench
    state = Plateaus(values["strength"], values["heat"], values["time"])
    return bench.with_friction(location, lambda friction: friction.with_state(state))


EFFECT = Effect(
    name="plateau_dynamics", summary="contact plateaus that grow and are worn off", location="contact",
    stage="friction", parameters=parameters, apply=apply,
    source="G. P. Ostermeyer, Wear 254 (2003) 852: the equation of mu, its temperature held",
    valid="Valid while temperature stays the same; simulation, roots and equation see it.")
