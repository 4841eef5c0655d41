"""Stage reduced_model: reduction of any system to the sliding model used by all solvers and effects.

Each system has its own product; ``SYSTEMS`` maps it to its reduction.
"""

from dataclasses import fields
from functools import partial

import numpy as np
import scipy

from pipeline.contract import Context, Quantity, Section, option, stage
from pipeline.physics.reduction.body import reduce_body
from pipeline.products import BeamOnBeam, Lumped, PinOnDisc, ReducedModel, Structure
from pipeline.systems.fem_bodies import INPUTS, LINE, columns_of, elastic_body, force_patterns, has_fluid, row_fields

#: a system without linings
NO_LINING = {"lining_coordinate": [], "lining_stiffness": np.empty((0, 0)), "lining_loss_factor": 0.0,
             "lining_exponent": 0.0, "lining_pressure": 1.0}
#: the tangential law of a system that has none: its friction comes from a map or from settings
NO_SHEAR = {f"shear_{name}": [] for name in ("pressure", "friction", "stiffness", "elastic_stiffness", "exponent")}


def plain(contacts, inputs, sensors):
    """Fields of a system of so many contacts without names, inputs that are forces, and translations alone."""
    return {"contact_name": [""] * contacts, "input_joint": [""] * inputs, "input_scale": np.ones(inputs),
            "sensor_turns": [0] * sensors, "turning": []}


class Settings(Section):
    """Number of coordinates that the bodies retain."""

    fixed_below: Quantity("Hz", gt=0) = option("20 kHz", "limit of the fixed-interface modes of bodies on joints alone")
    residual_below: Quantity("Hz", gt=0) = option(
        "400 kHz", "limit of the pseudo-frequencies of residual shapes: the disc's response to contact forces, the"
        " inertia that moving interfaces leave to the others")
    load_patterns: tuple[int, int] | None = option(
        None, "polynomial orders of contact force along and across each contact face, for which static responses are"
        " kept; none = the force of every contact by itself, which suits a few dozen contacts")


@stage
def reduced_model(structure: Structure | PinOnDisc | BeamOnBeam | Lumped, settings: Settings,
                  context: Context) -> ReducedModel:
    """Reduce the system to interface coordinates and modes.

    Method:
    Bodies supported by joints were reduced by the Craig-Bampton method with averaged interfaces and fixed-interface
    modes below {fixed_below}, bodies on rigid supports to their modes. Both were augmented by residual shapes with
    pseudo-frequencies below {residual_below}, for the response to interface accelerations and contact forces beyond
    these modes. Lumped masses retain their coordinates; brake fluid is a spring in the bore that ends on the inertia of
    the line.
    """
    return SYSTEMS[type(structure)](structure, settings, context)


def _from_solids(structure, settings, context):
    """Brake or pin on disc, whose bodies are finite elements with supports or interfaces."""
    patterns = None if settings.load_patterns is None else force_patterns(structure, settings.load_patterns)
    bodies = [elastic_body(structure, name, patterns) for name in structure.body_name]
    reduce = partial(reduce_body, fixed_below=settings.fixed_below, residual_below=settings.residual_below,
                     solver=context.solver)
    terms = context.map(reduce, bodies, "reducing bodies")
    sizes = [len(t.mass) for t in terms]
    counts = (f"{name} {size}" for name, size in zip(structure.body_name, sizes, strict=True))
    context.log(f"reduced coordinates: {', '.join(counts)}")
    matrices = {name: scipy.linalg.block_diag(*(getattr(t, name) for t in terms))
                for name in ("mass", "damping", "gyroscopic", "stiffness", "centrifugal", "loss")}
    rows = _split_rows(structure, np.hstack([t.rows for t in terms]))
    parts = {"body_name": structure.body_name, "coordinate_body": np.repeat(np.arange(len(terms)), sizes), **matrices,
             **rows, **_copied(structure), **_surfaces(terms, sizes), **_lining(structure, bodies, terms)}
    return ReducedModel(**(_with_fluid(parts, structure) if has_fluid(structure) else parts))


