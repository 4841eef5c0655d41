"""Systems of finite-element bodies as products, and back: what brake and pin on disc share between their stages."""

from dataclasses import replace

import numpy as np
import scipy

from pipeline.physics.fem.supports import free_freedoms
from pipeline.physics.fem.ties import Tie
from pipeline.physics.numerics.sparse_blocks import on_diagonal
from pipeline.physics.numerics.sparse_solver import factorise
from pipeline.physics.reduction.body import ElasticBody, rotation
from pipeline.physics.reduction.load_patterns import load_patterns
from pipeline.physics.sliding.model import Contacts, Joints, SlidingModel
from pipeline.products import Body, Incidence, MeshTie, PinOnDisc, Structure

#: material of friction linings
LINING = "lining"
#: what presses the contacts of a system, in its fields <input>_rows and <input>_area
INPUTS = {Structure: "piston", PinOnDisc: "load"}
#: the fluid in the brake line as a body, and the joint by which it holds the piston
LINE, COLUMN = "brake_fluid", "fluid_column"


def body_product(solid, frequency=(), shape=None):
    """Body of a Solid with its modes: ``frequency`` (m,) Hz, ``shape`` (3n, m) 1/kg^0.5; none by default."""
    mesh, count = solid.mesh, len(frequency)
    shape = np.zeros((3 * len(mesh.node), 0)) if shape is None else shape
    return Body(node=mesh.node, element=mesh.element, kind=mesh.kind, element_material=solid.element_material,
                material_name=solid.material_name, density=solid.density, elasticity=solid.elasticity,
                loss_factor=np.broadcast_to(solid.loss_factor, len(solid.density)), damping_ratio=solid.damping_ratio,
                frequency=frequency,
                shape=shape.T.reshape(count, len(mesh.node), 3), supported=solid.supported,
                ties={f"tie_{k}": _tie_product(tie) for k, tie in enumerate(solid.ties, 1)})


def _tie_product(tie):
    rows = tie.rows.tocoo()
    return MeshTie(row=rows.row, node=rows.col, weight=rows.data, area=tie.area, stiffness=tie.stiffness,
                   share=tie.share)


def _ties(body):
    """Ties of a Body."""
    return tuple(Tie(scipy.sparse.csr_matrix((t.weight, (t.row, t.node)), (len(t.area), len(body.node))), t.area,
                     float(t.stiffness), float(t.share)) for t in body.ties.values())


def incidence(rows):
    """Incidence of Rows; weights of 0 are left out."""
    parts = [part.tocoo() for part in rows.parts]
    body = np.repeat(np.arange(len(parts)), [part.nnz for part in parts])
    row, column, weight = (np.concatenate([getattr(part, name) for part in parts]) for name in ("row", "col", "data"))
    used = weight != 0
    return Incidence(rows=rows.count, row=row[used], body=body[used], node=column[used] // 3,
                     axis=column[used] % 3, weight=weight[used])


def assembly_fields(assembly):
    """Fields of joints, contacts and sensors of an Assembly, under the names that its products share."""
    joints, contacts = assembly.joints, assembly.contacts
    return {
        "joint_name": joints.name, "joint_rows": incidence(joints.rows), "joint_stiffness": joints.stiffness,
        "joint_damping": joints.damping, "joint_loss_factor": np.broadcast_to(joints.loss_factor, len(joints.name)),
        "contact_body": contacts.body, "contact_position": contacts.position,
        "contact_area": contacts.area, "contact_normal": incidence(contacts.normal),
        "contact_tangent": incidence(contacts.tangent), "contact_lateral": incidence(contacts.lateral),
        "sensor_position": assembly.sensor_position, "sensor_direction": assembly.sensor_direction,
        "sensor_rows": incidence(assembly.sensors)}


def row_fields(system):
    """Fields of all rows of a product: those that carry forces, then those of the sensors, which only observe."""
    return ("joint_rows", "contact_normal", "contact_tangent", "contact_lateral", f"{INPUTS[type(system)]}_rows",
            "sensor_rows")


def elastic_body(system, name, patterns=None):
    """ElasticBody of the body ``name`` of a product, with its part of every row.

    ``patterns``: those of ``force_patterns``; None = every force by itself, and modes only where the body is supported.
    """
    body, index = system.body(name), list(system.body_name).index(name)
    incidences = [getattr(system, field) for field in row_fields(system)]
    rows = scipy.sparse.vstack([body_rows(i, index, len(body.node)) for i in incidences], format="csr")
    count = len(body.frequency) if len(body.supported) or patterns is not None else 0
    return ElasticBody(
        name=name, node=body.node, element=body.element, kind=str(body.kind), material=body.element_material,
        density=body.density, elasticity=body.elasticity, damping_ratio=float(body.damping_ratio),
        supported=body.supported, rows=rows, interface=np.arange(sum(int(i.rows) for i in incidences[:-1])),
        turns=name == "disc", frequency=body.frequency[:count],
        modes=body.shape[:count].reshape(count, 3 * len(body.node)).T, patterns=patterns,
        loss_factor=body.loss_factor, ties=_ties(body),
        part=tuple(np.flatnonzero(np.asarray(body.material_name) == LINING)))


