"""The pin on disc as FE bodies, and its lock-in."""

import numpy as np

from pipeline.contract import Array, count, part, product, quantity, text
from pipeline.products.bodies import Body, Incidence


@product(version=3)
class PinOnDisc:
    """Pin and disc as FE bodies with hub, clamp and guide, their contact and sensors, and the load states.

    The names of Structure, where the thing is the same; the rubbed body is the pin.
    """

    body_name: Array = text("body", "bodies in order: disc, pin")
    disc: Body = part("disc on hub, collar and shaft")
    pin: Body = part("pin with accelerometer and clamp block")
    joint_name: Array = text("joint", "joint names, e.g. guide")
    joint_rows: Incidence = part("joint elongation rows; all joints of the clamp end on the ground")
    joint_stiffness: Array = quantity("N/m", "joint", "joint stiffness")
    joint_damping: Array = quantity("N s/m", "joint", "joint damping, beside the loss factor")
    joint_loss_factor: Array = quantity("1", "joint", "imaginary over real part of the joint stiffness")
    contact_body: Array = count("contact", "body that slides on the disc at the contact, index into body_name")
    contact_position: Array = quantity("m", "contact xyz", "centroid of the contact patch on the disc face")
    contact_area: Array = quantity("m^2", "contact", "area of the contact patch")
    contact_normal: Incidence = part("normal relative displacement, pin minus disc, positive opens")
    contact_tangent: Incidence = part("relative displacement pin minus disc along sliding")
    contact_lateral: Incidence = part("relative displacement pin minus disc radially outwards")
    load: Array = quantity("kg", "pressure", "weights on the pin")
    pressure: Array = quantity("Pa", "pressure", "nominal contact pressure of each weight")
    preload: Array = quantity("N", "pressure contact", "static normal contact force")
    contact_stiffness: Array = quantity("N/m", "pressure contact", "normal contact stiffness about the preload")
    closed: Array = count("pressure contact", "1 where the contact is closed")
    law_closure: Array = quantity("m", "closure", "closure (minus gap) axis of the normal contact law; none = hard contact")
    law_pressure: Array = quantity("Pa", "closure", "contact pressure at each closure")
    shear_pressure: Array = quantity("Pa", "shear", "nominal pressures of the tangential contact law")
    shear_friction: Array = quantity("1", "shear", "coefficient of friction at each of them")
    shear_stiffness: Array = quantity("Pa/m", "shear", "tangential stiffness at rest per area, evolution rule")
    shear_elastic_stiffness: Array = quantity("Pa/m", "shear", "tangential stiffness per area of the elastic stick")
    shear_exponent: Array = quantity("1", "shear", "exponent of the evolution rule")
    friction: Array = quantity("1", "pressure", "coefficient of friction of that law at each weight")
    disc_frequency: Array = quantity("Hz", "disc_mode", "natural frequencies of the disc on its shaft")
    disc_diameters: Array = count("disc_mode", "nodal diameters of the modes of the disc")
    disc_out_of_plane: Array = quantity("1", "disc_mode", "fraction of modal mass that moves along the axis")
    pin_length: Array = quantity("m", "pin_length", "free lengths of the pin: that of the case, then those compared")
    pin_frequency: Array = quantity("Hz", "pin_length pin_mode", "natural frequencies of the pin, rigidly clamped, not touching")
    tilt: Array = quantity("rad", "", "tilt of the pin, positive if the clamp is upstream")
    contact_offset: Array = quantity("m", "", "offset of the contact from the centre of the tip, along sliding")
    base_mass: Array = quantity("kg", "", "mass that moves with the clamp")
    sensor_name: Array = text("sensor", "sensor names")
    sensor_position: Array = quantity("m", "sensor xyz", "sensor positions")
    sensor_direction: Array = quantity("1", "sensor xyz", "sensor directions, unit vectors")
    sensor_rows: Incidence = part("sensor displacement rows")
    load_rows: Incidence = part("row of the weight: it presses the clamp towards the disc")
    load_area: Array = quantity("m^2", "", "contact area on which the nominal pressure acts; load = pressure * area")

    def body(self, name):
        """The Body called ``name``."""
        return getattr(self, name)


@product(version=2)
class LockIn:
    """Complex modes and settled motion of the pin on disc over its length, load, speed and angle, one row per point."""

    scan: Array = text("point", "what is varied: length, load, speed or tilt; case = the points compared with the paper")
    length: Array = quantity("m", "point", "free length of the pin")
    load: Array = quantity("kg", "point", "weight on the pin")
    speed: Array = quantity("rad/s", "point", "speed of the disc")
    tilt: Array = quantity("rad", "point", "tilt of the pin, positive if the clamp is upstream")
    base_mass: Array = quantity("kg", "point", "mass that moves with the clamp")
    friction: Array = quantity("1", "point", "coefficient of friction")
    root: Array = quantity("1/s", "point", "root of the fastest growing mode, sigma + i omega; 0 where none grows", complex)
    disc_mode: Array = quantity("Hz", "point", "natural frequency of the disc nearest the base or root, 0 where neither is")
    pin_mode: Array = quantity("Hz", "point", "natural frequency of the pin nearest the base or root, 0 where neither is")
    kind: Array = text("point", "none, classical, intermediate, multiple, dual base or other")
    base: Array = quantity("Hz", "point", "base frequency of the settled motion of the disc, 0 = none")
    second: Array = quantity("Hz", "point", "second base or distance of side bands, 0 = none")
    settled: Array = count("point", "1 where the amplitudes of disc and pin no longer change in the window, or nothing grows")
    amplitude: Array = quantity("m/s", "point body", "effective velocity along the disc's axis: disc, pin")
    harmonics: Array = count("point body", "base and multiples without a gap in the spectrum of disc, pin")
    levels: Array = quantity("1", "point body multiple", "level in dB of multiples re the base: disc, pin; -200 = no line")
    open_share: Array = quantity("1", "point", "fraction of the time without contact")
    trace_time: Array = quantity("s", "sample", "time of the last milliseconds of the motion")
    trace: Array = quantity("m/s", "case body sample", "velocity along the disc's axis at the cases: disc, pin", np.float32)
    frequency: Array = quantity("Hz", "line", "lines of the spectra")
    spectrum: Array = quantity("1", "case body line", "level in dB re the highest line, of that velocity in the window",
                               np.float32)
