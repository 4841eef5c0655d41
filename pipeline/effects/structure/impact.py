"""A stop in front of a point, hit with a restitution: a spring and a damper that push back alone.

    F = max(0, k (x - g) + c v)    for x > g,    g = 1 / inverse_gap    (below g for inverse_gap < 0)

x is the displacement along the direction of the sensor. Bodies of the mass m that the point feels leave the stop with
the restitution exp(-(pi - 2 alpha) tan(alpha)) of their speed, sin(alpha) = c / (2 sqrt(k m)), which is solved for c.
The step is shortened to about 100 in a period of the mass on the stop.
"""

from dataclasses import replace

import numpy as np
import scipy

from pipeline.effects.effect import Effect
from pipeline.effects.resolved import felt_mass, resolving_step
from pipeline.inference.priors import LogNormal, Normal, Parameter, Uniform
from pipeline.physics.time_stepping.elements import Element, Stop

#: restitutions of an under-damped stop end at exp(-2)
_LOWEST = 0.15
#: steps that follow a blow, over those that resolve its spring
_FINER = 12


def parameters(typical):
    size, stop = 4 / typical.length, 30 * typical.holding
    return (Parameter("inverse_gap", "1/m", 0.0, Normal(0.0, 2 * size), null=0.0),
            Parameter("restitution", "1", 0.6, Uniform(_LOWEST, 1.0)),
            Parameter("stiffness", "N/m", stop, LogNormal(stop, 0.7)))


def apply(bench, location, values):
    inverse, stiffness = values["inverse_gap"], values["stiffness"]
    if inverse == 0:
        return bench
    row = bench.sensor(location)
    mass = felt_mass(bench, row)
    damping = 2 * np.sin(loss_angle(values["restitution"])) * np.sqrt(stiffness * mass)
    side = {"upper" if inverse > 0 else "lower": 1 / abs(inverse)}
    bench = replace(bench, step=min(bench.step, resolving_step(mass, stiffness) / _FINER))
    return bench.with_elements(Element(f"impact {location}", row, Stop(stiffness, damping, **side)))


def loss_angle(restitution):
    """alpha of a restitution between exp(-2) and 1."""
    return 0.0 if restitution == 1 else scipy.optimize.brentq(
        lambda alpha: np.log(restitution) + (np.pi - 2 * alpha) * np.tan(alpha), 0.0, 0.5 * np.pi - 1e-6)


EFFECT = Effect(
    name="impact", summary="a stop that a point hits, and that gives back part of the speed", location="point",
    stage="structure", parameters=parameters, apply=apply, elaborate=True,
    source="T. Schwager, T. Poeschel, Granular Matter 9 (2007) 465: spring and damper that do not pull",
    valid="Valid while the stop is hit by bodies that the point feels as one mass, on one side.")
