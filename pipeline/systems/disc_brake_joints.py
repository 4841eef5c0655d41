"""Joints of the disc brake, and the line pressure, as displacement rows.

What is not meshed is a spring with a damper between two surface means: fingers and pistons on the backplates, pads in
their abutments, guide pins, seals, and the bolts of the bracket. A fixed caliper has pistons on both backplates, and is
bolted on where guide pins would be. Without a bracket, abutments, guide pins and these bolts end on the ground; without
pistons, their seals act between housing and backplates. In a mesh from a file, a group with the name of a
joint says where it acts: FINGER_LEADING_INNER, or FINGER_LEADING for both its spots.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.face_averages import along, face_points, surface_rows
from pipeline.physics.fem.mesh import boundary_faces, face_normals
from pipeline.systems.disc_brake_piston import bore, places
from pipeline.systems.disc_brake_rows import (
    CALIPER,
    INNER,
    OUTER,
    TOUCHING,
    body_names,
    faces_towards,
    pad_height,
    placed,
    stacked,
)
from pipeline.systems.mesh_files.places import named_mean
from pipeline.systems.mesh_files.springs import deck_springs
from pipeline.systems.solids import Joints, Rows

_AXES = {"radial": 0, "tangential": 1, "axial": 2}
_KINDS = ("abutment", "finger", "piston", "guide_pin", "bolt", "mount", "seal")
#: points per direction that sample a spot
_SPOT_POINTS = 5
#: spots of the piston's rim, half the angle of one, and the share of the wall that its points leave out on both sides
_RIM_SPOTS, _RIM_REACH, _RIM_MARGIN = 8, 0.2, 0.1
#: share of the part of the housing beside the columns of the bracket at which the guide pins are held
_PIN_DEPTHS = {"front": 0.25, "rear": 0.75}


@dataclass(frozen=True)
class _Spot:
    """Mean displacement (1, n) of a small area of one body."""

    body: int
    mean: "scipy.sparse.csr_matrix"


def joints(meshes, parameters):
    """All declared joints and the springs of decks; ``loss_time`` is damping over stiffness, loss factors those of the
    kinds of joint, none of the springs of decks."""
    parameters, j = placed(parameters, meshes), parameters.joints
    springs = [spring for kind, made in _MADE.items() if kind not in j.left_out for spring in made(meshes, parameters)]
    rows = [_relative(meshes, first, other, _AXES[axis]) for _, _, first, other, axis in springs]
    names, stiffness, more = deck_springs(parameters, body_names(parameters), meshes)
    loss = [getattr(j, f"{_kind(name)}_loss_factor") for name, *_ in springs] + [0.0] * len(names)
    stiffness = np.array([each for _, each, *_ in springs] + list(stiffness), float)
    parts = zip(*[part.parts for part in ((stacked(rows),) if rows else ()) + (more,)], strict=True)
    return Joints((*(name for name, *_ in springs), *names), stiffness, stiffness * j.loss_time,
                  Rows(tuple(scipy.sparse.vstack(each, format="csr") for each in parts)), np.array(loss))


def _supports(meshes, parameters):
    """Springs of guide pins or bolts, and of the ends of both pads in their abutments, end by end."""
    j, springs = parameters.joints, []
    holder = "bolt" if parameters.caliper.fixed else "guide_pin"
    for end, sign in (("leading", -1), ("trailing", 1)):
        if holder not in j.left_out:
            springs += _caliper_holder(meshes, parameters, holder, end, sign)
        for name, pad in (("outer", OUTER), ("inner", INNER)) if "abutment" not in j.left_out else ():
            spot, guide = _backplate_end(meshes, parameters, pad, sign)
            held = j.abutment_stiffness if end == "trailing" else j.clip_stiffness
            springs += [(f"abutment_{name}_{end}_tangential", held, spot, guide, "tangential"),
                        (f"abutment_{name}_{end}_radial", j.abutment_radial_stiffness, spot, guide, "radial")]
    return springs


def _fingers(meshes, parameters):
    if parameters.caliper.fixed:
        return []
    j = parameters.joints
    return _clamped("finger", j.finger_stiffness, j.finger_shear_stiffness,
                    list(_clamping_spots(meshes, parameters, "finger", OUTER)))


def _on_pads(meshes, parameters):
    """Springs of the pistons, or of the housing without a piston body, on the backplates."""
    j = parameters.joints
    if parameters.piston.kind != "body":
        return [spring for pad in _pressed_pads(parameters) for spring in
                _clamped("piston", j.piston_stiffness, j.piston_shear_stiffness,
                         list(_clamping_spots(meshes, parameters, "piston", pad)))]
    return [spring for place in places(parameters) for spring in
            _clamped("piston", j.shim_stiffness, j.piston_shear_stiffness, _rim_spots(meshes, parameters, place))]


def _pressed_pads(parameters):
    """Pads that pistons press."""
    return (INNER, OUTER) if parameters.caliper.fixed else (INNER,)


def _kind(name):
    """Kind of a joint, one of _KINDS."""
    return next(kind for kind in _KINDS if name.startswith(kind))


def piston_rows(meshes, parameters):
    """A row for each pad that pistons press: mean distance of pistons and cylinder floors, or without a piston body of
    backplate and cylinder; a unit force pushes the pad onto the disc."""
    return stacked([_piston_row(meshes, parameters, pad) for pad in _pressed_pads(parameters)])


def _piston_row(meshes, parameters, pad):
    """[(1, 3 nodes) sparse] of every body: the row of a ``pad``."""
    side = 1 if pad == OUTER else -1
    if parameters.piston.kind == "body":
        pairs = [_pressed(meshes, parameters, side)]
    else:
        pairs = [(spot, other) for _, spot, other in _clamping_spots(meshes, parameters, "piston", pad)]
    relative = [_relative(meshes, *pair, 2) for pair in pairs]
    return [scipy.sparse.csr_matrix(-side * sum(parts) / len(pairs)) for parts in zip(*relative, strict=True)]


def _clamped(prefix, normal, shear, places):
    """Springs of a part that bears on a backplate at ``places``, which share its stiffnesses."""
    return [(f"{prefix}_{kind}_{place}", stiffness / len(places), pad, body, axis) for place, pad, body in places
            for kind, stiffness, axis in (("normal", normal, "axial"), ("tangential", shear, "tangential"),
                                          ("radial", shear, "radial"))]


def _caliper_holder(meshes, parameters, holder, end, sign):
    """Axial, tangential and radial springs on the end faces of the housing, at two depths, to bracket or ground: of a
    ``holder``, a guide_pin, or a bolt of a fixed caliper."""
    c, j = parameters.caliper, parameters.joints
    front = meshes[CALIPER].node[:, 2].min() + c.housing_depth
    depths = {"front": c.housing_depth / 6, "rear": 5 * c.housing_depth / 6}
    if on_bracket := parameters.bracket.kind == "body":
        beside = min(parameters.bracket.column_height + front, c.housing_depth)
        depths = {name: share * beside for name, share in _PIN_DEPTHS.items()}
    across = getattr(j, f"{holder}_stiffness")
    along, springs = j.guide_pin_axial_stiffness if holder == "guide_pin" else across, []
    for end_name, depth in depths.items():
        where = j.guide_pin_radius, front - depth, j.spot_size
        name = f"{holder}_{end}_{end_name}"
        spot = _end_spot(meshes, CALIPER, sign * c.angle / 2, *where, name)
        held = _on_bracket(meshes, parameters, sign, *where, name) if on_bracket else None
        springs += [(f"{holder}_{end}_{kind}_{end_name}", stiffness / 2, spot, held, kind) for kind, stiffness in
                    (("axial", along), ("tangential", across), ("radial", across))]
    return springs


def _backplate_end(meshes, parameters, pad, sign):
    """(spot on the end of a backplate, the spot of the bracket that it meets there or None)."""
    p = parameters.pad
    height = (1 if pad == OUTER else -1) * (parameters.disc.ring_thickness / 2 + p.lining_thickness
                                            + p.backplate_thickness / 2)
    where = (p.inner_radius + p.outer_radius) / 2, height, p.backplate_thickness / 2
    name = f"abutment_{'outer' if pad == OUTER else 'inner'}_{'leading' if sign < 0 else 'trailing'}"
    held = _on_bracket(meshes, parameters, sign, *where, name) if parameters.bracket.kind == "body" else None
    return _end_spot(meshes, pad, sign * p.angle / 2, *where, name), held


def _on_bracket(meshes, parameters, sign, radius, height, size, name):
    """Spot on the face of a column of the bracket towards the pads."""
    index = body_names(parameters).index("bracket")
    return _end_spot(meshes, index, sign * parameters.pad.angle / 2, radius, height, size, name)


def _mounts(meshes, parameters):
    """Springs of a bracket to the knuckle on the backs of both columns, a bolt of two spots on each."""
    if parameters.bracket.kind != "body":
        return []
    b, j, index = parameters.bracket, parameters.joints, body_names(parameters).index("bracket")
    offset, springs = np.linspace(-j.spot_size / 2, j.spot_size / 2, _SPOT_POINTS), []
    for end, sign in (("leading", -1), ("trailing", 1)):
        angle = sign * (parameters.pad.angle + b.angle) / 4
        for level, across in (("inner", -1), ("outer", 1)):
            along_r, along_t = (a.ravel() for a in np.meshgrid(b.mount_radius + across * b.mount_width / 2 + offset,
                                                               offset))
            point = np.column_stack((along_r * np.cos(angle) - along_t * np.sin(angle),
                                     along_r * np.sin(angle) + along_t * np.cos(angle),
                                     np.full(len(along_r), -b.column_height)))
            spot = _spot(meshes, index, point, f"mount_{end}_{level}")
            springs += [(f"mount_{end}_{kind}_{level}", j.mount_stiffness / 2, spot, None, kind) for kind in _AXES]
    return springs


def _rim_spots(meshes, parameters, place):
    """(name, spot on a backplate, spot on the piston) around the rim of the piston at a Place."""
    p, index = parameters.piston, body_names(parameters).index("piston")
    margin = _RIM_MARGIN * p.wall
    radius, turn = (a.ravel() for a in np.meshgrid(
        np.linspace(p.diameter / 2 - p.wall + margin, p.diameter / 2 - margin, _SPOT_POINTS),
        np.linspace(-_RIM_REACH, _RIM_REACH, _SPOT_POINTS)))
    spots, pad = [], OUTER if place.side > 0 else INNER
    for k in range(_RIM_SPOTS):
        angle = 2 * np.pi * k / _RIM_SPOTS + turn
        point = place.at(np.column_stack((parameters.joints.clamping_radius + radius * np.cos(angle),
                                          radius * np.sin(angle), np.full(len(radius), -pad_height(parameters)))))
        name = f"{place.name}{360 * k // _RIM_SPOTS}"
        spots.append((name, *(_spot(meshes, body, point, f"piston_rim_{name}") for body in (pad, index))))
    return spots


def _seal(meshes, parameters):
    """Springs of the seals between pistons and their bores, at four places around each."""
    if parameters.piston.kind != "body":
        return []
    return [spring for place in places(parameters) for spring in _seal_at(meshes, parameters, place)]


def _seal_at(meshes, parameters, place):
    """Springs of the seal of the piston at a Place."""
    p, j, index = parameters.piston, parameters.joints, body_names(parameters).index("piston")
    (first, last), half, floor = bore(parameters)
    middle, rim = j.clamping_radius, p.diameter / 2
    height = floor + p.bore_depth - p.seal_depth + np.linspace(-1, 1, _SPOT_POINTS) * min(p.seal_depth, j.spot_size) / 4
    springs = []
    for end, x, y, wall in (("outer", rim, 0, (last, 0)), ("trailing", 0, rim, (middle, middle * np.tan(half))),
                            ("inner", -rim, 0, (first, 0)), ("leading", 0, -rim, (middle, -middle * np.tan(half)))):
        name = f"{place.name}{end}"
        spots = [_spot(meshes, body, place.at(np.column_stack((np.full(_SPOT_POINTS, a), np.full(_SPOT_POINTS, b),
                                                               height))), f"seal_{name}")
                 for body, a, b in ((index, middle + x, y), (CALIPER, *wall))]
        springs += [(f"seal_{kind}_{name}", stiffness / 4, *spots, kind) for kind, stiffness in
                    (("axial", j.piston_stiffness), ("tangential", j.seal_stiffness), ("radial", j.seal_stiffness))]
    return springs


def _pressed(meshes, parameters, side):
    """(crowns of the pistons, floors of the bores behind them) of a side: what the fluid presses on."""
    index, floor = body_names(parameters).index("piston"), -side * bore(parameters)[2]
    named = [named_mean(meshes[body], "pressed" if side < 0 else "pressed_outer_pad") for body in (index, CALIPER)]
    if all(mean is not None for mean in named):
        return _Spot(index, named[0]), _Spot(CALIPER, named[1])
    crown = faces_towards(meshes[index], side)
    crown = crown[side * face_normals(meshes[index].node, crown)[1][:, 2] > 0]
    point, area = (a.reshape(-1, *a.shape[2:]) for a in face_points(meshes[index].node, crown))
    below, group = np.column_stack((point[:, :2], np.full(len(point), floor))), np.zeros(len(point), int)
    return (_Spot(index, surface_rows(meshes[index].node, crown, point, area, group, "structure.piston: crown")),
            _Spot(CALIPER, surface_rows(meshes[CALIPER].node, faces_towards(meshes[CALIPER], -side), below, area, group,
                                        "structure.piston: floor of the bore")))


def _end_spot(meshes, body, angle, radius, height, size, name):
    """Spot of a joint on the plane end of a body at ``angle``, centred on (radius, height)."""
    offset = np.linspace(-size / 2, size / 2, _SPOT_POINTS)
    r, z = (a.ravel() for a in np.meshgrid(radius + offset, height + offset))
    return _spot(meshes, body, np.column_stack((r * np.cos(angle), r * np.sin(angle), z)), name)


def _clamping_spots(meshes, parameters, prefix, pad):
    """(place, spot on the backplate, spot on the caliper) at four places of fingers or piston."""
    j, c = parameters.joints, parameters.caliper
    side = 1 if pad == OUTER else -1
    back = side * pad_height(parameters)
    caliper = back + side * c.piston_gap if prefix == "piston" else back
    first = "outer_pad_" if pad == OUTER and prefix == "piston" else ""
    offset = np.linspace(-j.spot_size / 2, j.spot_size / 2, _SPOT_POINTS)
    for end, forward in (("leading", -1), ("trailing", 1)):
        for level, across in (("inner", -1), ("outer", 1)):
            x, y = (a.ravel() for a in np.meshgrid(
                j.clamping_radius + across * j.clamping_height / 2 + offset,
                forward * (j.finger_distance if prefix == "finger" else j.piston_distance) / 2 + offset))
            spots = (_spot(meshes, body, np.column_stack((x, y, np.full_like(x, z))), f"{prefix}_{first}{end}_{level}")
                     for body, z in ((pad, back), (CALIPER, caliper)))
            yield f"{first}{end}_{level}", *spots


def _spot(meshes, body, point, name):
    """Spot of the joint ``name``: the group of that name in a mesh from a file, else at points (p, 3)."""
    mesh, of_file = meshes[body], meshes[body].groups is not None
    mean = named_mean(mesh, name) if of_file else None
    if mean is not None:
        return _Spot(body, mean)
    try:
        return _Spot(body, surface_rows(mesh.node, boundary_faces(mesh), point, np.ones(len(point)),
                                        np.zeros(len(point), int), f"structure.joints: {name}",
                                        TOUCHING if of_file else 1e-6))
    except ConfigError as error:
        if not of_file:
            raise
        part = ("disc", "outer pad", "inner pad", "caliper", "bracket or piston")[min(body, 4)]
        raise ConfigError(f"structure.joints: {name}", f"a group {name.upper()} in the mesh of the {part}, or its place"
                          " there as the case states dimensions", error.found, "name a surface or a set of nodes"
                          f" {name.upper()} in the mesh file") from None


def _relative(meshes, first, other, axis):
    """Displacement of one spot less that of the other (or of the ground) along an axis, per body."""
    row = [scipy.sparse.csr_matrix((1, 3 * len(m.node))) for m in meshes]
    row[first.body] = along(first.mean, np.eye(3)[[axis]])
    if other is not None:
        row[other.body] = -along(other.mean, np.eye(3)[[axis]])
    return row


#: kind of joint -> its springs [(name, stiffness, spot, the other spot or None, axis)]
_MADE = {"guide_pin or abutment": _supports, "finger": _fingers, "piston": _on_pads, "seal": _seal,
         "mount": _mounts}
