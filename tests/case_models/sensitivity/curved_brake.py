"""The small brake with a contact law and a friction that curve, in tables so fine that their steps are no matter."""

from dataclasses import replace

import numpy as np

from stages.complex_modes import Settings as Modes
from stages.complex_modes import complex_modes
from stages.reduced_model import Settings as Reduction
from stages.reduced_model import reduced_model
from tests.stages.small_structure import small_friction_map, small_structure


def curved_law(rows):
    """(closure, pressure) of p = 0.1 MPa (exp(c / 4 um) - 1)."""
    closure = np.linspace(0, 2e-5, rows)
    return closure, 1e5 * np.expm1(closure / 4e-6)


def curved_map(rows, level=0.6):
    """FrictionMap of ``level`` + 0.03 ln(p / 1 MPa) - 0.02 v s/m."""
    pressure, speed = np.geomspace(1e4, 1e7, rows), np.linspace(0.05, 20, 21)
    friction = level + 0.03 * np.log(pressure / 1e6)[:, None, None] - 0.02 * speed[:, None] + np.zeros(2)
    return replace(small_friction_map(level), pressure=pressure, speed=speed, friction=friction,
                   friction_std=0 * friction, normal_stiffness=np.full((len(pressure), 2), 1e12))


def curved_brake(law_rows=400001, map_rows=20001):
    """(Structure, ReducedModel, FrictionMap, ComplexModes)."""
    structure, law, friction = small_structure(), curved_law(law_rows), curved_map(map_rows)
    model = replace(reduced_model(structure, settings=Reduction(fixed_below="20 kHz")), law_closure=law[0],
                    law_pressure=law[1])
    modes = complex_modes(model, friction, settings=Modes(friction_steps=2, speeds=("8 rad/s", "12 rad/s"),
                                                          frequency_max="8 kHz", followed=0))
    return structure, model, friction, modes
