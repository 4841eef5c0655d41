"""Stage structure: finite-element models of the bodies of the brake; real modes, joints, contacts and preload."""

from functools import partial
from typing import Literal

import numpy as np
import scipy

from pipeline.contract import Context, ConvergenceError, InputFile, Quantities, Quantity, Section, option, stage
from pipeline.physics.contact.static_preload import condense, contact_law, solve_preload
from pipeline.physics.fem.supports import free_freedoms, held_modes
from pipeline.physics.friction.friction_table import refuse_beyond
from pipeline.physics.modal.disc_modes import describe
from pipeline.products import FrictionMap, Structure
from pipeline.systems.disc_brake import build
from pipeline.systems.fem_bodies import assembly_fields, body_product, incidence

#: the contact law is tabulated up to so many times the largest nominal pressure
_LAW_RANGE = 20
#: bodies that only some brakes have
OTHERS = ("bracket", "piston")
#: rigid motions of a free body, and the most that their frequencies may be of that of its first mode
_RIGID, _RIGID_SHARE = 6, 0.1


class Disc(Section):
    """Stepped disc, its mount and its mesh."""

    ring_inner_radius: Quantity("m", gt=0) = option("66.2 mm", "inner radius of the friction ring")
    ring_outer_radius: Quantity("m", gt=0) = option("156.7 mm", "outer radius of the friction ring")
    ring_thickness: Quantity("m", gt=0) = option("6.87 mm", "thickness of the friction ring")
    bore_radius: Quantity("m", gt=0) = option("35.1 mm", "radius of the bore")
    web_thickness: Quantity("m", gt=0) = option("4.26 mm", "thickness of the web, flush with the inner face")
    young: Quantity("Pa", gt=0) = option("120 GPa", "Young's modulus")
    poisson: float = option(0.27, "Poisson's ratio", gt=-1, lt=0.5)
    density: Quantity("kg/m^3", gt=0) = option("7200 kg/m^3", "density")
    loss_factor: float = option(0.0, "loss factor of the material: damping of the same share at every frequency", ge=0)
    damping_ratio: float = option(0.001, "damping ratio of the disc modes, beside the loss factor", ge=0)
    bolt_count: int = option(5, "bolts of the mount", ge=1)
    bolt_preload: Quantity("N", gt=0) = option("40 kN", "preload of one bolt")
    bolt_circle_radius: Quantity("m", gt=0) = option("45 mm", "radius of the bolt circle")
    bolt_head_radius: Quantity("m", gt=0) = option("8 mm", "radius under the bolt head")
    flange_roughness: Quantity("m", gt=0) = option("2 um", "rms height Sq of the flange against the hub, both faces")
    web_cells: int = option(4, "elements across the web, radially", ge=2)
    ring_cells: int = option(10, "elements across the ring, radially", ge=1)
    angular_cells: int = option(90, "elements around", ge=8)
    mesh_file: InputFile | None = option(None, "mesh of hexahedra to use instead (meshio, metres, same axes)")


