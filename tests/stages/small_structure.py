"""A Structure of a few elements for stage tests: ring, two pads, caliper block, four contacts per pad."""

import numpy as np

from pipeline.physics.fem.elasticity import assemble, isotropic
from pipeline.physics.fem.face_averages import interpolation
from pipeline.physics.fem.mesh import block, boundary_faces, face_normals, revolve
from pipeline.physics.fem.supports import held_modes
from pipeline.products import Body, FrictionMap, Incidence, Structure

NAMES = ("disc", "pad_outer", "pad_inner", "caliper")
DISC, OUTER, INNER, CALIPER = range(4)
RADIUS, ANGLE = np.array([0.08125, 0.09375]), np.array([-0.15, 0.15])
AREA, CONTACT_STIFFNESS = 2.2e-4, 2e7


def small_structure(pad_modulus=1e9, caliper_stiffness=3e7, modes_below=12e3):
    """A Structure at 1 and 2 MPa whose contacts are springs of one stiffness."""
    meshes, moduli = small_meshes(), (120e9, pad_modulus, pad_modulus, 170e9)
    densities, limits = (7200.0, 2600.0, 2600.0, 7000.0), (modes_below, 0, 0, 0)
    supports = (np.flatnonzero(np.hypot(*meshes[DISC].node[:, :2].T) < 0.0501), *(np.empty(0, int),) * 3)
    bodies = {name: small_body(*of_one)
              for name, *of_one in zip(NAMES, meshes, moduli, densities, supports, limits, strict=True)}
    place, pads = contact_places()
    names, joints, piston = small_joints(meshes)
    area = np.full(len(pads), AREA)
    return Structure(
        body_name=NAMES, **bodies, lining_exponent=0.0, lining_pressure=1e6, mesh_note=[], mesh_given=[],
        free_frequency=[1.0], free_diameters=[2], free_out_of_plane=[1.0],
        joint_name=names, joint_rows=incidence(joints), joint_damping=np.full(len(names), 20.0),
        joint_loss_factor=np.zeros(len(names)),
        joint_stiffness=np.where(np.array(names) == "finger", caliper_stiffness, 1e7),
        contact_body=pads, contact_position=place, contact_area=area, **contact_rows(meshes, place, pads),
        pressure=[1e6, 2e6], preload=np.outer([1e6, 2e6], area),
        contact_stiffness=np.full((2, len(pads)), CONTACT_STIFFNESS), closed=np.ones((2, len(pads)), int),
        law_closure=[0.0, 1e-5], law_pressure=[0.0, 1e6], sensor_name=["rim"], sensor_position=[[0.1, 0.0, 0.01]],
        sensor_direction=[[0, 0, 1.0]], piston_rows=incidence([piston]), piston_area=4 * AREA, others={},
        fluid_stiffness=[], fluid_loss_factor=[], line_inertia=[], line_drag=[],
        sensor_rows=incidence([point_entries(meshes, DISC, [0.1, 0.0, 0.01], [0, 0, 1.0], 1.0)]))


def small_friction_map(friction=0.5):
    """A constant friction coefficient."""
    return FrictionMap(
        pressure=[1e5, 1e7], speed=[0.1, 10.0], distance=[0.0, 1.0], friction=np.full((2, 2, 2), friction),
        friction_std=np.zeros((2, 2, 2)), normal_stiffness=np.full((2, 2), 1e12), computed_pressure=[1e5],
        computed_speed=[0.1], best_pressure=[1e6, 1e6], pressure_slope_std=[0.0, 0.0], speed_slope_std=[0.0, 0.0],
        error_correlation=np.tile(np.eye(3), (2, 1, 1)), bulk_temperature=0.0)


def small_meshes():
    """Ring of radii 50 to 100 mm and 10 mm thickness, pads on both faces, a caliper block outside."""
    ring = revolve(np.array([0.05, 0.075, 0.1]), np.linspace(0, 2 * np.pi, 13), np.array([0.0, 0.01]))
    pads = [revolve(np.array([0.075, 0.0875, 0.1]), np.array([-0.3, 0.0, 0.3]), height)
            for height in (np.array([0.01, 0.02]), np.array([-0.01, 0.0]))]
    caliper = block(np.array([0.11, 0.13]), np.array([-0.03, 0.0, 0.03]), np.array([-0.02, 0.03]), kind="hexahedron27")
    return ring, *pads, caliper