def force_patterns(system, orders):
    """(forces, p) sparse: patterns of the contact forces in each of three directions, joints and inputs one by one.

    ``orders``: see ``load_patterns``. Forces stand in the order of ``row_fields``.
    """
    contacts = load_patterns(system.contact_position, system.contact_area, system.contact_body, orders)
    blocks = [contacts if field.startswith("contact_") else scipy.sparse.identity(int(getattr(system, field).rows))
              for field in row_fields(system)[:-1]]
    return on_diagonal(blocks)


def body_rows(incidence, body, nodes):
    """(rows, 3 nodes) sparse: the part of an Incidence that one body, by its number, moves."""
    chosen = incidence.body == body
    place = incidence.row[chosen], 3 * incidence.node[chosen] + incidence.axis[chosen]
    return scipy.sparse.csr_matrix((incidence.weight[chosen], place), (int(incidence.rows), 3 * nodes))


def full_model(system, solver):
    """SlidingModel of the finite elements of a product without any reduction: sparse, supported nodes left out.

    Loss factors are the imaginary parts of the stiffnesses. A damping ratio of a body, which says what its modes lose
    and no more, does not enter. Contacts are in the first state of the preload; the drive is at rest.
    """
    bodies = [elastic_body(system, name) for name in system.body_name]
    free = [free_freedoms(len(b.node), b.supported) for b in bodies]
    parts = zip(*(full_matrices(*each, solver) for each in zip(bodies, free, strict=True)), strict=True)
    names, sizes = ("mass", "stiffness", "gyroscopic", "centrifugal"), [len(each) for each in free]
    matrices = {name: on_diagonal(part) for name, part in zip(names, parts, strict=True)}
    fields, name = row_fields(system), INPUTS[type(system)]
    rows = [scipy.sparse.hstack([body_rows(getattr(system, field), k, len(b.node))[:, f]
                                 for k, (b, f) in enumerate(zip(bodies, free, strict=True))], format="csr")
            for field in fields]
    joints, normal, tangent, lateral, inputs, sensors = rows
    area, position = system.contact_area, system.contact_position
    model = SlidingModel(
        body_name=tuple(system.body_name), coordinate_body=np.repeat(np.arange(len(sizes)), sizes), **matrices,
        damping=scipy.sparse.csr_matrix((sum(sizes),) * 2),
        joints=Joints(tuple(system.joint_name), joints, system.joint_stiffness * (1 + 1j * system.joint_loss_factor),
                      system.joint_damping),
        contacts=Contacts(normal, tangent, lateral, position, area, np.hypot(*position[:, :2].T), system.preload[0],
                          system.contact_stiffness[0], np.zeros(len(area))),
        input_name=tuple(f"{name}_{k + 1}" for k in range(inputs.shape[0])), input_rows=inputs,
        sensor_name=tuple(system.sensor_name), sensor_rows=sensors, speed=0.0)
    return with_fluid(model, system) if has_fluid(system) else model


def has_fluid(system):
    """Whether a product has brake fluid behind a piston."""
    return isinstance(system, Structure) and len(system.fluid_stiffness) > 0


def with_fluid(model, structure):
    """A sparse SlidingModel with the fluid of the lines, masses on which the columns in the bores end; ``structure``:
    a product Structure, or another with its fields of the fluid."""
    beside, count = {"mass": structure.line_inertia, "damping": structure.line_drag}, len(structure.line_inertia)
    matrices = {name: on_diagonal((getattr(model, name), np.diag(beside.get(name, np.zeros(count)))))
                for name in ("mass", "damping", "gyroscopic", "stiffness", "centrifugal")}
    contacts = replace(model.contacts, **{name: _widened(getattr(model.contacts, name), count)
                                          for name in ("normal", "tangent", "lateral")})
    columns = scipy.sparse.hstack([model.input_rows, -np.eye(count)])
    joints = Joints((*model.joints.name, *columns_of(count)),
                    scipy.sparse.vstack([_widened(model.joints.rows, count), columns], "csr"),
                    np.append(model.joints.stiffness,
                              structure.fluid_stiffness * (1 + 1j * structure.fluid_loss_factor)),
                    np.append(model.joints.damping, np.zeros(count)))
    return replace(model, **matrices, body_name=(*model.body_name, LINE), joints=joints, contacts=contacts,
                   coordinate_body=np.append(model.coordinate_body, np.full(count, len(model.body_name))),
                   input_rows=_widened(model.input_rows, count), sensor_rows=_widened(model.sensor_rows, count))


def columns_of(count):
    """Names of the joints by which the fluid of ``count`` lines holds the pistons."""
    return tuple([COLUMN] if count == 1 else [f"{COLUMN}_{k + 1}" for k in range(count)])


def _widened(rows, count):
    """Sparse ``rows`` with ``count`` coordinates that they do not see."""
    return scipy.sparse.hstack([rows, scipy.sparse.csr_matrix((rows.shape[0], count))], "csr")


def full_matrices(body, free, solver):
    """Mass, complex stiffness, gyroscopic and centrifugal matrix of an ElasticBody in its freedoms ``free``, sparse."""
    stiffness, mass = (matrix[free][:, free] for matrix in body.matrices())
    none = scipy.sparse.csr_matrix(mass.shape)
    turning = rotation(body, free, factorise(stiffness, solver)) if body.turns else (none, none)
    return mass, (stiffness + 1j * body.loss()[free][:, free]).tocsr(), *turning
