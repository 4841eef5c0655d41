"""Stage structure: finite-element models of the bodies of the brake; real modes, joints, contacts and preload."""

from functools import partial
from typing import Literal

import numpy as np
import scipy

from pipeline.case_models.bodies.brake_bodies import Bracket, Caliper, Disc, Ground, Pad, Piston, Seal
from pipeline.case_models.bodies.brake_joints import Joints
from pipeline.case_models.bodies.mesh_files import BODIES, FileAxes, Units, with_deck
from pipeline.contract import ConfigError, Context, InputFile, Names, Quantities, Quantity, Section, option, stage
from pipeline.physics.contact.static_preload import condense, contact_law, solve_preload
from pipeline.physics.fem.supports import free_freedoms, free_modes, held_modes
from pipeline.physics.friction.friction_table import refuse_beyond
from pipeline.physics.modal.disc_modes import describe
from pipeline.physics.numerics.sparse_blocks import on_diagonal
from pipeline.products import FrictionMap, Structure
from pipeline.systems.disc_brake import build, moduli_left, softened
from pipeline.systems.disc_brake_bracket import refuse_unfit_bracket
from pipeline.systems.disc_brake_checks import refuse_unfit
from pipeline.systems.disc_brake_piston import refuse_unfit_piston
from pipeline.systems.fem_bodies import assembly_fields, body_product, incidence
from pipeline.systems.mesh_files.bodies import from_files, given, notes
from pipeline.systems.mesh_files.springs import unread_springs

#: the contact law is tabulated up to so many times the largest nominal pressure
_LAW_RANGE = 20
#: bodies that only some brakes have
OTHERS = ("bracket", "piston")


class LaserPoint(Section):
    """A laser point on the friction ring."""

    name: str = option(..., "name of the sensor")
    radius: Quantity("m", gt=0) = option(..., "radius of the point")
    angle: Quantity("rad") = option(..., "angle from the middle of the pads, along the disc's rotation")
    face: Literal["outer", "inner"] = option("outer", "face of the ring")
    direction: Literal["axial", "radial", "tangential"] = option("axial", "measured component")


class Settings(Section):
    """Geometry, materials, joints, meshes and preload."""

    mesh_file: InputFile | None = option(None, "deck of several bodies, those of mesh_sets")
    mesh_units: Units = option("SI", "units of this deck")
    mesh_axes: FileAxes = option((), "axes of this deck that become x (middle of the pads), y and z (axis of the disc)")
    mesh_sets: dict[Literal[BODIES], Names] = option({}, "sets of elements, or instances, of this deck that are the"
                                                     " disc, pad_outer, pad_inner, caliper, bracket and piston")
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

    @classmethod
    def completed(cls, values):
        """With the deck of several bodies under each of them."""
        return with_deck(values)


def _check(sections):
    """Refuse dimensions that do not fit, and a mesh file that the brake cannot be built with, before all else."""
    settings = sections["structure"]
    refuse_unfit(settings)
    _refuse_linings(settings.pad, sections)
    if settings.disc.mount_group or from_files(settings):
        build(settings)
        return
    for part, refuse in (("bracket", refuse_unfit_bracket), ("piston", refuse_unfit_piston)):
        if getattr(settings, part).kind == "body":
            refuse(settings)


def _refuse_linings(pad, sections):
    """Refuse linings that melt, and those that pressure stiffens where other stages would not see it."""
    if "friction_map" in sections:
        moduli_left(pad.lining_softening, sections["friction_map"].bulk_temperature)
    if not pad.lining_pressure_exponent:
        return
    where = "structure.pad.lining_pressure_exponent"
    if pad.damping_ratio:
        raise ConfigError(where, "structure.pad.damping_ratio: 0 beside it, as a ratio is that of the modes of one"
                          " stiffness", f"{pad.damping_ratio:g}", "state structure.pad.lining_loss_factor instead")
    blind = [name for name in ("multibody", "noise_matrix", "line_evidence") if name in sections]
    if blind:
        raise ConfigError(where, f"0 in a chain with {', '.join(blind)}, whose pressures are not those of the preload",
                          f"{pad.lining_pressure_exponent:g}", "state the moduli at the pressure in question")


