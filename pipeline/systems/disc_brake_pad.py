"""A pad of the disc brake: lining with chamfers and a slot, backplate with weights on its ends, shim.

Heights are distances from the contact face. Chamfers cut both ends of the lining along sliding: its face ends
``chamfer_length`` before the pad does, at the mean radius, and the cut is ``chamfer_depth`` high. The slot is radial,
in the middle of the pad. Weights are denser backplate: inertia without stiffness. The shim covers the back of the
backplate: a layer of rubber, bonded to it and to a cover of steel, which loses energy as the pad bends and shears it.
"""

from dataclasses import replace

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.fem.elasticity import isotropic, orthotropic
from pipeline.physics.fem.mesh import divided, revolve
from pipeline.systems.mesh_files.bodies import pad_solid
from pipeline.systems.solids import Solid

#: least slope of a chamfer, depth over length, beyond which it would count as a contact face
_STEEP = 0.15
#: most of the length of half a lining that a chamfer and half the slot take
_TAKEN = 0.8
#: materials of a shim, from the backplate outwards
SHIM = ("shim rubber", "shim cover")
#: what the ends of a pad bear in shares of its added mass: leading, trailing
_ENDS = {"both": (0.5, 0.5), "leading": (1.0, 0.0), "trailing": (0.0, 1.0)}


def pad(parameters, side):
    """Lining on the disc face of ``side`` (+1 outer, -1 inner) and its steel backplate; patches divide the mesh."""
    p, face = parameters.pad, parameters.disc.ring_thickness / 2
    if p.mesh_file:
        return pad_solid(p, side)
    radius = np.linspace(p.inner_radius, p.outer_radius, p.patches_radial * p.cells_per_patch + 1)
    angle, height = _angles(p), _heights(p)
    kept = ~_slotted(p, angle, height) if p.slot_width else np.ones((len(angle) - 1, len(height) - 1), bool)
    mask = np.broadcast_to(kept[:, ::side], (len(radius) - 1, *kept.shape))
    depth = face + height
    mesh = revolve(radius, angle, depth if side > 0 else -depth[::-1], mask)
    layer = mesh.cell[:, 2] if side > 0 else len(height) - 2 - mesh.cell[:, 2]
    shim = SHIM if p.shim_rubber_thickness else ()
    plate = len(height) - 2 - len(shim)
    steel = layer == plate
    mesh = replace(mesh, node=_chamfered(p, mesh.node, side * mesh.node[:, 2] - face)) if p.chamfer_length else mesh
    weights = _weights(p, angle)
    material = steel.astype(int)
    for row, (cell, _) in enumerate(weights, 2):
        material[steel & (mesh.cell[:, 1] == cell % (len(angle) - 1))] = row
    names, densities, elasticity, loss = _materials(p, [density for _, density in weights])
    for above, name in enumerate(shim, plate + 1):
        material[layer == above] = names.index(name)
    return Solid(mesh, material, names, densities, elasticity, p.damping_ratio, np.empty(0, int), loss)


def _materials(p, weighted):
    """(names, densities (m,), elasticities (m, 6, 6), loss factors (m,)); ``weighted``: densities of backplate that
    bears a weight."""
    lining = orthotropic((p.lining_young_radial, p.lining_young_tangential, p.lining_young_normal),
                         (p.lining_poisson,) * 3,
                         (p.lining_shear_normal, p.lining_shear_normal, p.lining_shear_in_plane))
    plate, lost = isotropic(p.backplate_young, p.backplate_poisson), p.backplate_loss_factor
    table = [("lining", p.lining_density, lining, p.lining_loss_factor), ("steel", p.backplate_density, plate, lost),
             *(("weighted steel", density, plate, lost) for density in weighted)]
    if p.shim_rubber_thickness:
        rubber = isotropic(2 * p.shim_rubber_shear * (1 + p.shim_rubber_poisson), p.shim_rubber_poisson)
        table += zip(SHIM, (p.shim_rubber_density, p.backplate_density), (rubber, plate),
                     (p.shim_rubber_loss_factor, 0.0), strict=True)
    names, *values = zip(*table, strict=True)
    return names, *(np.array(value) for value in values)


def shim_thickness(pad):
    """Thickness in m of rubber and cover on the back of a backplate; 0 without a shim."""
    return pad.shim_rubber_thickness + pad.shim_cover_thickness if pad.shim_rubber_thickness else 0.0


def mean_radius(pad):
    """Radius at which lengths along sliding are measured."""
    return (pad.inner_radius + pad.outer_radius) / 2


