"""A case in few coordinates, in which its roots have the first derivatives that they have in the whole model.

The sliding state q of a case follows from R(q, p) = 0, a root s from y^H T(s, q, p) x = 0, p what is varied. With the
adjoint z of each root,

    (dR/dq)^T z = - (ds/dq)^T,    ds = - y^H (dT/dp dp) x + z^T (dR/dp dp),

where y^H (dT/ds) x = 1: q, x, y and z are all that a derivative asks for, and a basis that holds them keeps it exact.
Contacts and friction follow their laws as ``local_laws`` has them.
"""

from dataclasses import dataclass, fields, make_dataclass, replace

import numpy as np
import scipy

from pipeline.case_models.sensitivity.local_laws import LocalFriction, LocalLaw
from pipeline.case_models.sensitivity.matrices import Case, matrices_about, polished_root, varied
from pipeline.physics.contact.static_preload import Preload
from pipeline.physics.modal.root_derivatives import RootWithVectors
from pipeline.physics.sliding.equilibrium import displacement, given_state, model_about
from pipeline.physics.sliding.model import Joints
from pipeline.physics.stability.draws.whole_roots import linearising, sliding_state
from pipeline.products import ReducedModel

#: matrices and rows of a product ReducedModel that its coordinates span
MATRICES = ("mass", "damping", "gyroscopic", "stiffness", "centrifugal", "loss")
ROWS = ("joint_rows", "contact_normal", "contact_tangent", "contact_lateral", "input_rows", "sensor_rows")
#: vectors that the others of a basis hold to this share are left out
_DEPENDENT = 1e-12
#: change of a closure, as a share of the largest, for the derivative of a root to it
_STEP = 1e-4


#: rows of their tables over which the slopes of contact law and friction are averaged
REACHES = (1, 2)


@dataclass(frozen=True)
class FewCoordinates:
    """A Case on a ``basis`` (n, m): ``small`` is the Case with a model of m coordinates, ``start`` (m,) its sliding
    state, ``modes`` the RootWithVectors of its roots, vectors (m,); ``laws``: of each reach the LocalLaw, None without
    one, and the LocalFriction; ``adjoints`` (reach, r, m) of the roots."""

    case: Case
    small: Case
    basis: np.ndarray
    start: np.ndarray
    modes: tuple
    laws: tuple
    adjoints: np.ndarray

    def on(self, case):
        """A Case of the whole model that differs from ``case``, in the few coordinates."""
        given, known = case.model, self.case.model
        changed = {name: self.basis.T @ getattr(given, name) @ self.basis for name in MATRICES
                   if getattr(given, name) is not getattr(known, name)}
        return replace(case, model=replace(self.small.model, **changed))

    def changes(self, ends, friction_map, points):
        """(reach, r) first-order change of each root, 1/s, from the first to the second of two Cases ``ends`` in the
        few coordinates."""
        found = []
        for reach, adjoints in enumerate(self.adjoints):
            (low, before), (high, after) = (self.about(end, friction_map, points, reach) for end in ends)
            difference = [b - a for a, b in zip(low, high, strict=True)]
            found.append([mode.change(difference) + adjoint @ (after - before)
                          for mode, adjoint in zip(self.modes, adjoints, strict=True)])
        return np.array(found)

    def about(self, case, friction_map, points, reach=0):
        """((M, C, K) each (m, m), imbalance (m,) N) of a Case in the few coordinates about the sliding state of
        ``case``, at rest there."""
        law, friction = self.laws[reach]
        made = varied(case, friction_map, points, friction)
        model, area = made.model.at_speed(case.speed), made.model.contacts.area
        if law is None:
            sliding = given_state(model, made.friction)
            contact, state = sliding.contact, sliding.friction
        else:
            contact = Preload(*law(case.factors.contact_stiffness, law.closure), law.closure)
            state = made.friction(contact.force / area, abs(model.sliding_speed))
        held = model.supported(False, made.centrifugal)[2] @ self.start
        drawn = model.direction() * state.coefficient * contact.force
        pushed = contact.force @ model.contacts.normal + drawn @ model.contacts.tangent
        imbalance = held - made.input_force @ model.input_rows - pushed
        about = model_about(model, contact, made.damping_speed)
        return matrices_about(made, about, linearising(made, state)), imbalance


