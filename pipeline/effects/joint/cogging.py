"""Cogging: a force that repeats along a joint, F = s sin(2 pi e / period) + c cos(2 pi e / period), beside its own.

Magnets that prefer some positions, teeth of a belt, a pinion out of round: it does no work over a period. A recording
says next to nothing of the period before it is known from the number of teeth or poles.
"""

from pipeline.effects.attached import beside_joint
from pipeline.effects.effect import Effect
from pipeline.inference.priors import LogNormal, Normal, Parameter
from pipeline.physics.time_stepping.elements import Detent


def parameters(typical):
    size = 0.1 * typical.force
    return (Parameter("sine", "N", 0.0, Normal(0.0, size), null=0.0),
            Parameter("cosine", "N", 0.0, Normal(0.0, size), null=0.0),
            Parameter("period", "m", typical.length, LogNormal(typical.length, 0.5)))


def apply(bench, location, values):
    return beside_joint(bench, "cogging", location, Detent(values["sine"], values["cosine"], values["period"]))


EFFECT = Effect(
    name="cogging", summary="a force that repeats along a joint", location="joint", stage="structure",
    parameters=parameters, apply=apply, linear=("sine", "cosine"), weighed=False,
    source="J. R. Hendershot, T. J. E. Miller, Design of Brushless Permanent-Magnet Machines (2010), chapter 3",
    valid="Valid while the force repeats as one harmonic of the position; its period is stated, not found.")
