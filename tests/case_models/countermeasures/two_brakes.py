"""A brake of a few elements with unstable modes, and changed ones, as Brakes: products without a case."""

from dataclasses import replace
from functools import cache

import numpy as np

from pipeline.case_models.countermeasures.nearby_modes import Brake
from pipeline.products import Convergence
from stages.complex_modes import Settings, complex_modes
from stages.reduced_model import Settings as Reduction
from stages.reduced_model import reduced_model
from tests.stages.small_structure import small_friction_map, small_structure

MODES = Settings(friction_steps=2, speeds=("8 rad/s", "12 rad/s"), frequency_max="8 kHz", followed=0)


@cache
def reduced():
    return reduced_model(small_structure(), settings=Reduction(fixed_below="20 kHz"))


@cache
def brake(friction=0.6, loss=1.0, stiffness=1.0):
    """The brake with another friction, and factors on loss factors and stiffnesses of joints and bodies."""
    model = reduced()
    model = replace(model, loss=loss * model.loss, joint_loss_factor=loss * model.joint_loss_factor,
                    damping=loss * model.damping, joint_damping=loss * model.joint_damping,
                    joint_stiffness=stiffness * model.joint_stiffness)
    friction_map = small_friction_map(friction)
    return Brake(complex_modes(model, friction_map, settings=MODES), model, friction_map)


def convergence(**given):
    """Nothing known but a tolerance of a tenth and of 1 1/s."""
    none = np.empty(0, complex)
    return Convergence(**{
        "pressure": 1e6, "speed": 8.0, "refinement": ["bases"], "left_out": [], "left_out_reason": [], "root": none,
        "reduced_root": given.get("root", none), "refined_root": none, "found": [], "held": [], "near_root": none,
        "near_refined": none, "added": 0, "moved_root": none, "cause": [], "cause_change": np.empty((0, 0), complex),
        "freedoms": 1, "refined_freedoms": 1, "contacts": 1, "refined_contacts": 1, "frequency_change": 0.0,
        "growth_change": 0.0, "growth_share": 0.0, "frequency_tolerance": 0.005, "growth_tolerance": 0.1,
        "error_factor": 2.4, "neutral": 1.0, "converged": 1, **given})