class Pad(Section):
    """Annular pad: orthotropic lining on a steel backplate."""

    inner_radius: Quantity("m", gt=0) = option("95 mm", "inner radius")
    outer_radius: Quantity("m", gt=0) = option("150 mm", "outer radius")
    angle: Quantity("rad", gt=0, lt=3) = option("50 deg", "angle that the pad spans")
    lining_thickness: Quantity("m", gt=0) = option("11 mm", "thickness of the friction lining")
    backplate_thickness: Quantity("m", gt=0) = option("5.5 mm", "thickness of the backplate")
    lining_young_radial: Quantity("Pa", gt=0) = option("6 GPa", "bulk Young's modulus of the lining, radial")
    lining_young_tangential: Quantity("Pa", gt=0) = option("6 GPa", "bulk Young's modulus of the lining, along sliding")
    lining_young_normal: Quantity("Pa", gt=0) = option("1.5 GPa", "bulk Young's modulus of the lining through its"
                                                       " thickness; not the asperity modulus"
                                                       " micro_friction.pad.youngs_modulus")
    lining_poisson: float = option(0.2, "Poisson's ratios of the lining", gt=-0.5, lt=0.5)
    lining_shear_normal: Quantity("Pa", gt=0) = option("1.2 GPa", "shear moduli with the thickness direction")
    lining_shear_in_plane: Quantity("Pa", gt=0) = option("2.5 GPa", "in-plane shear modulus")
    lining_density: Quantity("kg/m^3", gt=0) = option("2600 kg/m^3", "density of the lining")
    backplate_young: Quantity("Pa", gt=0) = option("207 GPa", "Young's modulus of the backplate")
    backplate_poisson: float = option(0.29, "Poisson's ratio of the backplate", gt=-1, lt=0.5)
    backplate_density: Quantity("kg/m^3", gt=0) = option("7820 kg/m^3", "density of the backplate")
    lining_loss_factor: float = option(0.0, "loss factor of the lining", ge=0)
    backplate_loss_factor: float = option(0.0, "loss factor of the backplate, its shim included", ge=0)
    damping_ratio: float = option(0.01, "damping ratio of the pad modes, beside the loss factors", ge=0)
    patches_angular: int = option(6, "contact patches along sliding", ge=1)
    patches_radial: int = option(3, "contact patches across", ge=1)
    cells_per_patch: int = option(2, "elements per patch and direction", ge=1)
    lining_layers: int = option(2, "elements through the lining", ge=1)
    contact_points: int | None = option(None, "contact points per direction on each element face of the lining, which"
                                        " are its integration points; none = one contact for each patch, at its mean",
                                        ge=1)


class Caliper(Section):
    """Floating caliper: fingers, bridge and solid housing."""

    inner_radius: Quantity("m", gt=0) = option("97 mm", "inner radius of fingers and housing")
    bridge_inner_radius: Quantity("m", gt=0) = option("162 mm", "inner radius of the bridge over the rim")
    bridge_outer_radius: Quantity("m", gt=0) = option("180 mm", "outer radius of the bridge")
    angle: Quantity("rad", gt=0, lt=3) = option("48 deg", "angle that the caliper spans")
    finger_thickness: Quantity("m", gt=0) = option("15 mm", "thickness of the finger plate")
    housing_depth: Quantity("m", gt=0) = option("45 mm", "depth of the cylinder housing")
    piston_gap: Quantity("m", gt=0) = option("4 mm", "distance of housing and inner backplate")
    young: Quantity("Pa", gt=0) = option("170 GPa", "Young's modulus")
    poisson: float = option(0.275, "Poisson's ratio", gt=-1, lt=0.5)
    density: Quantity("kg/m^3", gt=0) = option("7100 kg/m^3", "density")
    loss_factor: float = option(0.0, "loss factor of the material", ge=0)
    damping_ratio: float = option(0.004, "damping ratio of the caliper modes, beside the loss factor", ge=0)
    radial_cells: int = option(4, "elements across the fingers, radially", ge=1)
    angular_cells: int = option(8, "elements around", ge=2)
    housing_cells: int = option(3, "elements along the housing", ge=1)
    bridge_cells: int = option(3, "elements along the bridge between housing and fingers", ge=1)


class Ground(Section):
    """No bracket: pads and guide pins are held on the ground."""

    kind: Literal["ground"] = "ground"


class Bracket(Section):
    """Anchor bracket: columns beside the pads, joined under the inner pad and around the rim, bolted to the knuckle.

    Heights are distances from the middle plane of the disc.
    """

    kind: Literal["body"] = "body"
    inner_radius: Quantity("m", gt=0) = option("72 mm", "inner radius of base and columns")
    base_outer_radius: Quantity("m", gt=0) = option("90 mm", "outer radius of the base, which passes under the inner"
                                                    " pad; the arms at the outer pad begin there as well")
    rim_inner_radius: Quantity("m", gt=0) = option("160 mm", "inner radius of the bridges over the rim of the disc")
    rim_outer_radius: Quantity("m", gt=0) = option("174 mm", "outer radius of bridges, columns and arms")
    angle: Quantity("rad", gt=0, lt=3) = option("70 deg", "angle between the outer sides of the columns, which begin at"
                                                " the ends of the pads")
    disc_gap: Quantity("m", gt=0) = option("3 mm", "distance from the faces of the disc")
    arm_height: Quantity("m", gt=0) = option("24 mm", "height of the arms beside the outer pad")
    base_height: Quantity("m", gt=0) = option("32 mm", "height of the base on the inner side")
    column_height: Quantity("m", gt=0) = option("50 mm", "height of the columns on the inner side, where they are"
                                                " bolted on")
    mount_radius: Quantity("m", gt=0) = option("100 mm", "radius of the two bolts")
    mount_width: Quantity("m", gt=0) = option("16 mm", "distance of the two spots on which a bolted face bears")
    young: Quantity("Pa", gt=0) = option("170 GPa", "Young's modulus")
    poisson: float = option(0.275, "Poisson's ratio", gt=-1, lt=0.5)
    density: Quantity("kg/m^3", gt=0) = option("7100 kg/m^3", "density")
    loss_factor: float = option(0.0, "loss factor of the material", ge=0)
    damping_ratio: float = option(0.0, "damping ratio of the bracket modes, beside the loss factor", ge=0)
    element_size: Quantity("m", gt=0) = option("10 mm", "largest edge of an element")


