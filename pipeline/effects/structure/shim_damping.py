"""A damping shim at a joint: structural damping, complex stiffness k (1 + i h) in a band about a frequency f.

    F = sum_j F_j - k_0 e,    F_j' = g v - F_j / tau_j,    tau_j = 10^(j / 2) / (2 pi f),  j = -2 .. 2

Branches of one stiffness g, evenly spaced in the logarithm of their time, lose alike at all frequencies between them;
g gives the loss h k at f exactly, k_0 leaves the stiffness at f as it was. The loss is 5 % less at 3.2 f and f / 3.2,
27 % less at 10 f and f / 10.
"""

import numpy as np

from pipeline.effects.attached import beside_joint
from pipeline.effects.effect import Effect
from pipeline.inference.priors import LogNormal, Parameter, Uniform
from pipeline.physics.time_stepping.elements import Maxwell

#: times of the branches in units of 1 / (2 pi f)
_TIMES = 10 ** (np.arange(-2, 3) / 2)
#: loss and stored stiffness at f of branches of 1 N/m
_LOSS, _STORED = np.sum(_TIMES / (1 + _TIMES**2)), np.sum(_TIMES**2 / (1 + _TIMES**2))
#: above it the joint would push away at rest, k < k_0
_LARGEST = 0.5


def parameters(typical):
    frequency = 1 / (2 * np.pi * typical.period)
    return (Parameter("loss_factor", "1", 0.1, Uniform(0.0, _LARGEST), null=0.0),
            Parameter("frequency", "Hz", frequency, LogNormal(frequency, 0.7)))


def apply(bench, location, values):
    each = values["loss_factor"] * bench.joint(location)[1] / _LOSS
    law = Maxwell(np.full(len(_TIMES), each), _TIMES / (2 * np.pi * values["frequency"]), -each * _STORED)
    return beside_joint(bench, "shim_damping", location, law)


EFFECT = Effect(
    name="shim_damping", summary="a constrained layer: the same loss factor over a band of frequencies",
    location="joint", stage="structure", parameters=parameters, apply=apply, linear=("loss_factor",),
    family="damping",
    source="M. A. Biot, Proc. 3rd US Nat. Congr. Appl. Mech. (1958) 1: relaxation spectrum of structural damping;"
           " D. Ross, E. E. Ungar, E. M. Kerwin, Structural Damping (1959): constrained layer",
    valid="Valid from a third to three times the frequency, at one temperature of the shim.")
