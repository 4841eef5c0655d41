"""Settings of the bodies of a disc brake: geometry, material, mesh."""

from typing import ClassVar, Literal

from pipeline.case_models.bodies.mesh_files import FromMesh
from pipeline.contract import InputFile, Names, Quantity, Section, option


class Disc(FromMesh):
    """Stepped disc, its mount and its mesh."""

    only_with: ClassVar[dict] = {
        "hat_height": ("hat_thickness",), "vane_count": ("vane_share", "cheek_thickness"),
        "hole_count": ("hole_rows", "hole_diameter")}

    ring_inner_radius: Quantity("m", gt=0) = option("66.2 mm", "inner radius of the friction ring")
    ring_outer_radius: Quantity("m", gt=0) = option("156.7 mm", "outer radius of the friction ring")
    ring_thickness: Quantity("m", gt=0) = option("6.87 mm", "thickness of the friction ring")
    bore_radius: Quantity("m", gt=0) = option("35.1 mm", "radius of the bore")
    web_thickness: Quantity("m", gt=0) = option("4.26 mm", "thickness of the web, flush with the inner face or on"
                                                " the hat")
    hat_height: Quantity("m", ge=0) = option("0 mm", "by how much a hat raises the web above the inner face; 0 = none")
    hat_thickness: Quantity("m", gt=0) = option("6 mm", "thickness of the wall of the hat, inside the ring")
    vane_count: int = option(0, "radial vanes between the two cheeks of a ventilated ring; 0 = solid", ge=0)
    vane_share: float = option(0.4, "share of the circumference that they fill", gt=0, lt=1)
    cheek_thickness: Quantity("m", gt=0) | None = option(None, "thickness of each cheek of a ventilated ring")
    hole_count: int = option(0, "holes along the axis on each of hole_rows circles of the ring; 0 = none; with vanes"
                                " they lie between them", ge=0)
    hole_rows: int = option(2, "circles of holes, evenly over the ring, neighbours staggered", ge=1)
    hole_diameter: Quantity("m", gt=0) | None = option(None, "their diameter")
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
    mount_group: str | None = option(None, "set of nodes or surface of the mesh file that the hub holds rigidly; none ="
                                           " the inner face within the pressure cones of the bolts")


class Pad(FromMesh):
    """Annular pad: orthotropic lining on a steel backplate; a mesh file is that of the outer pad."""

    of_material: ClassVar[tuple] = (
        *(f"lining_{name}" for name in ("young_radial", "young_tangential", "young_normal", "poisson", "shear_normal",
                                        "shear_in_plane", "density")),
        "backplate_young", "backplate_poisson", "backplate_density")
    only_with: ClassVar[dict] = {
        "chamfer_length": ("chamfer_depth",), "slot_width": ("slot_depth",), "added_mass": ("added_mass_at",),
        "shim_rubber_thickness": ("shim_cover_thickness", *(f"shim_rubber_{name}" for name in (
            "shear", "poisson", "density", "loss_factor"))),
        "lining_pressure_exponent": ("lining_pressure",)}

    inner_radius: Quantity("m", gt=0) = option("95 mm", "inner radius")
    outer_radius: Quantity("m", gt=0) = option("150 mm", "outer radius")
    angle: Quantity("rad", gt=0, lt=3) = option("50 deg", "angle that the pad spans")
    lining_thickness: Quantity("m", gt=0) = option("11 mm", "thickness of the friction lining")
    backplate_thickness: Quantity("m", gt=0) = option("5.5 mm", "thickness of the backplate")
    chamfer_length: Quantity("m", ge=0) = option("0 mm", "chamfers at both ends of the lining: length along sliding"
                                                 " that each takes from its face, at the mean radius")
    chamfer_depth: Quantity("m", gt=0) | None = option(None, "their height above the face")
    slot_width: Quantity("m", ge=0) = option("0 mm", "radial slot in the middle of the lining: width at the mean"
                                             " radius")
    slot_depth: Quantity("m", gt=0) | None = option(None, "its depth from the face")
    added_mass: Quantity("kg", ge=0) = option("0 g", "weights on the ends of the backplate of each pad, in all")
    added_mass_at: Literal["both", "leading", "trailing"] = option("both", "ends that bear them, each the same")
    shim_rubber_thickness: Quantity("m", ge=0) = option("0 mm", "shims on the backs of the backplates: thickness of the"
                                                        " rubber between backplate and cover; 0 = none")
    shim_cover_thickness: Quantity("m", gt=0) = option("0.5 mm", "thickness of their covers, of the steel of the"
                                                       " backplate")
    shim_rubber_shear: Quantity("Pa", gt=0) = option("20 MPa", "shear modulus of the rubber at frequencies of squeal"
                                                     " and the temperature of the shim")
    shim_rubber_poisson: float = option(0.48, "Poisson's ratio of the rubber", gt=0, lt=0.499)
    shim_rubber_density: Quantity("kg/m^3", gt=0) = option("1200 kg/m^3", "density of the rubber")
    shim_rubber_loss_factor: float = option(0.5, "loss factor of the rubber", ge=0)
    lining_young_radial: Quantity("Pa", gt=0) = option("6 GPa", "bulk Young's modulus of the lining, radial")
    lining_young_tangential: Quantity("Pa", gt=0) = option("6 GPa", "bulk Young's modulus of the lining, along sliding")
    lining_young_normal: Quantity("Pa", gt=0) = option("1.5 GPa", "bulk Young's modulus of the lining through its"
                                                       " thickness; not the asperity modulus"
                                                       " micro_friction.pad.youngs_modulus")
    lining_poisson: float = option(0.2, "Poisson's ratios of the lining", gt=-0.5, lt=0.5)
    lining_shear_normal: Quantity("Pa", gt=0) = option("1.2 GPa", "shear moduli with the thickness direction")
    lining_shear_in_plane: Quantity("Pa", gt=0) = option("2.5 GPa", "in-plane shear modulus")
    lining_softening: Quantity("1/K", ge=0) = option("0 1/K", "share of its moduli that the lining loses per kelvin of"
                                                     " friction_map.bulk_temperature")
    lining_pressure_exponent: float = option(0.0, "n: moduli of the lining grow as (p / lining_pressure)^n with the"
                                             " nominal pressure p of the pads", ge=0, lt=1)
    lining_pressure: Quantity("Pa", gt=0) = option("1 MPa", "pressure at which the moduli of the lining are stated")
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
    lining_set: str = option("LINING", "set of elements, or material, of the mesh file that is the lining")
    inner_mesh_file: InputFile | None = option(None, "mesh file of the inner pad, in the same units; none = that of the"
                                                     " outer one, mirrored unless inner_mesh_sets are named")
    inner_mesh_sets: Names = option((), "sets of elements of the file that are the inner pad")