class Fluid(Section):
    """Brake fluid behind the piston and in the line to the master cylinder, which holds the pressure."""

    bulk_modulus: Quantity("Pa", gt=0) = option("1.5 GPa", "bulk modulus")
    density: Quantity("kg/m^3", gt=0) = option("1050 kg/m^3", "density")
    viscosity: Quantity("Pa s", gt=0) = option("10 mPa s", "dynamic viscosity")
    passage_volume: Quantity("m^3", ge=0) = option("1 cm^3", "fluid beside that of the bore, up to the line")
    line_length: Quantity("m", gt=0) = option("1 m", "length of the line")
    line_diameter: Quantity("m", gt=0) = option("3.3 mm", "inner diameter of the line")
    loss_factor: float = option(0.0, "loss factor of the fluid column", ge=0)


class Seal(Section):
    """No piston body: its seal acts between housing and inner backplate."""

    kind: Literal["seal"] = "seal"


class Piston(Section):
    """Piston, a cup whose rim bears on the inner backplate, in the bore of the housing."""

    kind: Literal["body"] = "body"
    diameter: Quantity("m", gt=0) = option("48 mm", "diameter")
    length: Quantity("m", gt=0) = option("34 mm", "length")
    wall: Quantity("m", gt=0) = option("5 mm", "thickness of the wall")
    crown: Quantity("m", gt=0) = option("6 mm", "thickness of the crown, which closes the bore")
    clearance: Quantity("m", gt=0) = option("0.1 mm", "distance from the wall of the bore")
    bore_depth: Quantity("m", gt=0) = option("36 mm", "depth of the bore")
    seal_depth: Quantity("m", gt=0) = option("8 mm", "depth of the middle of the seal in the bore")
    young: Quantity("Pa", gt=0) = option("207 GPa", "Young's modulus")
    poisson: float = option(0.29, "Poisson's ratio", gt=-1, lt=0.5)
    density: Quantity("kg/m^3", gt=0) = option("7820 kg/m^3", "density")
    loss_factor: float = option(0.0, "loss factor of the material", ge=0)
    damping_ratio: float = option(0.0, "damping ratio of the piston modes, beside the loss factor", ge=0)
    angular_cells: int = option(16, "elements around", ge=8, multiple_of=4)
    element_size: Quantity("m", gt=0) = option("10 mm", "largest edge of an element along wall and crown")
    fluid: Fluid = option(Fluid(), "brake fluid")


