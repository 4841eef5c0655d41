"""Friction that depends on pressure: mu(p) = mu_0(p) (p / p_0)^(-a), p_0 the reference pressure.

a = 1/3 is one elastic sphere whose friction goes with its area; a brake pad that fades under load has a > 0.
"""

import numpy as np

from pipeline.effects.effect import Effect
from pipeline.effects.friction.friction_table import times
from pipeline.inference.priors import LogNormal, Normal, Parameter

#: pressures that the law spans on both sides of the reference, and samples between
_SPAN, _SAMPLES = 1e3, 400


def parameters(typical):
    return (Parameter("exponent", "1", 0.1, Normal(0.0, 0.15), null=0.0),
            Parameter("pressure", "Pa", typical.pressure, LogNormal(typical.pressure, 0.1)))


def apply(bench, location, values):
    samples = values["pressure"] * np.geomspace(1 / _SPAN, _SPAN, _SAMPLES)

    def factor(pressure):
        return np.clip(pressure, samples[0], samples[-1]) ** -values["exponent"] / (
            values["pressure"] ** -values["exponent"])

    return bench.with_friction(location, lambda friction: times(friction, "pressure", samples, factor))


EFFECT = Effect(
    name="pressure_dependent_friction", summary="friction that changes with pressure", location="contact",
    stage="friction", parameters=parameters, apply=apply,
    source="F. P. Bowden, D. Tabor, The Friction and Lubrication of Solids (1950), chapter 5",
    valid="Valid from a thousandth to a thousand times the reference pressure, beyond which friction stays the same.")
