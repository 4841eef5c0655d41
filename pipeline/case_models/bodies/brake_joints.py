"""Settings of the joints of a disc brake, and of its pads pressed on the disc at rest."""

from typing import ClassVar, Literal

from pipeline.contract import Quantity, Section, option


class Joints(Section):
    """Springs and dampers of the parts that are not meshed."""

    abutment_stiffness: Quantity("N/m", gt=0) = option("50 MN/m", "trailing abutment of a pad, along sliding")
    clip_stiffness: Quantity("N/m", gt=0) = option("1 MN/m", "clip at the leading end of a pad, along sliding")
    abutment_radial_stiffness: Quantity("N/m", gt=0) = option("5 MN/m", "abutment of a pad end, radial")
    finger_stiffness: Quantity("N/m", gt=0) = option("400 MN/m", "fingers of a floating caliper on the outer"
                                                     " backplate, normal")
    finger_shear_stiffness: Quantity("N/m", gt=0) = option("20 MN/m", "fingers on the outer backplate, each direction"
                                                           " in the plane")
    piston_stiffness: Quantity("N/m", gt=0) = option("0.1 MN/m", "seal of one piston, normal; the pressure is held,"
                                                     " so the brake fluid adds none")
    piston_shear_stiffness: Quantity("N/m", gt=0) = option("20 MN/m", "one piston on its backplate, each direction"
                                                           " in the plane")
    guide_pin_stiffness: Quantity("N/m", gt=0) = option("20 MN/m", "one guide pin across its axis")
    guide_pin_axial_stiffness: Quantity("N/m", gt=0) = option("100 kN/m", "boot of one guide pin, axial")
    shim_stiffness: Quantity("N/m", gt=0) = option("400 MN/m", "one piston body on its backplate, normal")
    seal_stiffness: Quantity("N/m", gt=0) = option("5 MN/m", "seal of a piston body in its bore, each direction"
                                                   " across the axis; along it piston_stiffness")
    mount_stiffness: Quantity("N/m", gt=0) = option("200 MN/m", "one bolt of the bracket with the knuckle behind it,"
                                                    " each direction")
    bolt_stiffness: Quantity("N/m", gt=0) = option("200 MN/m", "one bolt of a fixed caliper with what is behind it,"
                                                   " each direction")
    left_out: tuple[Literal["abutment", "finger", "piston", "guide_pin", "bolt", "seal", "mount"], ...] = option(
        (), "kinds of joints that the springs of a deck stand for instead")
    abutment_loss_factor: float = option(0.0, "loss factor of abutments and clips, in both directions", ge=0)
    finger_loss_factor: float = option(0.0, "loss factor of the fingers on the backplate", ge=0)
    piston_loss_factor: float = option(0.0, "loss factor of piston seal and piston on the backplate", ge=0)
    guide_pin_loss_factor: float = option(0.0, "loss factor of guide pins and boots", ge=0)
    seal_loss_factor: float = option(0.0, "loss factor of the seal of a piston body", ge=0)
    mount_loss_factor: float = option(0.0, "loss factor of the mount of the bracket", ge=0)
    bolt_loss_factor: float = option(0.0, "loss factor of the bolts of a fixed caliper", ge=0)
    loss_time: Quantity("s", ge=0) = option("5 us", "viscous damping over stiffness of every joint, beside the loss"
                                            " factors; damping that rises with frequency")
    clamping_radius: Quantity("m", gt=0) = option("122 mm", "radius of the centre of fingers and piston")
    clamping_height: Quantity("m", gt=0) = option("32 mm", "radial distance of their bearing spots")
    finger_distance: Quantity("m", gt=0) = option("60 mm", "distance of the fingers along sliding")
    piston_distance: Quantity("m", gt=0) = option("32 mm", "distance of the piston's bearing spots along sliding")
    guide_pin_radius: Quantity("m", gt=0) = option("150 mm", "radius of the guide pins, or of the bolts of a"
                                                      " fixed caliper")
    spot_size: Quantity("m", gt=0) = option("6 mm", "size of a bearing spot")


class PressedPads(Section):
    """Pads held on a disc that does not turn: contacts stick, and are stiff in proportion to their pressure."""

    only_with: ClassVar[dict] = {"force": ("stiffness", "tangential_stiffness")}

    force: Quantity("N", ge=0) = option("0 N", "force of the piston on the pads; 0 = pads lifted off the disc")
    stiffness: Quantity("Pa/m", gt=0) = option("1 MPa/um", "normal stiffness per area at the mean pressure, as"
                                               " normal_stiffness of the product friction_map")
    tangential_stiffness: Quantity("Pa/m", gt=0) = option("0.8 MPa/um", "the same along the disc, both ways")
