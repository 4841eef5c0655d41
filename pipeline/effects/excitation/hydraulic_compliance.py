"""A load that acts through fluid: it falls as the pad moves on, and recovers as the line refills.

    F = F_in - z,    z' = k v - z / tau

k is the stiffness of the enclosed fluid and its hoses along the input, v the speed along it. An ideal line has k = 0;
tau is long where the line is narrow or closed: it may lie anywhere between a radian of the motion and a whole run.
"""

import numpy as np

from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, LogNormal, Parameter
from pipeline.physics.time_stepping.elements import Element, Maxwell


def parameters(typical):
    size, shortest = 0.1 * (typical.stiffness or typical.force / typical.length), min(typical.period, typical.time)
    middle, spread = np.sqrt(shortest * typical.time), max(0.25 * np.log(typical.time / shortest), 0.5)
    return (Parameter("stiffness", "N/m", size, HalfNormal(2 * size), null=0.0),
            Parameter("time", "s", middle, LogNormal(middle, spread)))


def apply(bench, location, values):
    law = Maxwell(np.array([values["stiffness"]]), np.array([values["time"]]))
    return bench.with_elements(Element(f"hydraulic_compliance {location}", bench.input(location)[0], law))


EFFECT = Effect(
    name="hydraulic_compliance", summary="a load that falls as the pad moves on, until the line refills",
    location="input", stage="structure", parameters=parameters, apply=apply, linear=("stiffness",),
    source="R. Limpert, Brake Design and Safety, 2nd ed. (1999), chapter 5: volume and stiffness of brake fluid",
    valid="Valid below the first frequency of the line itself; every run starts with the pressure in balance.")
