"""Masses on springs and dampers."""

from pipeline.contract import Array, count, product, quantity, text


@product(version=4)
class Lumped:
    """Masses on springs and dampers, their contacts, inputs and sensors: a sliding model without finite elements.

    Coordinates are named as mass.motion (block.x); a rotation counts as the way in m at a radius of 1 m.
    """

    body_name: Array = text("body", "masses in order")
    coordinate_name: Array = text("coordinate", "coordinates in order, e.g. block.x")
    coordinate_body: Array = count("coordinate", "mass of each coordinate, index into body_name")
    mass: Array = quantity("kg", "coordinate column", "mass matrix")
    gyroscopic: Array = quantity("N s^2/m", "coordinate column", "gyroscopic matrix per rad/s of drive speed")
    joint_name: Array = text("joint", "springs and dampers")
    joint_rows: Array = quantity("1", "joint coordinate", "elongation rows")
    joint_stiffness: Array = quantity("N/m", "joint", "stiffness")
    joint_damping: Array = quantity("N s/m", "joint", "damping")
    contact_name: Array = text("contact", "contacts and friction joints")
    contact_body: Array = count("contact", "mass that the friction force acts on")
    contact_position: Array = quantity("m", "contact xyz", "position relative to the axis of the drive, z")
    contact_area: Array = quantity("m^2", "contact", "contact area")
    contact_lever: Array = quantity("m", "contact", "sliding speed per speed of the drive")
    contact_gap: Array = quantity("m", "contact", "gap without load, negative for an initial overlap")
    contact_normal: Array = quantity("1", "contact coordinate", "normal rows, positive opens; zero: a friction joint")
    contact_tangent: Array = quantity("1", "contact coordinate", "tangent rows along sliding")
    contact_lateral: Array = quantity("1", "contact coordinate", "lateral rows")
    pressure: Array = quantity("Pa", "pressure", "load factors in Pa: 1 Pa stands for the loads as given")
    preload: Array = quantity("N", "pressure contact", "static normal force")
    contact_stiffness: Array = quantity("N/m", "pressure contact", "normal contact stiffness, 0 where hard or open")
    law_closure: Array = quantity("m", "closure", "closure axis of the normal contact law, empty where hard")
    law_pressure: Array = quantity("Pa", "closure", "contact pressure at each closure")
    input_name: Array = text("input", "inputs")
    input_rows: Array = quantity("1", "input coordinate", "generalised force per unit input force")
    input_joint: Array = text("input", "joint whose far end the input moves; empty: the input is a force")
    input_scale: Array = quantity("1", "input", "N (m of a moved end) per SI unit of what is fed to the input")
    input_area: Array = quantity("m^2", "input", "constant input force per Pa of the load factor")
    history_interval: Array = quantity("s", "", "time between the samples of the histories")
    input_history: Array = quantity("N", "sample input", "input forces over time, added to the constant ones")
    drive_history: Array = quantity("1", "drive_sample", "speed of the drive over time, per nominal speed")
    sensor_name: Array = text("sensor", "sensors")
    sensor_rows: Array = quantity("1", "sensor coordinate", "displacement rows")
    sensor_turns: Array = count("sensor", "1 where it sees rotations at a radius of 1 m, where metres are radians")
    turning: Array = text("turning", "joints.NAME, inputs.NAME and masses.NAME about an axis: radians and N m at a radius of 1 m")
    sensor_quantity: Array = text("sensor", "measured quantity: displacement, velocity or acceleration")
    sensor_unit: Array = text("sensor", "unit of its reading")
    sensor_gain: Array = quantity("1", "sensor", "its reading in that unit per SI unit of its quantity")