def _with_fluid(parts, structure):
    """The fields ``parts`` of a ReducedModel with the fluid of the lines, masses on which the columns in the bores end.

    A mass is free but for that spring, so that it takes no static load (see ``disc_brake_piston``).
    """
    beside = {"mass": structure.line_inertia, "damping": structure.line_drag}
    count = len(structure.line_inertia)
    none = np.zeros(count)
    matrices = {name: scipy.linalg.block_diag(parts[name], np.diag(beside.get(name, none)))
                for name in ("mass", "damping", "gyroscopic", "stiffness", "centrifugal", "loss")}
    rows = {name: _widened(parts[name], count) for name in ("joint_rows", "contact_normal", "contact_tangent",
                                                     "contact_lateral", "input_rows", "sensor_rows", "recovery")}
    columns = np.hstack((parts["input_rows"], -np.eye(count)))
    return {**parts, **matrices, **rows, "body_name": [*parts["body_name"], LINE],
            "coordinate_body": np.append(parts["coordinate_body"], np.full(count, len(parts["body_name"]))),
            "joint_name": [*parts["joint_name"], *columns_of(count)],
            "joint_rows": np.vstack((rows["joint_rows"], columns)),
            "joint_stiffness": np.append(parts["joint_stiffness"], structure.fluid_stiffness),
            "joint_damping": np.append(parts["joint_damping"], none),
            "joint_loss_factor": np.append(parts["joint_loss_factor"], structure.fluid_loss_factor)}


def _widened(rows, count):
    """``rows`` with ``count`` coordinates that they do not see."""
    return np.concatenate((rows, np.zeros((*rows.shape[:-1], count), rows.dtype)), axis=-1)


def _from_beams(beams, settings, context):
    """The two beams, given by their modes; their contact is hard and counts the sliding speed itself (lever 1 m)."""
    size, none = len(beams.mode_frequency), np.zeros((len(beams.mode_frequency),) * 2)
    area, force = beams.contact_area, float(beams.force)
    return ReducedModel(
        body_name=beams.body_name, coordinate_body=beams.mode_body, mass=np.eye(size),
        damping=np.diag(beams.mode_damping), gyroscopic=none, centrifugal=none, loss=none, joint_loss_factor=[],
        stiffness=np.diag((2 * np.pi * beams.mode_frequency) ** 2), joint_name=[], joint_rows=np.zeros((0, size)),
        joint_stiffness=[], joint_damping=[], contact_body=[0], contact_position=beams.contact_position,
        contact_area=area, contact_lever=[1.0], contact_gap=[0.0], contact_normal=beams.contact_normal,
        contact_tangent=beams.contact_tangent, contact_lateral=np.zeros((1, size)), pressure=force / area,
        preload=[[force]], contact_stiffness=[[0.0]], law_closure=[], law_pressure=[], input_name=["weight"],
        input_rows=beams.load_row, input_area=area, history_interval=0.0,
        input_history=np.empty((0, 1)), drive_history=[], sensor_quantity=["velocity"], sensor_unit=["m/s"],
        sensor_gain=[1.0], **plain(1, 1, len(beams.sensor_name)), **NO_SHEAR, **NO_LINING,
        **{name: getattr(beams, name) for name in ("sensor_name", "sensor_position", "sensor_direction", "sensor_rows",
                                                   "visible_position", "visible_body", "visible_face", "recovery")})


def _from_lumps(lumped, settings, context):
    """The lumped system as it is: its coordinates are few, and there is no surface to draw."""
    size, sensors = len(lumped.mass), len(lumped.sensor_name)
    none, names = np.zeros((size, size)), {f.name for f in fields(ReducedModel)} & {f.name for f in fields(Lumped)}
    return ReducedModel(
        damping=none, stiffness=none, centrifugal=none, loss=none,
        joint_loss_factor=np.zeros(len(lumped.joint_name)), sensor_position=np.zeros((sensors, 3)),
        sensor_direction=np.tile([1.0, 0.0, 0.0], (sensors, 1)),
        visible_position=np.empty((0, 3)), visible_body=[], visible_face=np.empty((0, 4), int),
        recovery=np.empty((0, 3, size)), **NO_SHEAR, **NO_LINING,
        **{name: getattr(lumped, name) for name in sorted(names)})