def _half_slot(p):
    """Half the angle of the slot; 0 without one."""
    return p.slot_width / 2 / mean_radius(p)


def _angles(p):
    cells = p.patches_angular * p.cells_per_patch
    if not p.slot_width:
        return np.linspace(-p.angle / 2, p.angle / 2, cells + 1)
    half = _half_slot(p)
    return divided([-p.angle / 2, -half, half, p.angle / 2], p.angle / cells)


def _heights(p):
    """Lattice lines through the pad, with one at the depths that are stated."""
    depths = {depth for depth in (p.chamfer_depth, p.slot_depth) if depth is not None}
    lines = np.linspace(0, p.lining_thickness, p.lining_layers + 1)
    if depths:
        lines = divided(sorted({0.0, *depths, p.lining_thickness}), p.lining_thickness / p.lining_layers)
    back = p.lining_thickness + p.backplate_thickness
    shim = (back + p.shim_rubber_thickness, back + shim_thickness(p)) if p.shim_rubber_thickness else ()
    return np.r_[lines, back, shim]


def _slotted(p, angle, height):
    """(angles - 1, heights - 1) whether a cell lies in the slot."""
    along, up = ((line[:-1] + line[1:]) / 2 for line in (angle, height))
    return (abs(along) < _half_slot(p))[:, None] & (up < p.slot_depth)


def _chamfered(p, node, height):
    """Nodes (n, 3), those of the lining moved along the circles so that its ends are chamfered."""
    radius, angle = np.hypot(*node[:, :2].T), np.arctan2(node[:, 1], node[:, 0])
    inner, cut = _half_slot(p), p.chamfer_length / mean_radius(p)
    end = cut * np.clip(1 - height / p.chamfer_depth, 0, 1)
    away = np.clip((abs(angle) - inner) / (p.angle / 2 - inner), 0, None)
    turned = np.sign(angle) * (abs(angle) - end * away)
    return np.column_stack((radius * np.cos(turned), radius * np.sin(turned), node[:, 2]))


def _weights(p, angle):
    """[(cell along sliding, density)] of the ends of the backplate that bear a weight."""
    if not p.added_mass:
        return []
    area = (p.outer_radius**2 - p.inner_radius**2) / 2 * p.backplate_thickness
    return [(cell, p.backplate_density + share * p.added_mass / (area * float(np.diff(angle)[cell])))
            for cell, share in zip((0, -1), _ENDS[p.added_mass_at], strict=True) if share]


def refuse_unfit_shape(pad):
    """ConfigError for chamfers and slots that do not fit a pad, and for those of a pad from a mesh file."""
    p, where = pad, "structure.pad"
    if p.mesh_file:
        refuse_beside_file(p, "pad", ("chamfer_length", "slot_width", "added_mass", "shim_rubber_thickness"))
        return
    for name, length in (("chamfer", p.chamfer_length), ("slot", p.slot_width)):
        depth = getattr(p, f"{name}_depth")
        if length and depth is None:
            raise ConfigError(f"{where}.{name}_depth", f"how deep the {name} is", "none",
                              f"state it, such as {name}_depth: 3 mm")
        if depth is not None and depth > p.lining_thickness:
            raise ConfigError(f"{where}.{name}_depth", f"at most the lining, {p.lining_thickness:g} m", f"{depth:g} m")
    steepest = _STEEP * p.chamfer_length * p.outer_radius / mean_radius(p)
    if p.chamfer_length and p.chamfer_depth < steepest:
        raise ConfigError(f"{where}.chamfer_depth", f"at least {steepest:.3g} m, as a flatter chamfer would touch the"
                          " disc", f"{p.chamfer_depth:g} m", "shorten the chamfer, or state a smaller pad.angle")
    taken, length = p.chamfer_length + p.slot_width / 2, p.angle / 2 * mean_radius(p)
    if taken > _TAKEN * length:
        raise ConfigError(f"{where}.{'chamfer_length' if p.chamfer_length else 'slot_width'}",
                          f"at most {_TAKEN * length:.3g} m from half the lining for a chamfer and half the slot",
                          f"{taken:.3g} m", "leave more of its face")


def refuse_beside_file(section, part, shapes):
    """ConfigError where the section of a ``part`` from a mesh file states one of the ``shapes`` (names of settings)."""
    for name in shapes:
        if getattr(section, name):
            raise ConfigError(f"structure.{part}.{name}", f"none beside mesh_file, whose {part} has the shape of its"
                              " mesh", f"{getattr(section, name):g}", "mesh it, or leave the file out")
