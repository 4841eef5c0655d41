"""Half-sine pulses: exact moments whatever lies between samples, and the exact response of modes to them."""

import numpy as np
import pytest
import scipy

from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.time_stepping.simulate import Hard
from pipeline.physics.virtual_rig.half_sine import SPREAD, HalfSine, spectrum
from pipeline.physics.virtual_rig.response import Bench, Run, respond
from pipeline.physics.virtual_rig.sensor import DISPLACEMENT, VELOCITY, Sensor
from tests.physics.lumps import lumps

WIDTHS = [0.1, 0.5, 1.5, 5.0, 40.0]
#: samples a period of the slower mode; the faster one of MASSES has 7
SLOW = 20
STIFFNESS, LOSS = np.array([1.0, 1.4]), 0.01
IMPULSE, CENTRE, SAMPLES = 0.7, 30.37, 200


def matrix(modes):
    """Stiffness matrix of one mass of 1 kg on a spring, or two in a chain whose frequencies are as 2.86 to 1."""
    return np.array([[1.0]]) if modes == 1 else np.array([[STIFFNESS.sum(), -STIFFNESS[1]], [-STIFFNESS[1], STIFFNESS[1]]])


def rig(modes, steps):
    """(Bench struck at its last mass, sampled ``steps`` to an interval, rate in Hz)."""
    rate = SLOW * np.sqrt(scipy.linalg.eigvalsh(matrix(modes))[0]) / (2 * np.pi)
    rows = [[1.0]] if modes == 1 else [[1.0, 0.0], [-1.0, 1.0]]
    model = lumps([1.0] * modes, rows, STIFFNESS[:modes], LOSS * STIFFNESS[:modes])
    seen = tuple(Sensor(f"{q.name} {k}", q, f"sensor_{k}") for k in range(modes) for q in (DISPLACEMENT, VELOCITY))
    return model, Bench(model, Hard(), constant(0.0), 1 / (steps * rate), seen), rate