#: product of a system -> its reduction (system, settings, context) -> ReducedModel
SYSTEMS = {Structure: _from_solids, PinOnDisc: _from_solids, BeamOnBeam: _from_beams, Lumped: _from_lumps}


def _split_rows(structure, rows):
    """The stacked reduced rows, back under their names."""
    fields, name = row_fields(structure), INPUTS[type(structure)]
    ends = np.cumsum([int(getattr(structure, field).rows) for field in fields])
    parts = dict(zip(fields, np.split(rows, ends[:-1]), strict=True))
    inputs = parts.pop(f"{name}_rows")
    return {**parts, "input_rows": inputs, "input_name": [f"{name}_{k + 1}" for k in range(len(inputs))],
            "input_area": np.full(len(inputs), float(getattr(structure, f"{name}_area")))}


def _copied(structure):
    """What the reduction leaves as it is; parts touch without being pressed, and loads are constant."""
    kept = ("joint_name", "joint_stiffness", "joint_damping", "joint_loss_factor", "contact_body", "contact_position",
            "contact_area", "pressure", "preload", "contact_stiffness", "law_closure", "law_pressure", "sensor_name",
            "sensor_position", "sensor_direction")
    tangential = {name: getattr(structure, name, none) for name, none in NO_SHEAR.items()}
    radius = np.hypot(structure.contact_position[:, 0], structure.contact_position[:, 1])
    sensors = len(structure.sensor_name)
    inputs = int(getattr(structure, f"{INPUTS[type(structure)]}_rows").rows)
    constants = {"contact_lever": radius, "contact_gap": np.zeros(len(radius)), "history_interval": 0.0,
           "input_history": np.empty((0, inputs)), "drive_history": [],
           "sensor_quantity": ["velocity"] * sensors, "sensor_unit": ["m/s"] * sensors, "sensor_gain": np.ones(sensors),
           **tangential, **plain(len(radius), inputs, sensors)}
    return {**constants, **{name: getattr(structure, name) for name in kept}}


def _lining(structure, bodies, terms):
    """What scales with the moduli of the linings, in the coordinates of the bodies that have one."""
    lined, first = [b for b, t in enumerate(terms) if t.part is not None], np.cumsum([0, *(len(t.mass) for t in terms)])
    if not lined:
        return NO_LINING
    body = bodies[lined[0]]
    return {"lining_coordinate": np.concatenate([np.arange(first[b], first[b + 1]) for b in lined]),
            "lining_stiffness": scipy.linalg.block_diag(*(terms[b].part for b in lined)),
            "lining_loss_factor": np.broadcast_to(body.loss_factor, len(body.density))[body.part[0]],
            **{name: getattr(structure, name, NO_LINING[name]) for name in ("lining_exponent", "lining_pressure")}}


def _surfaces(terms, sizes):
    """Surface nodes of all bodies in one numbering, with their recovery in all coordinates."""
    counts = [len(t.position) for t in terms]
    first, column = np.cumsum([0, *counts]), np.cumsum([0, *sizes])
    recovery = np.zeros((first[-1], 3, column[-1]), np.float32)
    for k, t in enumerate(terms):
        recovery[first[k]:first[k + 1], :, column[k]:column[k + 1]] = t.recovery
    return {"visible_position": np.vstack([t.position for t in terms]),
            "visible_body": np.repeat(np.arange(len(terms)), counts),
            "visible_face": np.vstack([t.face + first[k] for k, t in enumerate(terms)]), "recovery": recovery}