class Joints(Section):
    """Springs and dampers of the parts that are not meshed."""

    abutment_stiffness: Quantity("N/m", gt=0) = option("50 MN/m", "trailing abutment of a pad, along sliding")
    clip_stiffness: Quantity("N/m", gt=0) = option("1 MN/m", "clip at the leading end of a pad, along sliding")
    abutment_radial_stiffness: Quantity("N/m", gt=0) = option("5 MN/m", "abutment of a pad end, radial")
    finger_stiffness: Quantity("N/m", gt=0) = option("400 MN/m", "fingers on the outer backplate, normal")
    finger_shear_stiffness: Quantity("N/m", gt=0) = option("20 MN/m", "fingers on the outer backplate, each direction"
                                                           " in the plane")
    piston_stiffness: Quantity("N/m", gt=0) = option("0.1 MN/m", "piston seal, normal; the pressure is held, so the"
                                                     " brake fluid adds none")
    piston_shear_stiffness: Quantity("N/m", gt=0) = option("20 MN/m", "piston on the inner backplate, each direction"
                                                           " in the plane")
    guide_pin_stiffness: Quantity("N/m", gt=0) = option("20 MN/m", "one guide pin across its axis")
    guide_pin_axial_stiffness: Quantity("N/m", gt=0) = option("100 kN/m", "boot of one guide pin, axial")
    shim_stiffness: Quantity("N/m", gt=0) = option("400 MN/m", "piston body on the inner backplate, normal")
    seal_stiffness: Quantity("N/m", gt=0) = option("5 MN/m", "seal of a piston body in its bore, each direction"
                                                   " across the axis; along it piston_stiffness")
    mount_stiffness: Quantity("N/m", gt=0) = option("200 MN/m", "one bolt of the bracket with the knuckle behind it,"
                                                    " each direction")
    abutment_loss_factor: float = option(0.0, "loss factor of abutments and clips, in both directions", ge=0)
    finger_loss_factor: float = option(0.0, "loss factor of the fingers on the backplate", ge=0)
    piston_loss_factor: float = option(0.0, "loss factor of piston seal and piston on the backplate", ge=0)
    guide_pin_loss_factor: float = option(0.0, "loss factor of guide pins and boots", ge=0)
    seal_loss_factor: float = option(0.0, "loss factor of the seal of a piston body", ge=0)
    mount_loss_factor: float = option(0.0, "loss factor of the mount of the bracket", ge=0)
    loss_time: Quantity("s", ge=0) = option("5 us", "viscous damping over stiffness of every joint, beside the loss"
                                            " factors; damping that rises with frequency")
    clamping_radius: Quantity("m", gt=0) = option("122 mm", "radius of the centre of fingers and piston")
    clamping_height: Quantity("m", gt=0) = option("32 mm", "radial distance of their bearing spots")
    finger_distance: Quantity("m", gt=0) = option("60 mm", "distance of the fingers along sliding")
    piston_distance: Quantity("m", gt=0) = option("32 mm", "distance of the piston's bearing spots along sliding")
    guide_pin_radius: Quantity("m", gt=0) = option("150 mm", "radius of the guide pins")
    spot_size: Quantity("m", gt=0) = option("6 mm", "size of a bearing spot")


class LaserPoint(Section):
    """A laser point on the friction ring."""

    name: str = option(..., "name of the sensor")
    radius: Quantity("m", gt=0) = option(..., "radius of the point")
    angle: Quantity("rad") = option(..., "angle from the middle of the pads, along the disc's rotation")
    face: Literal["outer", "inner"] = option("outer", "face of the ring")
    direction: Literal["axial", "radial", "tangential"] = option("axial", "measured component")


class Settings(Section):
    """Geometry, materials, joints, meshes and preload."""

    disc: Disc = option(Disc(), "brake disc")
    pad: Pad = option(Pad(), "both pads")
    caliper: Caliper = option(Caliper(), "caliper")
    bracket: Ground | Bracket = option(Ground(), "what holds pads and guide pins", discriminator="kind")
    piston: Seal | Piston = option(Seal(), "what the brake fluid presses on", discriminator="kind")
    joints: Joints = option(Joints(), "joints")
    sensors: tuple[LaserPoint, ...] = option(
        tuple({"name": f"ring_{angle}", "radius": "150 mm", "angle": f"{angle} deg"} for angle in (90, 120, 150, 210)),
        "points on the friction ring", min_length=1)
    pressures: Quantities("Pa", gt=0) = option(("1 MPa", "2 MPa", "3 MPa"), "nominal pad pressures of the preload")
    sliding_distance: Quantity("m", ge=0) = option("10 mm", "sliding distance at which the interface is taken")
    frequency_max: Quantity("Hz", gt=0) = option("20 kHz", "modes of all bodies below it")
    free_frequency_max: Quantity("Hz", gt=0) = option("4.5 kHz", "modes of the free disc below it")


