"""A brake of lumps as ReducedModel, for tests of later stages: a disc, two pads that shift and tilt, a caliper.

The pads lie at the top of the disc (angle 90 degrees), where sliding is along -x. Coordinates: disc z | outer pad x, y,
z, tilt about the radial axis | inner pad likewise | caliper z.
"""

from dataclasses import replace

import numpy as np

from pipeline.products import FrictionMap, ReducedModel
from stages.reduced_model import NO_LINING, NO_SHEAR, plain

RADIUS, HALF_LENGTH, CONTACT_AREA = 0.12, 0.03, 3e-4
DISC, OUTER, INNER, CALIPER, SIZE = 0, 1, 5, 9, 10
PLACES = (-HALF_LENGTH, 0.0, HALF_LENGTH)


def small_brake(abutment=3e6, finger=6e7, damping=2e-6):
    """ReducedModel with the given stiffness of abutments and fingers, N/m, and joint damping per stiffness, s."""
    names, rows, stiffness = joints(abutment, finger)
    normal, tangent, lateral, position = contacts()
    visible, visible_body, recovery = surface()
    count, closure = len(normal), np.linspace(0, 2e-5, 50)
    return ReducedModel(
        body_name=["disc", "pad_outer", "pad_inner", "caliper"], coordinate_body=[0, *[1] * 4, *[2] * 4, 3],
        mass=np.diag([1.0, *[0.25, 0.25, 0.25, 6e-5] * 2, 1.5]), damping=np.zeros((SIZE, SIZE)),
        gyroscopic=np.zeros((SIZE, SIZE)), stiffness=np.diag([1e8, *[0.0] * 9]), centrifugal=np.zeros((SIZE, SIZE)),
        loss=np.zeros((SIZE, SIZE)), joint_name=names, joint_rows=rows, joint_stiffness=stiffness,
        joint_damping=damping * stiffness, joint_loss_factor=0 * stiffness,
        contact_body=[1, 1, 1, 2, 2, 2], contact_position=position, contact_area=np.full(count, CONTACT_AREA),
        contact_lever=np.hypot(*position[:, :2].T), contact_gap=np.zeros(count),
        contact_normal=normal, contact_tangent=tangent, contact_lateral=lateral, pressure=[1e6, 3e6],
        preload=np.outer([1e6, 3e6], np.full(count, CONTACT_AREA)), contact_stiffness=np.full((2, count), 3e7),
        **NO_SHEAR, **NO_LINING, **plain(count, 1, 1),
        law_closure=closure, law_pressure=1e11 * closure + 5e15 * closure**2, input_name=["piston"],
        input_rows=[axial(INNER) - axial(CALIPER - 2)], input_area=[3 * CONTACT_AREA], history_interval=0.0,
        input_history=np.empty((0, 1)), drive_history=[], sensor_name=["disc"], sensor_quantity=["velocity"],
        sensor_unit=["m/s"], sensor_gain=[1.0],
        sensor_position=[[0, RADIUS, 0]], sensor_direction=[[0, 0, 1]], sensor_rows=[np.eye(SIZE)[DISC]],
        visible_position=visible, visible_body=visible_body, visible_face=[[0, 1, 3, 2]], recovery=recovery)


def stiffening_brake(times):
    """The small brake with ``times`` the stiffness of linings in which pads open and turn; it grows as the root of the
    pressure from the first state on."""
    brake, lined, lining = small_brake(), np.array([3, 4, 7, 8]), times * np.diag([4e7, 3e3, 4e7, 3e3])
    stiffness, loss = brake.stiffness.copy(), brake.loss.copy()
    stiffness[np.ix_(lined, lined)] += lining
    loss[np.ix_(lined, lined)] += 0.02 * lining
    return replace(brake, stiffness=stiffness, loss=loss, lining_coordinate=lined, lining_stiffness=lining,
                   lining_loss_factor=0.02, lining_exponent=0.5, lining_pressure=brake.pressure[0])


def small_map():
    """Friction that rises with pressure and distance and falls with speed."""
    pressure, speed, distance = np.array([1e6, 2e6, 3e6]), np.array([0.9, 1.2, 1.5]), np.array([0.0, 5e-3, 1e-2])
    friction = 0.4 + 0.02 * (pressure[:, None, None] / 1e6 - 2) - 0.02 * (speed[:, None] - 1.2) + 10 * distance
    return FrictionMap(pressure=pressure, speed=speed, distance=distance, friction=friction,
                       friction_std=0 * friction, normal_stiffness=np.full((3, 3), 1e11), computed_pressure=pressure,
                       computed_speed=speed, best_pressure=np.full(3, 2e6), pressure_slope_std=np.full(3, 0.01),
                       speed_slope_std=np.full(3, 0.01), error_correlation=np.tile(np.eye(3), (3, 1, 1)),
                       bulk_temperature=0.0)


def axial(pad, place=0.0):
    """Row of the axial displacement of a pad at ``place`` along sliding (for the caliper: its first coordinate - 2)."""
    row = np.zeros(SIZE)
    row[pad + 2] = 1.0
    if place:
        row[pad + 3] = place
    return row


def along(pad, height):
    """Row of a pad's displacement along sliding at ``height`` above its centre."""
    row = np.zeros(SIZE)
    row[pad], row[pad + 3] = -1.0, -height
    return row


def joints(abutment, finger):
    unit, table = np.eye(SIZE), [("guide_pin", np.eye(SIZE)[CALIPER], 1e6)]
    for name, pad in (("outer", OUTER), ("inner", INNER)):
        table += [(f"abutment_{name}_along", unit[pad], abutment), (f"abutment_{name}_radial", unit[pad + 1], abutment),
                  (f"abutment_{name}_tilt", HALF_LENGTH * unit[pad + 3], abutment)]
    table += [(f"finger_{i}", axial(OUTER, s) - unit[CALIPER], finger) for i, s in enumerate(PLACES[::2])]
    table += [("piston", axial(INNER) - unit[CALIPER], 1e6)]
    names, rows, stiffness = zip(*table, strict=True)
    return names, np.array(rows), np.array(stiffness)


def contacts():
    """Rows (normal, tangent, lateral) and positions of three contacts on each pad."""
    disc, normal, tangent, lateral, position = np.eye(SIZE)[DISC], [], [], [], []
    for pad, side in ((OUTER, 1.0), (INNER, -1.0)):
        for place in PLACES:
            angle = np.pi / 2 + place / RADIUS
            normal.append(side * (axial(pad, place) - disc))
            tangent.append(along(pad, -side * 0.008))
            lateral.append(np.eye(SIZE)[pad + 1])
            position.append([RADIUS * np.cos(angle), RADIUS * np.sin(angle), side * 0.003])
    return tuple(np.array(rows) for rows in (normal, tangent, lateral, position))


def surface():
    """Four corners of each pad: positions, bodies, recovery."""
    position, body, recovery = [], [], []
    for number, (pad, side) in enumerate(((OUTER, 1.0), (INNER, -1.0)), 1):
        for place in PLACES[::2]:
            for height in (-0.008, 0.008):
                x, y = -along(pad, height), np.eye(SIZE)[pad + 1]
                position.append([-place, RADIUS, side * 0.011 + height])
                body.append(number)
                recovery.append([x, y, axial(pad, place)])
    return position, body, np.array(recovery, np.float32)
