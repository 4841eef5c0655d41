"""A joint whose stiffness swings: F = s k cos(2 pi f t - phase) e, beside the joint's own k e.

Where a drive turns, the stiffness follows its angle, as of a meshing gear or a shaft that is not round: f is its
frequency at the nominal speed of the drive.
"""

import numpy as np

from pipeline.effects.attached import beside_joint
from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, LogNormal, LogUniform, Parameter, Uniform
from pipeline.physics.time_stepping.elements import Parametric

#: fastest swing of a joint that no drive turns, over the natural frequency
_FASTEST = 20.0


def parameters(typical):
    if typical.drive > 0:
        frequency = typical.drive / (2 * np.pi)
        swings = LogNormal(frequency, 1.0)
    else:
        natural = 1 / (2 * np.pi * typical.period)      # what swings less than once in the longest run is a drift
        frequency, swings = 2 * natural, LogUniform(min(1 / typical.time, natural), _FASTEST * natural)
    return (Parameter("share", "1", 0.1, HalfNormal(0.2), null=0.0),
            Parameter("frequency", "Hz", frequency, swings),
            Parameter("phase", "rad", 0.0, Uniform(-np.pi, np.pi)))


def apply(bench, location, values):
    angular, speed = 2 * np.pi * values["frequency"], abs(bench.model.speed)
    order, frequency = (angular / speed, 0.0) if speed > 0 else (0.0, values["frequency"])
    law = Parametric(values["share"] * bench.joint(location)[1], order, frequency, values["phase"])
    return beside_joint(bench, "parametric_stiffness", location, law)


EFFECT = Effect(
    name="parametric_stiffness", summary="a joint whose stiffness swings", location="joint", stage="structure",
    parameters=parameters, apply=apply, small=False, linear=("share",), elaborate=True,
    source="A. H. Nayfeh, D. T. Mook, Nonlinear Oscillations (1979), chapter 5: parametrically excited systems",
    valid="Valid while the stiffness swings as one harmonic, once in the longest run at least, and starts with the "
          "same phase in every run.")
