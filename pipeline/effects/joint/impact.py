"""A stop in a joint, hit with a restitution: beyond the elongation g, a spring with a damper that pushes back alone.

    F = max(0, k (e - g) + c v)    for e > g,    g = 1 / inverse_gap    (below g for inverse_gap < 0)

Bodies of the mass m that the joint feels leave the stop with the restitution exp(-(pi - 2 alpha) tan(alpha)) of their
speed, sin(alpha) = c / (2 sqrt(k m)), which is solved for c. The step is shortened to what resolves the stop.
"""

from dataclasses import replace

import numpy as np
import scipy

from pipeline.effects.attached import beside_joint
from pipeline.effects.effect import Effect
from pipeline.effects.resolved import felt_mass, resolving_step
from pipeline.inference.priors import LogNormal, Normal, Parameter, Uniform
from pipeline.physics.time_stepping.elements import Stop

#: restitutions of an under-damped stop end at exp(-2)
_LOWEST = 0.15


def parameters(typical):
    size, stop = 4 / typical.length, 30 * typical.holding
    return (Parameter("inverse_gap", "1/m", 0.0, Normal(0.0, 2 * size), null=0.0),
            Parameter("restitution", "1", 0.6, Uniform(_LOWEST, 1.0)),
            Parameter("stiffness", "N/m", stop, LogNormal(stop, 0.7)))


def apply(bench, location, values):
    inverse, stiffness = values["inverse_gap"], values["stiffness"]
    if inverse == 0:
        return bench
    mass = felt_mass(bench, bench.joint(location)[0])
    damping = 2 * np.sin(loss_angle(values["restitution"])) * np.sqrt(stiffness * mass)
    side = {"upper" if inverse > 0 else "lower": 1 / abs(inverse)}
    bench = replace(bench, step=min(bench.step, resolving_step(mass, stiffness)))
    return beside_joint(bench, "impact", location, Stop(stiffness, damping, **side))


def loss_angle(restitution):
    """alpha of a restitution between exp(-2) and 1."""
    return 0.0 if restitution == 1 else scipy.optimize.brentq(
        lambda alpha: np.log(restitution) + (np.pi - 2 * alpha) * np.tan(alpha), 0.0, 0.5 * np.pi - 1e-6)


EFFECT = Effect(
    name="impact", summary="a stop in a joint that is hit and gives back part of the speed", location="joint",
    stage="structure", parameters=parameters, apply=apply, elaborate=True,
    source="T. Schwager, T. Poeschel, Granular Matter 9 (2007) 465: spring and damper that do not pull",
    valid="Valid while the stop is hit by the bodies that the joint feels as one mass, on one side.")