@stage
def structure(friction_map: FrictionMap, settings: Settings, context: Context) -> Structure:
    """Mesh the bodies of the brake, and compute preload and real modes.

    Method:
    Disc, pads, caliper, and bracket and piston where declared, were meshed with quadratic hexahedra (95 % of the
    stiffness by 2 x 2 x 2 integration); joints between them are springs and dampers. The disc is clamped where the
    bolts press it onto a rigid hub. The normal contact law follows from the interface stiffness after
    {sliding_distance} of sliding; the preload is static and frictionless. Real modes were computed below
    {frequency_max}.
    """
    brake = build(settings)
    free, *modes = _all_modes(brake, settings, context)
    bodies = {name: body_product(body, *results)
              for name, body, results in zip(brake.names, brake.bodies, modes, strict=True)}
    others = {name: bodies.pop(name) for name in brake.names if name in OTHERS}
    law = _law(friction_map, settings)
    diameters, out_of_plane = describe(brake.bodies[0].mesh.node, free[1])
    return Structure(
        body_name=brake.names, **bodies, others=others, free_frequency=free[0], free_diameters=diameters,
        free_out_of_plane=out_of_plane,
        **assembly_fields(brake), sensor_name=[s.name for s in settings.sensors],
        **_preload(brake, law, settings, context), law_closure=law[0], law_pressure=law[1],
        piston_rows=incidence(brake.piston), piston_area=brake.pad_area, **_fluid(brake.fluid, settings.piston))


def _fluid(column, piston):
    """Fields of the fluid column behind a piston body; empty without one."""
    if column is None:
        return {name: [] for name in ("fluid_stiffness", "fluid_loss_factor", "line_inertia", "line_drag")}
    return {"fluid_stiffness": [column.stiffness], "fluid_loss_factor": [piston.fluid.loss_factor],
            "line_inertia": [column.inertia], "line_drag": [column.drag]}


def _all_modes(brake, settings, context):
    """(frequency, shape (3n, m)) of the free disc without rigid motions, then of the bodies on their supports."""
    disc = brake.bodies[0]
    tasks = [(disc, np.empty(0, int), settings.free_frequency_max)]
    tasks += [(body, body.supported, settings.frequency_max) for body in brake.bodies]
    results = context.map(partial(_modes, context.solver), tasks, "real modes")
    frequency, shape = results[0]
    if len(frequency) > _RIGID and frequency[_RIGID - 1] > _RIGID_SHARE * frequency[_RIGID]:
        raise ConvergenceError("structure: free disc", "six rigid motions far below its first mode",
                               f"frequencies {', '.join(f'{f:.4g}' for f in frequency[:_RIGID + 1])} Hz",
                               "check the mesh of the disc: it must be one body")
    return [(frequency[_RIGID:], shape[:, _RIGID:]), *results[1:]]


def _modes(solver, task):
    body, supported, below = task
    return held_modes(*body.matrices(), supported, solver, below=below)


def _law(friction_map, settings):
    """Closure and pressure of the interface at the sliding distance, which the map must reach."""
    refuse_beyond(settings.sliding_distance, friction_map.distance[-1], "structure.sliding_distance")
    stiffness = [np.interp(settings.sliding_distance, friction_map.distance, row)
                 for row in friction_map.normal_stiffness]
    return contact_law(friction_map.pressure, stiffness, _LAW_RANGE * max(settings.pressures))


def _preload(brake, law, settings, context):
    """Contact force, stiffness and status at every pressure."""
    stiffness = scipy.sparse.block_diag([body.matrices()[0] for body in brake.bodies], format="csr")
    joints = brake.joints.rows.matrix
    stiffness = stiffness + joints.T @ scipy.sparse.diags(brake.joints.stiffness) @ joints
    sizes = np.cumsum([0, *(3 * len(b.mesh.node) for b in brake.bodies)])
    free = np.concatenate([first + free_freedoms(len(b.mesh.node), b.supported)
                           for first, b in zip(sizes, brake.bodies, strict=False)])
    normal, piston = (rows.matrix[:, free] for rows in (brake.contacts.normal, brake.piston))
    compliance, closure = condense(stiffness[free][:, free], normal, piston.toarray()[0] * brake.pad_area,
                                   context.solver)
    preloads = [solve_preload(compliance, p * closure, brake.contacts.area, *law) for p in settings.pressures]
    return {"pressure": settings.pressures, "preload": [f.force for f in preloads],
            "contact_stiffness": [f.stiffness for f in preloads], "closed": [f.closed.astype(int) for f in preloads]}
