"""The pin on disc of Allgaier, Gaul, Keiper & Willner (1999): a clamped bar rubs on the face of a disc.

Axes: disc axis z, the disc turns about +z, the contact lies at (contact radius, 0, half thickness), so that the disc
slides along +y there. The pin stands on z > 0. A positive tilt moves its clamp upstream (the disc drags the tip behind
the clamp), a negative one downstream (the tip digs in).

What the paper does not mesh is declared: the disc sits on a rigid hub whose shaft gives way in rocking (an elastic
collar between shaft and hub), the pin is held by a stiff block on springs; the block carries the mass that travels on
the guide along z. The accelerometer is a mass on the last cell of the pin.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.elasticity import assemble, isotropic
from pipeline.physics.fem.face_averages import along, surface_rows
from pipeline.physics.fem.mesh import Mesh, block, boundary_faces, face_normals, revolve
from pipeline.physics.fem.supports import free_freedoms
from pipeline.physics.numerics.sparse_solver import factorise
from pipeline.systems.solids import Assembly, Contacts, Joints, Rows, Solid

BODIES = ("disc", "pin")
DISC, PIN = range(2)
#: modulus of hub and clamp block over that of aluminium: rigid, yet harmless to the solver
_RIGID = 100.0
#: points per direction that sample the contact patch
_PATCH_POINTS = 5
#: sides of the pin: outwards of the disc, along sliding
_SIDES = {"outer": (1, 0), "upstream": (0, -1), "downstream": (0, 1)}


@dataclass(frozen=True)
class PinOnDiscModel(Assembly):
    """Bodies in the order of BODIES, and the row on which the weight acts."""

    load: Rows


def build(parameters):
    """The system of ``parameters``: attributes disc, pin, contact, sensors as the stage declares them.

    Raises ConfigError where the pin cannot be built or does not meet the disc.
    """
    check(parameters)
    bodies = (disc(parameters.disc), pin(parameters))
    meshes = [b.mesh for b in bodies]
    sensors, position, direction = _sensors(meshes, parameters)
    return PinOnDiscModel(bodies, _clamp(meshes, parameters), _contact(meshes, parameters), sensors, position,
                          direction, _load(meshes))


def disc(parameters):
    """The disc on hub, collar and shaft; materials aluminium, hub, collar; the shaft is held."""
    p = parameters
    radius = np.r_[p.shaft_radius, (p.shaft_radius + p.hub_radius) / 2,
                   np.linspace(p.hub_radius, p.outer_radius, p.radial_cells + 1)]
    angle = np.linspace(0, 2 * np.pi, p.angular_cells + 1)
    height = np.linspace(-p.thickness / 2, p.thickness / 2, p.axial_cells + 1)
    mesh = revolve(radius, angle, height)
    material = np.array([2, 1] + [0] * p.radial_cells)[mesh.cell[:, 0]]
    collar = p.rocking_stiffness / _rocking_stiffness(revolve(radius[:2], angle, height), p.poisson)
    elasticity = np.array([isotropic(young, p.poisson) for young in (p.young, _RIGID * p.young, collar)])
    return Solid(mesh, material, ("aluminium", "hub", "collar"), np.full(3, p.density), elasticity,
                       p.damping_ratio, np.flatnonzero(np.hypot(*mesh.node[:, :2].T) < p.shaft_radius * (1 + 1e-6)))


def _rocking_stiffness(mesh, poisson):
    """Moment per angle about x (N m/rad per Pa of modulus) between the rigid inside and outside of a ring."""
    stiffness, _ = assemble(mesh.node, mesh.element, mesh.kind, np.zeros(len(mesh.element), int), np.ones(1),
                            isotropic(1.0, poisson)[None])
    radius = np.hypot(*mesh.node[:, :2].T)
    outside = np.repeat(radius > radius.max() * (1 - 1e-6), 3)
    free = ~outside & np.repeat(radius > radius.min() * (1 + 1e-6), 3)
    turned = np.where(outside, np.cross((1.0, 0, 0), mesh.node).ravel(), 0.0)
    turned[free] = factorise(stiffness[free][:, free], "superlu").solve(-(stiffness @ turned)[free])
    return turned @ stiffness @ turned


def pin(parameters):
    """The tilted bar from its tip to the end of its clamp; materials aluminium, tip with accelerometer, clamp block.

    The block has the stiffness of a rigid body and the mass that travels on the guide.
    """
    p = parameters.pin
    free = np.r_[0, np.linspace(p.tip_cell, p.length, p.axial_cells)]
    line = np.r_[free, p.length + p.clamp_length]
    across = np.linspace(-p.side / 2, p.side / 2, p.cells_across + 1)
    straight = block(across, across, line)
    layer = straight.cell[:, 2]
    material = np.where(layer == p.axial_cells, 2, (layer == 0).astype(int))
    density = np.array([p.density, p.density + p.tip_mass / (p.side**2 * free[1]),
                        p.base_mass / (p.side**2 * p.clamp_length)])
    elasticity = np.array([isotropic(young, p.poisson) for young in (p.young, p.young, _RIGID * p.young)])
    mesh = Mesh(place(straight.node, parameters), straight.element, straight.kind, straight.cell)
    return Solid(mesh, material, ("aluminium", "tip", "clamp"), density, elasticity, p.damping_ratio,
                       np.empty(0, int))


def place(point, parameters):
    """Points (n, 3) of the pin (across x, along the tilt, from the tip) in the axes of the disc."""
    p, tilt = parameters.contact, parameters.pin.tilt
    e_y, e_z = _axes(tilt)
    shifted = point - np.array([0, p.offset, 0])
    foot = np.array([p.radius, 0, parameters.disc.thickness / 2])
    return foot + shifted[:, [0]] * (1, 0, 0) + shifted[:, [1]] * e_y + shifted[:, [2]] * e_z


def reshaped(node, foot, element, material, length, tilt, change):
    """Nodes (n, 3) of a pin stretched to another free length and turned about its contact; inputs as the pin has them.

    ``foot`` (3,) is the contact, ``length`` and ``tilt`` are those of ``node``, ``change`` = (free length, tilt) is
    wanted.
    The cell of the tip and the clamp keep their size.
    """
    away, (e_y, e_z) = node - foot, _axes(tilt)
    across, up = away @ e_y, away @ e_z
    tip = up[element[material == 1]].max()
    up = np.interp(up, (up.min(), tip, length, up.max()), (up.min(), tip, change[0], up.max() - length + change[0]))
    new_y, new_z = _axes(change[1])
    return foot + away[:, [0]] * (1, 0, 0) + across[:, None] * new_y + up[:, None] * new_z


def _axes(tilt):
    """Unit vectors across the pin, along sliding for an upright one, and along it from its tip."""
    return np.array([0, np.cos(tilt), np.sin(tilt)]), np.array([0, -np.sin(tilt), np.cos(tilt)])


def check(parameters):
    """Refuse a system that cannot be built: ConfigError."""
    d, p, c = parameters.disc, parameters.pin, parameters.contact
    rules = (
        (p.length > p.clamp_length, "pin.length", f"a pin longer than its clamp ({p.clamp_length:g} m)",
         f"{p.length:g} m", "draw the pin farther out of the jaws"),
        (d.shaft_radius < d.hub_radius < d.outer_radius, "disc", "shaft < hub < outer radius",
         f"{d.shaft_radius:g}, {d.hub_radius:g}, {d.outer_radius:g} m", ""),
        (d.hub_radius + p.side / 2 < c.radius < d.outer_radius - p.side / 2, "contact.radius",
         f"a pin that touches the disc, {d.hub_radius + p.side / 2:g} to {d.outer_radius - p.side / 2:g} m",
         f"{c.radius:g} m: it never touches", "move the pin over the face of the disc"),
        (abs(c.offset) + c.length / 2 <= p.side / 2, "contact.offset",
         f"a contact patch of {c.length:g} m on a tip of {p.side:g} m", f"{c.offset:g} m off its middle", ""),
        (c.width <= p.side, "contact.width", f"a patch no wider than the pin, {p.side:g} m", f"{c.width:g} m", ""),
    )
    for holds, where, expected, actual, remedy in rules:
        if not holds:
            raise ConfigError(f"pin_on_disc.{where}", expected, actual, *([remedy] if remedy else []))


def _contact(meshes, parameters):
    """One patch; pin and disc are read as means over it, so that a force keeps its resultant."""
    c = parameters.contact
    across, along_sliding = (a.ravel() for a in np.meshgrid(
        np.linspace(-c.width / 2, c.width / 2, _PATCH_POINTS),
        np.linspace(-c.length / 2, c.length / 2, _PATCH_POINTS)))
    tip = place(np.column_stack((across, c.offset + along_sliding, np.zeros_like(across))), parameters)
    face = np.column_stack((c.radius + across, along_sliding, np.full_like(across, parameters.disc.thickness / 2)))
    tip_mean = _mean(meshes[PIN], tip, "pin_on_disc.contact: tip of the pin")
    met = _mean(meshes[DISC], face, "pin_on_disc.contact: face of the disc")
    rows = [Rows((-along(met, axis[None]), along(tip_mean, axis[None]))) for axis in np.eye(3)[[2, 1, 0]]]
    centre = np.array([[c.radius, 0, parameters.disc.thickness / 2]])
    return Contacts(np.array([PIN]), centre, np.array([c.width * c.length]), *rows)


def _clamp(meshes, parameters):
    """Springs from the block to the guide: across at its front and rear, and against twist."""
    p = parameters.pin
    half = p.side / 2
    front, rear = (_section(meshes[PIN], parameters, depth) for depth in (p.length, p.length + p.clamp_length))
    sides = [_mean(meshes[PIN], place(np.array([[s * half, 0, p.length + p.clamp_length / 2]]), parameters), "clamp")
             for s in (-1, 1)]
    along_tilt = np.array([[0, np.cos(p.tilt), np.sin(p.tilt)]])
    springs = [(f"clamp_{name}_{end}", along(mean, np.eye(3)[[axis]]), p.clamp_stiffness / 2)
             for end, mean in (("front", front), ("rear", rear)) for axis, name in enumerate(("radial", "tangential"))]
    springs.append(("clamp_twist", (along(sides[1], along_tilt) - along(sides[0], along_tilt)) / 2, p.clamp_stiffness))
    name, rows, stiffness = zip(*springs, strict=True)
    nothing = scipy.sparse.csr_matrix((len(name), 3 * len(meshes[DISC].node)))
    stiffness = np.array(stiffness)
    return Joints(name, stiffness, stiffness * p.loss_time, Rows((nothing, scipy.sparse.vstack(rows, format="csr"))))


def sliding_flexibility(model, friction, solver):
    """Closure of the contact per unit of normal force (m/N) in sliding with ``friction``, the guide held still.

    Not above 0, the pin digs in: the friction that a force brings presses harder than the force yields (the axis of the
    pin leans against the motion inside the friction cone). A weight on a free guide still balances it in the end;
    a clamp of any inertia does not.
    """
    closure = 0.0
    for number, body in enumerate(model.bodies):
        stiffness, _ = body.matrices()
        held = [(model.joints.rows.parts[number], model.joints.stiffness)]
        if number == PIN:
            held.append((model.load.parts[number], model.joints.stiffness.max()))
        for rows, springs in held:
            stiffness = stiffness + rows.T @ scipy.sparse.diags(np.broadcast_to(springs, rows.shape[0])) @ rows
        free = free_freedoms(len(body.mesh.node), body.supported)
        normal, tangent = (rows.parts[number].toarray()[0, free] for rows in (model.contacts.normal,
                                                                              model.contacts.tangent))
        moved = factorise(stiffness.tocsr()[free][:, free], solver).solve(normal + friction * tangent)
        closure += normal @ moved
    return float(closure)


def _section(mesh, parameters, depth):
    """Mean over the outline of the bar at ``depth`` from the tip."""
    half = parameters.pin.side / 2
    corner = half * np.array([(-1, 0), (1, 0), (0, -1), (0, 1)])
    return _mean(mesh, place(np.column_stack((corner, np.full(4, depth))), parameters), "pin_on_disc.pin: clamp")


def _load(meshes):
    """The weight presses the clamp block along -z; its row is the mean motion of the block's end."""
    mesh = meshes[PIN]
    face = boundary_faces(mesh)
    end = np.unique(face[np.argmax(face_normals(mesh.node, face)[1][:, 2])])
    middle = mesh.node[end].mean(axis=0, keepdims=True)
    mean = _mean(mesh, middle, "pin_on_disc.pin: end of the clamp")
    return Rows((scipy.sparse.csr_matrix((1, 3 * len(meshes[DISC].node))), -along(mean, np.eye(3)[[2]])))