def few_coordinates(case, roots, friction_map, points):
    """FewCoordinates of a Case, its model Fields as of ``without_surface``, for ``roots`` (r,) 1/s near its own."""
    made = varied(case, friction_map, points)
    sliding = sliding_state(made)
    about = model_about(made.model, sliding.contact, made.damping_speed)
    whole = matrices_about(made, about, linearising(made, sliding.friction))
    modes = [polished_root(whole, root) for root in roots]
    laws = tuple((LocalLaw.about(made, sliding, reach) if made.has_law else None,
                  LocalFriction.about(made, sliding, friction_map, reach)) for reach in REACHES)
    still, adjoints = np.zeros(about.size), np.zeros((len(laws) * len(modes), about.size))
    if made.has_law:
        still = displacement(about, sliding.contact, sliding.friction.coefficient, made.input_force, made.centrifugal)
        adjoints = _adjoints(about, sliding, made.centrifugal, [
            by_closure(replace(made, friction=friction), law, mode) for law, friction in laws for mode in modes])
    vectors = [still, *(v for mode in modes for v in (mode.right, mode.left)), *adjoints]
    basis = _orthonormal(np.column_stack([part(v) for v in vectors for part in (np.real, np.imag)]))
    small = replace(case, model=_on(case.model, basis))
    inside = tuple(RootWithVectors(m.root, basis.T @ m.right, basis.T @ m.left) for m in modes)
    return FewCoordinates(case, small, basis, basis.T @ still, inside, laws,
                          (adjoints @ basis).reshape(len(laws), len(modes), -1))


def _adjoints(about, sliding, centrifugal, by_closures):
    """(a, n) adjoints for ``by_closures`` [(c,)] ds/dc to the sliding state of a SlidingModel linearised about it."""
    tangent = about.frictionless(centrifugal=centrifugal)[2] + about.friction_matrices(sliding.friction, False)[1]
    return np.linalg.solve(tangent.T, about.contacts.normal.T @ np.array(by_closures).T).T


def by_closure(family, law, mode):
    """ds / dc (c,), 1/(s m): change of the root of a RootWithVectors ``mode`` by the closure of each contact.

    ``family``: the Family of its model; ``law``: the LocalLaw about its sliding state.
    """
    step = _STEP * abs(law.closure).max(initial=0.0)
    ends = [_of_contacts(family, law, law.closure + side * step, mode) for side in (-1, 1)]
    return (ends[0] - ends[1]) / (2 * step)


def _of_contacts(family, law, closure, mode):
    """(c,) part of each contact in y^H T x, at other closures (c,)."""
    contacts, count = family.model.contacts, len(closure)
    force, slope = law(1.0, closure)
    friction = linearising(family, family.friction(force / contacts.area, abs(family.model.sliding_speed)))
    about = model_about(_contacts_alone(family.model), Preload(force, slope, closure), family.damping_speed)
    _, damping, stiffness = about.linearised(friction, family.friction_damping, False, False)
    rows = np.vstack((contacts.normal, contacts.tangent, contacts.lateral))
    right, left = rows @ mode.right, rows @ mode.left
    return (left.conj() * (mode.root * (damping @ right) + stiffness @ right)).reshape(3, count).sum(axis=0)


def _contacts_alone(model):
    """A SlidingModel whose coordinates are the normal, tangential and lateral displacements of the contacts."""
    count = len(model.contacts.area)
    normal, tangent, lateral = (scipy.sparse.eye(count, 3 * count, k * count, format="csr") for k in range(3))
    none = scipy.sparse.csr_matrix((3 * count, 3 * count))
    rows = scipy.sparse.csr_matrix((0, 3 * count))
    matrices = dict.fromkeys(("mass", "damping", "gyroscopic", "stiffness", "centrifugal"), none)
    contacts = replace(model.contacts, normal=normal, tangent=tangent, lateral=lateral)
    return replace(model, **matrices, joints=Joints((), rows, np.zeros(0), np.zeros(0)), contacts=contacts,
                   coordinate_body=np.zeros(3 * count, int))


#: the fields of a product ReducedModel, in an object that does not check them at every change
Fields = make_dataclass("Fields", [f.name for f in fields(ReducedModel)], frozen=True,
                        namespace={"__module__": __name__})


def without_surface(model):
    """The Fields of a product ReducedModel, without what pictures alone need."""
    kept = {f.name: getattr(model, f.name) for f in fields(ReducedModel)}
    return Fields(**{**kept, "visible_position": np.empty((0, 3)), "visible_body": np.empty(0, int),
                     "visible_face": np.empty((0, 4), int), "recovery": np.empty((0, 3, len(model.mass)))})


def _on(model, basis):
    """Fields on a ``basis`` (n, m), whose coordinates mix bodies; nothing scatters in their linings."""
    changed = {name: basis.T @ getattr(model, name) @ basis for name in MATRICES}
    changed |= {name: getattr(model, name) @ basis for name in ROWS}
    return replace(model, **changed, coordinate_body=np.zeros(basis.shape[1], int), lining_coordinate=np.empty(0, int),
                   lining_stiffness=np.empty((0, 0)), recovery=np.empty((0, 3, basis.shape[1])))


def _orthonormal(vectors):
    """(n, m) orthonormal vectors that span those of ``vectors`` (n, v) that differ."""
    sizes = np.linalg.norm(vectors, axis=0)
    left, size, _ = scipy.linalg.svd(vectors[:, sizes > 0] / sizes[sizes > 0], full_matrices=False)
    return left[:, size > _DEPENDENT * size[0]]