def small_body(mesh, modulus, density, supported, modes_below):
    """A Body of one isotropic material; modes only where a limit is given."""
    elastic, cells = isotropic(modulus, 0.27), np.zeros(len(mesh.element), int)
    frequency, shape = np.array([1.0]), np.zeros((1, 3 * len(mesh.node)))
    if modes_below:
        matrices = assemble(mesh.node, mesh.element, mesh.kind, cells, np.array([density]), elastic[None])
        frequency, modes = held_modes(*matrices, supported, "superlu", below=modes_below)
        shape = modes.T
    return Body(node=mesh.node, element=mesh.element, kind=mesh.kind, element_material=cells, material_name=["one"],
                density=[density], elasticity=[elastic], loss_factor=[0.0], damping_ratio=0.002, frequency=frequency,
                shape=shape.reshape(len(frequency), -1, 3), supported=supported)


def contact_places():
    """Positions (8, 3) on both faces of the ring and the pad of each."""
    grid = np.array([(r * np.cos(a), r * np.sin(a)) for r in RADIUS for a in ANGLE])
    place = np.vstack([np.column_stack((grid, np.full(4, z))) for z in (0.01, 0.0)])
    return place, np.repeat([OUTER, INNER], 4)


def contact_rows(meshes, place, pads):
    """Normal, tangent and lateral rows of the contacts, pad minus disc."""
    radial = np.column_stack((place[:, :2] / np.hypot(*place[:, :2].T)[:, None], np.zeros(len(place))))
    directions = {"normal": np.where(pads == OUTER, 1.0, -1.0)[:, None] * np.array([0, 0, 1.0]),
                  "tangent": np.cross([0.0, 0.0, 1.0], radial), "lateral": radial}
    return {f"contact_{name}": incidence([
        [*point_entries(meshes, pad, p, d, 1.0), *point_entries(meshes, DISC, p, d, -1.0)]
        for pad, p, d in zip(pads, place, direction, strict=True)]) for name, direction in directions.items()}


def small_joints(meshes):
    """Names and rows: pads held in their plane, fingers on the outer pad, caliper on the ground; the piston row."""
    names, rows = [], []
    for pad, side, z in ((OUTER, "outer", 0.02), (INNER, "inner", -0.01)):
        for end, angle in (("leading", -0.25), ("trailing", 0.25)):
            corner = np.array([0.09 * np.cos(angle), 0.09 * np.sin(angle), z])
            for axis, tag in enumerate(("radial", "tangential")):
                names.append(f"abutment_{side}_{end}_{tag}")
                rows.append(point_entries(meshes, pad, corner, np.eye(3)[axis], 1.0))
    back, inside = np.array([0.0875, 0.0, 0.02]), np.array([0.11, 0.0, 0.005])
    names.append("finger")
    rows.append([*point_entries(meshes, CALIPER, inside, [0, 0, 1.0], 1.0),
                 *point_entries(meshes, OUTER, back, [0, 0, 1.0], -1.0)])
    for k, corner in enumerate(np.array([[0.13, -0.03, -0.02], [0.13, 0.03, -0.02], [0.13, 0.0, 0.03]])):
        for axis in range(3):
            names.append(f"guide_{k}_{'xyz'[axis]}")
            rows.append(point_entries(meshes, CALIPER, corner, np.eye(3)[axis], 1.0))
    piston = [*point_entries(meshes, INNER, back - [0, 0, 0.03], [0, 0, 1.0], 1.0),
              *point_entries(meshes, CALIPER, inside, [0, 0, 1.0], -1.0)]
    return names, rows, piston


def point_entries(meshes, body, point, direction, weight):
    """(body, node, axis, weight) of the displacement of a surface point along a direction."""
    mesh, faces = meshes[body], boundary_faces(meshes[body])
    normal, _ = face_normals(mesh.node, faces)
    faces = faces if body == CALIPER else faces[abs(normal[:, 2]) > 0.9]
    found, shape = interpolation(mesh.node, faces, np.atleast_2d(point), distance=1e-4)
    return [(body, n, axis, weight * s * direction[axis]) for n, s in zip(faces[found[0]], shape[0], strict=True)
            for axis in range(3) if direction[axis]]


def incidence(rows):
    """The Incidence of a list of rows of entries."""
    entries = [(k, *entry) for k, row in enumerate(rows) for entry in row]
    row, body, node, axis, weight = (list(column) for column in zip(*entries, strict=True))
    return Incidence(rows=len(rows), row=row, body=body, node=node, axis=axis, weight=weight)