@stage(check=_check)
def structure(friction_map: FrictionMap, settings: Settings, context: Context) -> Structure:
    """Mesh the bodies of the brake, and compute preload and real modes.

    Method:
    Disc, pads, caliper, and bracket and piston where declared, were meshed with quadratic hexahedra (95 % of the
    stiffness by 2 x 2 x 2 integration), unless they have the elements of a mesh file, whose unlike meshes are tied by
    mortar springs; linings have their moduli at friction_map.bulk_temperature, in the preload those at its pressure.
    Joints between bodies are springs and dampers. The disc is clamped where the bolts press it onto a rigid hub. The
    normal contact law follows from the interface stiffness after {sliding_distance} of sliding; the preload is static
    and frictionless. Real modes were computed below {frequency_max}.
    """
    brake = build(settings)
    said = (*notes(settings), *unread_springs(settings))
    if temperature := float(friction_map.bulk_temperature):
        left = moduli_left(settings.pad.lining_softening, temperature)
        context.log(f"linings {temperature:g} K above the temperature of reference have {left:.3g} of their moduli")
        brake = softened(brake, left)
    for note in said:
        context.log(note)
    condensed, (free, *modes) = _solved(brake, settings, context)
    bodies = {name: body_product(body, *results)
              for name, body, results in zip(brake.names, brake.bodies, modes, strict=True)}
    others = {name: bodies.pop(name) for name in brake.names if name in OTHERS}
    law = _law(friction_map, settings)
    diameters, out_of_plane = describe(brake.bodies[0].mesh.node, free[1])
    return Structure(
        body_name=brake.names, **bodies, others=others, mesh_note=said, mesh_given=given(settings),
        free_frequency=free[0], free_diameters=diameters, free_out_of_plane=out_of_plane,
        **assembly_fields(brake), sensor_name=[s.name for s in settings.sensors],
        **_preload(brake, law, settings, condensed), law_closure=law[0], law_pressure=law[1],
        lining_exponent=settings.pad.lining_pressure_exponent, lining_pressure=settings.pad.lining_pressure,
        piston_rows=incidence(brake.piston), piston_area=brake.pad_area, **_fluid(brake, settings.piston))


def _fluid(brake, piston):
    """Fields of the fluid behind piston bodies, a column for each row of the pistons; empty without one."""
    column, count = brake.fluid, brake.piston.count
    if column is None:
        return {name: [] for name in ("fluid_stiffness", "fluid_loss_factor", "line_inertia", "line_drag")}
    each = {"fluid_stiffness": column.stiffness, "fluid_loss_factor": piston.fluid.loss_factor,
            "line_inertia": column.inertia, "line_drag": column.drag}
    return {name: np.full(count, value) for name, value in each.items()}


def _solved(brake, settings, context):
    """([what ``_condensed`` says at each pressure], [(frequency, shape (3n, m)) of the free disc without rigid motions,
    then of the bodies on their supports]), side by side."""
    stiffer = _stiffer(settings)
    linings = [partial(_condensed, softened(brake, times), context.solver) for times in dict.fromkeys(stiffer)]
    tasks = [(brake.bodies[0], None, settings.free_frequency_max)]
    tasks += [(body, body.supported, settings.frequency_max) for body in brake.bodies]
    bodies = [partial(_modes, context.solver, task) for task in tasks]
    compliant, modes = context.side_by_side(linings, bodies, label="real modes, compliance of the contacts")
    condensed = dict(zip(dict.fromkeys(stiffer), compliant, strict=True))
    return [condensed[times] for times in stiffer], modes


def _stiffer(settings):
    """Moduli of the linings at each pressure, over the stated ones."""
    pad = settings.pad
    return [float((pressure / pad.lining_pressure) ** pad.lining_pressure_exponent) for pressure in settings.pressures]


def _modes(solver, task):
    body, supported, below = task
    if supported is None:
        return free_modes(*body.matrices(), solver, below, "structure: free disc")
    return held_modes(*body.matrices(), supported, solver, below=below)


def _law(friction_map, settings):
    """Closure and pressure of the interface at the sliding distance, which the map must reach."""
    refuse_beyond(settings.sliding_distance, friction_map.distance[-1], "structure.sliding_distance")
    stiffness = [np.interp(settings.sliding_distance, friction_map.distance, row)
                 for row in friction_map.normal_stiffness]
    return contact_law(friction_map.pressure, stiffness, _LAW_RANGE * max(settings.pressures))


def _preload(brake, law, settings, condensed):
    """Contact force, stiffness and status at every pressure, each with the linings as stiff as they are there."""
    preloads = [solve_preload(compliance, pressure * closure, brake.contacts.area, *law)
                for pressure, (compliance, closure) in zip(settings.pressures, condensed, strict=True)]
    return {"pressure": settings.pressures, "preload": [f.force for f in preloads],
            "contact_stiffness": [f.stiffness for f in preloads], "closed": [f.closed.astype(int) for f in preloads]}


def _condensed(brake, solver):
    """(compliance (c, c) m/N of the contacts, their closure (c,) m per Pa of the pistons) of a brake not in contact."""
    stiffness = on_diagonal([body.matrices()[0] for body in brake.bodies])
    joints = brake.joints.rows.matrix
    stiffness = stiffness + joints.T @ scipy.sparse.diags(brake.joints.stiffness) @ joints
    sizes = np.cumsum([0, *(3 * len(b.mesh.node) for b in brake.bodies)])
    free = np.concatenate([first + free_freedoms(len(b.mesh.node), b.supported)
                           for first, b in zip(sizes, brake.bodies, strict=False)])
    normal, piston = (rows.matrix[:, free] for rows in (brake.contacts.normal, brake.piston))
    return condense(stiffness[free][:, free], normal, piston.toarray().sum(axis=0) * brake.pad_area, solver)