class Caliper(FromMesh):
    """Caliper: fingers, bridge and solid housing; a fixed one has a housing on both sides."""

    fixed: bool = option(False, "fixed: pistons and a housing on both sides of the disc, bolted on where guide pins"
                                " would be; else floating")
    inner_radius: Quantity("m", gt=0) = option("97 mm", "inner radius of fingers and housing")
    bridge_inner_radius: Quantity("m", gt=0) = option("162 mm", "inner radius of the bridge over the rim")
    bridge_outer_radius: Quantity("m", gt=0) = option("180 mm", "outer radius of the bridge")
    angle: Quantity("rad", gt=0, lt=3) = option("48 deg", "angle that the caliper spans")
    finger_thickness: Quantity("m", gt=0) = option("15 mm", "thickness of the finger plate")
    housing_depth: Quantity("m", gt=0) = option("45 mm", "depth of the cylinder housing, on both sides"
                                                 " of a fixed caliper")
    piston_gap: Quantity("m", gt=0) = option("4 mm", "distance of housing and backplate")
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


class Bracket(FromMesh):
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
    element_size: Quantity("m", gt=0) = option("10 mm", "largest edge of an element, about")
    corner_cells: int = option(0, "elements, at least, on each side of a re-entrant corner, whose size shrinks towards"
                                  " it; 0: all are equal", ge=0)


class Fluid(Section):
    """Brake fluid behind the piston and in the line to the master cylinder, which holds the pressure."""

    bulk_modulus: Quantity("Pa", gt=0) = option("1.5 GPa", "bulk modulus")
    density: Quantity("kg/m^3", gt=0) = option("1050 kg/m^3", "density")
    viscosity: Quantity("Pa s", gt=0) = option("10 mPa s", "dynamic viscosity")
    passage_volume: Quantity("m^3", ge=0) = option("1 cm^3", "fluid beside that of the bores of one pad, up to"
                                                      " the line")
    line_length: Quantity("m", gt=0) = option("1 m", "length of the line")
    line_diameter: Quantity("m", gt=0) = option("3.3 mm", "inner diameter of the line")
    loss_factor: float = option(0.0, "loss factor of the fluid column", ge=0)


class Seal(Section):
    """No piston body: its seal acts between housing and backplate."""

    kind: Literal["seal"] = "seal"


class Piston(FromMesh):
    """Pistons, cups whose rims bear on the backplates, in bores of the housing: all of them one body."""

    kind: Literal["body"] = "body"
    count: int = option(1, "pistons on a pad, beside one another along sliding", ge=1, le=2)
    spacing: Quantity("m", gt=0) = option("52 mm", "distance of two pistons along sliding")
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
