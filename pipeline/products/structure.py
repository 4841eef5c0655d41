"""The disc brake as FE bodies."""

from pipeline.contract import Array, count, part, parts, product, quantity, text
from pipeline.products.bodies import Body, Incidence


@product(version=7)
class Structure:
    """FE bodies of the brake, their joints, contacts and sensors, and the solved preload."""

    body_name: Array = text("body", "bodies in order: disc, pad_outer, pad_inner, caliper, and of bracket, piston those that there are")
    disc: Body = part("brake disc on its mount")
    pad_outer: Body = part("pad with backplate on the finger side, z > 0")
    pad_inner: Body = part("pad with backplate on the piston side, z < 0")
    caliper: Body = part("caliper with fingers and cylinder")
    others: dict[str, Body] = parts("bracket and piston, where they are bodies")
    lining_exponent: Array = quantity("1", "", "n: moduli of the linings over those of the bodies are (p / lining_pressure)^n at a nominal pressure p")
    lining_pressure: Array = quantity("Pa", "", "pressure at which the linings have the moduli of the bodies")
    mesh_note: Array = text("note", "mesh files of the bodies: what they hold and was not read, where materials come from, their ties; none without a file")
    mesh_given: Array = text("given", "values that mesh files give and the case does not state, as in disc.young")
    free_frequency: Array = quantity("Hz", "free_mode", "natural frequencies of the free disc, without rigid-body motions")
    free_diameters: Array = count("free_mode", "nodal diameters of the free-disc modes")
    free_out_of_plane: Array = quantity("1", "free_mode", "fraction of modal mass that moves along the axis")
    joint_name: Array = text("joint", "joint names, e.g. abutment_outer_leading")
    joint_rows: Incidence = part("joint elongation rows (both ends included; a joint to ground has one end)")
    joint_stiffness: Array = quantity("N/m", "joint", "joint stiffness, linearised about the preload")
    joint_damping: Array = quantity("N s/m", "joint", "joint damping, beside the loss factor")
    joint_loss_factor: Array = quantity("1", "joint", "imaginary over real part of the joint stiffness")
    contact_body: Array = count("contact", "body that slides on the disc at the contact, index into body_name")
    contact_position: Array = quantity("m", "contact xyz", "centroid of the contact patch on the disc face")
    contact_area: Array = quantity("m^2", "contact", "area of the contact patch")
    contact_normal: Incidence = part("normal relative displacement, pad minus disc, positive opens")
    contact_tangent: Incidence = part("relative displacement pad minus disc along sliding")
    contact_lateral: Incidence = part("relative displacement pad minus disc radially outwards")
    pressure: Array = quantity("Pa", "pressure", "nominal pad pressures at which the preload was solved")
    preload: Array = quantity("N", "pressure contact", "static normal contact force")
    contact_stiffness: Array = quantity("N/m", "pressure contact", "normal contact stiffness about the preload, 0 when open")
    closed: Array = count("pressure contact", "1 where the contact is closed")
    law_closure: Array = quantity("m", "closure", "closure (minus gap) axis of the normal contact law, from 0")
    law_pressure: Array = quantity("Pa", "closure", "contact pressure at each closure")
    sensor_name: Array = text("sensor", "sensor names")
    sensor_position: Array = quantity("m", "sensor xyz", "sensor positions")
    sensor_direction: Array = quantity("1", "sensor xyz", "sensor directions, unit vectors")
    sensor_rows: Incidence = part("sensor displacement rows")
    piston_rows: Incidence = part("a row for each pad that pistons press: opening force pair between cylinder and pistons, or backplate without a piston")
    piston_area: Array = quantity("m^2", "", "pad area on which the nominal pressure acts; piston force = pressure * area")
    fluid_stiffness: Array = quantity("N/m", "line", "fluid column between pistons and cylinders, along each piston row; none without a piston")
    fluid_loss_factor: Array = quantity("1", "line", "imaginary over real part of that stiffness")
    line_inertia: Array = quantity("kg", "line", "inertia of the fluid in the line, on which the column ends, per piston motion")
    line_drag: Array = quantity("N s/m", "line", "flow resistance of the line, per piston motion")

    def body(self, name):
        """The Body called ``name``."""
        return self.others[name] if name in self.others else getattr(self, name)
