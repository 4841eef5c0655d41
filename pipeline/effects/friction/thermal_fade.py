"""Thermal fade: friction falls with one lumped temperature of the contact, which friction power heats.

    mu / (1 + d x),    tau x' = |T| |v| / (A q) - x

x is the temperature in units of what the power q per area would reach; every run starts cold.
"""

from pipeline.effects.effect import Effect
from pipeline.effects.warming import warming_time
from pipeline.inference.priors import HalfNormal, LogNormal, Parameter
from pipeline.physics.friction.state_variables import Fade


def parameters(typical):
    heat = typical.pressure * typical.speed
    return (Parameter("drop", "1", 0.5, HalfNormal(1.0), null=0.0),
            Parameter("heat", "W/m^2", heat, LogNormal(heat, 0.1)),
            warming_time(typical))


def apply(bench, location, values):
    if values["drop"] == 0:
        return bench
    state = Fade(values["drop"], values["heat"], values["time"])
    return bench.with_friction(location, lambda friction: friction.with_state(state))


EFFECT = Effect(
    name="thermal_fade", summary="friction that fades as the contact heats up", location="contact", stage="friction",
    parameters=parameters, apply=apply, small=False,
    source="T. P. Newcomb, R. T. Spurr, Braking of Road Vehicles (1967): fade; one lumped heat capacity",
    valid="Valid while one time constant holds and runs start cold; roots take friction where a run begins.")
