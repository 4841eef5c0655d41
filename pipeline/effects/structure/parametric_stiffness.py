"""A joint whose stiffness swings: F = s k cos(2 pi f t - phase) e, beside the joint's own k e.

Where a drive turns, the stiffness follows its angle, as of a meshing gear or a shaft that is not round: f is its
frequency at the nominal speed of the drive.
"""

import numpy as np

from pipeline.effects.attached import beside_joint
from pipeline.effects.effect import Effect
from pipeline.inference.priors import HalfNormal, LogNormal, Parameter, Uniform
from pipeline.physics.time_stepping.elements import Parametric


def parameters(typical):
    frequency = typical.drive / (2 * np.pi) if typical.drive > 0 else 1 / (np.pi * typical.period)
    return (Parameter("share", "1", 0.1, HalfNormal(0.2), null=0.0),
            Parameter("frequency", "Hz", frequency, LogNormal(frequency, 1.0), within=(1 / typical.time, np.inf)),
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
