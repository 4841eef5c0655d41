"""One mass on a spring and, if wanted, on a belt, as ReducedModel: the smallest sliding models."""

import numpy as np

from pipeline.products import ReducedModel
from stages.reduced_model import NO_LINING, NO_SHEAR, plain

MASS, DAMPING, STIFFNESS, NORMAL_FORCE = 2.0, 3.0, 800.0, 10.0


def small_oscillator(on_belt=False, hard=False):
    """ReducedModel of a mass in x; ``on_belt``: with a friction joint of NORMAL_FORCE; ``hard``: a hard contact."""
    count = int(on_belt or hard)
    row = np.ones((count, 1))
    return ReducedModel(
        body_name=["block"], coordinate_body=[0], mass=[[MASS]], damping=[[DAMPING]], gyroscopic=[[0.0]],
        stiffness=[[STIFFNESS]], centrifugal=[[0.0]], loss=[[0.0]], joint_name=[],
        joint_rows=np.empty((0, 1)), joint_stiffness=[], joint_damping=[], joint_loss_factor=[],
        contact_body=[0] * count, contact_position=np.zeros((count, 3)), contact_area=np.ones(count),
        contact_lever=np.ones(count), contact_gap=np.zeros(count), contact_normal=float(hard) * row,
        contact_tangent=row, contact_lateral=0 * row, pressure=[1.0], preload=np.full((1, count), NORMAL_FORCE),
        contact_stiffness=np.zeros((1, count)), **NO_SHEAR, **NO_LINING, **plain(count, 0, 1), law_closure=[],
        law_pressure=[], input_name=[], input_rows=np.empty((0, 1)), input_area=[], history_interval=0.0,
        input_history=np.empty((0, 0)), drive_history=[], sensor_name=["block"], sensor_position=[[0, 0, 0]],
        sensor_direction=[[1, 0, 0]], sensor_rows=[[1.0]], sensor_quantity=["velocity"], sensor_unit=["m/s"],
        sensor_gain=[1.0], visible_position=np.empty((0, 3)), visible_body=[],
        visible_face=np.empty((0, 4), int), recovery=np.empty((0, 3, 1)))