def _sensors(meshes, parameters):
    """Accelerometer on a side of the pin and laser point on the disc: rows, positions, directions."""
    s, p, half = parameters.sensors, parameters.pin, parameters.disc.thickness / 2
    on_pin = place(np.array([[*(np.array(_SIDES[s.pin_side]) * p.side / 2), s.pin_height]]), parameters)
    on_disc = np.array([[s.disc_radius * np.cos(s.disc_angle), s.disc_radius * np.sin(s.disc_angle), half]])
    parts, places, directions = [], [], []
    for body, point, axis in ((PIN, on_pin, 2), (DISC, on_disc, 2), (PIN, on_pin, 1)):
        row = [scipy.sparse.csr_matrix((1, 3 * len(m.node))) for m in meshes]
        row[body] = along(_mean(meshes[body], point, "pin_on_disc.sensors"), np.eye(3)[[axis]])
        parts.append(row)
        places.append(point[0])
        directions.append(np.eye(3)[axis])
    stacked = Rows(tuple(scipy.sparse.vstack(column, format="csr") for column in zip(*parts, strict=True)))
    return stacked, np.array(places), np.array(directions)


#: names of the sensors in the order of their rows
SENSORS = ("pin", "disc", "pin_tangential")


def _mean(mesh, point, where):
    """(1, n): mean over points on the surface of a mesh."""
    return surface_rows(mesh.node, boundary_faces(mesh), point, np.ones(len(point)), np.zeros(len(point), int), where)
