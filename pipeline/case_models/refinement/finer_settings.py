"""What of a brake is refined: settings of finer meshes and contact, body by body; and what is left as it is."""

import math

from pipeline.case_models.bodies.other_meshes import COUNTS

CONTACT, PAD_MESH, DISC_MESH, CALIPER_MESH, BRACKET_MESH, PISTON_MESH, BASES = REFINEMENTS = (
    "contact", "pad_mesh", "disc_mesh", "caliper_mesh", "bracket_mesh", "piston_mesh", "bases")
#: refinement of meshes -> section of the brake
PARTS = {PAD_MESH: "pad", DISC_MESH: "disc", CALIPER_MESH: "caliper", BRACKET_MESH: "bracket", PISTON_MESH: "piston"}
#: elements around a piston come in multiples of this
_AROUND_PISTON = 4
FILE, UNASKED = "comes from a file", "was not asked for"


def refined(brake, names):
    """Those of ``names`` that the section ``structure``, ``brake``, allows: what it has, and not from a file."""
    return tuple(name for name in names if name not in PARTS or not _kept(getattr(brake, PARTS[name])))


def left_out(brake, names):
    """{refinement: why} of what the section ``structure`` has and is not refined if ``names`` are asked for."""
    parts = {name: getattr(brake, part) for name, part in PARTS.items() if _exists(getattr(brake, part))}
    return {name: FILE if name in parts and parts[name].mesh_file else UNASKED for name in REFINEMENTS
            if (name in parts or name not in PARTS) and (name not in names or name in parts and parts[name].mesh_file)}


def finer(brake, names, factor, contact_points=None):
    """The section ``structure`` with ``names`` refined: ``factor`` times the elements or more in every direction.

    Contact points per face stay where the mesh of the pads is refined, as there are more faces then; else they are
    ``contact_points`` per direction, by default one more. Contact patches are halved.
    """
    pad = brake.pad
    if CONTACT in names and (pad.contact_points is None or PAD_MESH not in names):
        brake = _with(brake, "pad", _finer_contact(pad, contact_points))
    for name in names:
        if name in PARTS:
            part = getattr(brake, PARTS[name])
            more = {count: math.ceil(factor * getattr(part, count)) for count in COUNTS[PARTS[name]]}
            if hasattr(part, "element_size"):
                more["element_size"] = part.element_size / factor
            if name == PISTON_MESH:
                more["angular_cells"] = _AROUND_PISTON * math.ceil(more["angular_cells"] / _AROUND_PISTON)
            brake = _with(brake, PARTS[name], more)
    return brake


def _finer_contact(pad, contact_points):
    if pad.contact_points is not None:
        return {"contact_points": contact_points or pad.contact_points + 1}
    return {"patches_angular": 2 * pad.patches_angular, "patches_radial": 2 * pad.patches_radial,
            "cells_per_patch": math.ceil(pad.cells_per_patch / 2)}


def _with(brake, part, more):
    return brake.model_copy(update={part: getattr(brake, part).model_copy(update=more)})


def _exists(part):
    return getattr(part, "kind", "body") == "body"


def _kept(part):
    return not _exists(part) or bool(part.mesh_file)
