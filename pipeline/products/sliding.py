"""The reduced sliding model, common to all systems."""

import numpy as np

from pipeline.contract import Array, count, product, quantity, text


@product(version=9)
class ReducedModel:
    """The reduced sliding model: everything that a solver or an effect needs to know of a sliding system.

    Equation of motion, s = sliding, q = reduced coordinates:
        M q'' + (C + speed G + sum_j c_j b_j b_j^T) q'
              + (K + speed^2 Kc + sum_j k_j b_j b_j^T) q = sum_i (n_i N_i + t_i T_i) + inputs,
    N_i >= 0 the contact force on the pad along its normal row n_i, T_i = mu N_i along its tangent row t_i. A contact
    whose normal row is zero is a friction joint: nothing presses it but its preload. Without a normal contact law
    (size 0) contacts stay as their preload state says; those with a contact_stiffness of 0 as well are hard.
    """

    body_name: Array = text("body", "bodies in order")
    coordinate_body: Array = count("coordinate", "body of each reduced coordinate, index into body_name")
    mass: Array = quantity("kg", "coordinate column", "reduced mass")
    damping: Array = quantity("N s/m", "coordinate column", "reduced damping of the bodies")
    gyroscopic: Array = quantity("N s^2/m", "coordinate column", "gyroscopic matrix per rad/s of disc speed")
    stiffness: Array = quantity("N/m", "coordinate column", "reduced stiffness of the bodies, without joints and contacts")
    centrifugal: Array = quantity("kg", "coordinate column", "stiffness per squared disc speed")
    loss: Array = quantity("N/m", "coordinate column", "imaginary part of the stiffness of the bodies, by loss factors")
    lining_coordinate: Array = count("lining", "coordinates in which linings deform")
    lining_stiffness: Array = quantity("N/m", "lining lining_column", "the part of the stiffness that scales with the moduli of the linings")
    lining_loss_factor: Array = quantity("1", "", "loss factor of the linings, part of 'loss'; 0 without linings")
    lining_exponent: Array = quantity("1", "", "n: that part times (p / lining_pressure)^n holds at a nominal pressure p")
    lining_pressure: Array = quantity("Pa", "", "pressure at which 'stiffness' and 'loss' hold")
    joint_name: Array = text("joint", "joint names")
    joint_rows: Array = quantity("1", "joint coordinate", "joint elongation rows")
    joint_stiffness: Array = quantity("N/m", "joint", "joint stiffness")
    joint_damping: Array = quantity("N s/m", "joint", "joint damping, beside the loss factor")
    joint_loss_factor: Array = quantity("1", "joint", "imaginary over real part of the joint stiffness")
    contact_name: Array = text("contact", "names that the case gives to contacts; empty where it names none")
    contact_body: Array = count("contact", "body that slides on the drive at the contact")
    contact_position: Array = quantity("m", "contact xyz", "centroid of the contact patch")
    contact_area: Array = quantity("m^2", "contact", "area of the contact patch")
    contact_lever: Array = quantity("m", "contact", "sliding speed per speed of the drive: the radius on a disc, 1 m on a belt")
    contact_gap: Array = quantity("m", "contact", "gap without load, negative for an initial overlap")
    contact_normal: Array = quantity("1", "contact coordinate", "normal rows, pad minus disc, positive opens")
    contact_tangent: Array = quantity("1", "contact coordinate", "tangent rows, pad minus disc, along sliding")
    contact_lateral: Array = quantity("1", "contact coordinate", "lateral rows, pad minus disc, radial")
    pressure: Array = quantity("Pa", "pressure", "nominal pad pressures of the preload states")
    preload: Array = quantity("N", "pressure contact", "static normal contact force")
    contact_stiffness: Array = quantity("N/m", "pressure contact", "normal contact stiffness about the preload")
    law_closure: Array = quantity("m", "closure", "closure axis of the normal contact law")
    law_pressure: Array = quantity("Pa", "closure", "contact pressure at each closure")
    shear_pressure: Array = quantity("Pa", "shear", "nominal pressures of the tangential contact law; none = no such law")
    shear_friction: Array = quantity("1", "shear", "coefficient of friction at each of them")
    shear_stiffness: Array = quantity("Pa/m", "shear", "tangential stiffness at rest per area, evolution rule")
    shear_elastic_stiffness: Array = quantity("Pa/m", "shear", "tangential stiffness per area of the elastic stick")
    shear_exponent: Array = quantity("1", "shear", "exponent of the evolution rule")
    input_name: Array = text("input", "inputs, e.g. piston")
    input_rows: Array = quantity("1", "input coordinate", "input rows: generalised force per unit input force")
    input_joint: Array = text("input", "joint whose far end the input moves; empty: the input is a force")
    input_scale: Array = quantity("1", "input", "N (m of a moved end) per SI unit of what is fed to the input")
    input_area: Array = quantity("m^2", "input", "input force per nominal pad pressure")
    history_interval: Array = quantity("s", "", "time between the samples of the histories, which begin at time 0")
    input_history: Array = quantity("N", "sample input", "input forces over time, added to the former; none = constant")
    drive_history: Array = quantity("1", "drive_sample", "speed of the drive over time, per nominal speed; none = 1")
    sensor_name: Array = text("sensor", "sensor names")
    sensor_position: Array = quantity("m", "sensor xyz", "sensor positions")
    sensor_direction: Array = quantity("1", "sensor xyz", "sensor directions")
    sensor_rows: Array = quantity("1", "sensor coordinate", "sensor displacement rows")
    sensor_turns: Array = count("sensor", "1 where it sees rotations at a radius of 1 m, where metres are radians")
    turning: Array = text("turning", "joints.NAME, inputs.NAME and masses.NAME about an axis: radians and N m at a radius of 1 m")
    sensor_quantity: Array = text("sensor", "measured quantity: displacement, velocity or acceleration")
    sensor_unit: Array = text("sensor", "unit of its reading")
    sensor_gain: Array = quantity("1", "sensor", "its reading in that unit per SI unit of its quantity")
    visible_position: Array = quantity("m", "visible xyz", "surface nodes kept for pictures")
    visible_body: Array = count("visible", "body of the surface nodes")
    visible_face: Array = count("face corner", "quadrilaterals of the surface, row numbers of visible_position")
    recovery: Array = quantity("1", "visible xyz coordinate", "displacement of the surface nodes per coordinate", np.float32)
