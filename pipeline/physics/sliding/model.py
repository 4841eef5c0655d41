"""The reduced sliding model: bodies in reduced coordinates q, joints, and points that slide with friction.

    M q'' + (C + W G + sum_j c_j b_j b_j^T) q' + (K + W^2 Kc + sum_j k_j b_j b_j^T) q = sum_i (n_i N_i + t_i T_i) + f,

W is the speed of the drive, f the force of the inputs. Contact i opens along its normal row, n_i q > 0; N_i >= 0
presses the rubbed body away, T_i is the friction force on it, along the sliding velocity v_i = lever_i W. About steady
sliding under the preload N0:

    N = N0 - k n q - c n q',    T = sgn(v) mu N,    slip = |v| - sgn(v) t q',                                       (1)
    dT = -sgn(v) (mu + p dmu/dp) (k n q + c n q') - N0 dmu/dslip t q',                                              (2)
    dL = -(mu N0 / |v|) l q',                                                                                       (3)

where (3) is friction-induced damping: friction turns with the slip velocity when the contact moves sideways. Rows stay
where they are as the bodies deform (no follower terms of the normal). Every effect and every solver acts on this
object; no contact at all, free bodies and negative speeds are legal. A contact with a zero normal row is a friction
joint: its N is its preload. A displacement u imposed on the far end of a joint
is the force k u along its row.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.sliding.sliding_terms import friction_terms, pressing_terms, supporting_terms
from pipeline.physics.sliding.structural_damping import equivalent_damping
from pipeline.physics.system.forms import spread
from pipeline.physics.system.system import System, runs


@dataclass(frozen=True)
class Joints:
    """Springs and dampers along the rows b (j, n): elongation b q; stiffness (j,) N/m, damping (j,) N s/m."""

    name: tuple
    rows: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray


@dataclass(frozen=True)
class Contacts:
    """Sliding points: rows (c, n) of the relative displacement, and the state about which they are linearised.

    ``lever`` (c,) is the sliding speed per speed of the drive (the radius in m on a disc, 1 m on a belt), ``position``
    (c, 3) m, ``area`` (c,) m^2, ``preload`` (c,) N, ``stiffness`` (c,) N/m normal stiffness (0 where open), ``damping``
    (c,) N s/m normal damping, ``gap`` (c,) m in the origin of the coordinates, negative where parts are set to press;
    ``waviness``: each a Waviness of the surface under one contact, ``wear`` (c,) 1/N the depth by which a contact
    recedes per normal force and sliding way; only transients see both.
    """

    normal: np.ndarray
    tangent: np.ndarray
    lateral: np.ndarray
    position: np.ndarray
    area: np.ndarray
    lever: np.ndarray
    preload: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray
    gap: np.ndarray | float = 0.0
    waviness: tuple = ()
    wear: np.ndarray | float = 0.0

    @property
    def fixed(self):
        """True (c,) for friction joints, which nothing presses but their preload."""
        return np.ravel(abs(self.normal).sum(axis=1)) == 0

    @property
    def pressure(self):
        """Static contact pressure (c,) in Pa."""
        return self.preload / self.area


@dataclass(frozen=True)
class FrictionState:
    """Friction about the steady state, each () or (c,): mu, its slope over pressure (1/Pa) and slip speed (s/m)."""

    coefficient: np.ndarray | float
    pressure_slope: np.ndarray | float = 0.0
    speed_slope: np.ndarray | float = 0.0

    def load_slope(self, pressure):
        """mu + p dmu/dp (c,): friction force per change of the normal force, at a ``pressure`` (c,) in Pa."""
        return self.coefficient + pressure * self.pressure_slope


@dataclass(frozen=True)
class SlidingModel:
    """Matrices (n, n) of the bodies, without joints and contacts; input rows (i, n), sensor rows (s, n).

    Matrices and rows of joints and contacts may be sparse, for which ``supported``, ``frictionless``,
    ``friction_matrices`` and ``linearised`` serve, and stiffnesses complex: loss factors are their imaginary part.

    ``gyroscopic`` is per unit of ``speed``, ``centrifugal`` per squared speed; ``coordinate_body`` (n,) is the index of
    the body of each coordinate in ``body_name``. ``elements``: each a nonlinear Element, which only transients see.
    ``moved_ends`` {input: joint}: inputs that are displacements of the far end of a joint, along whose row they act.
    ``turning``: what acts about an axis, as joints.NAME, inputs.NAME or masses.NAME: metres and newtons of it are
    radians and N m, at a radius of 1 m.
    """

    body_name: tuple
    coordinate_body: np.ndarray
    mass: np.ndarray
    damping: np.ndarray
    gyroscopic: np.ndarray
    stiffness: np.ndarray
    centrifugal: np.ndarray
    joints: Joints
    contacts: Contacts
    input_name: tuple
    input_rows: np.ndarray
    sensor_name: tuple
    sensor_rows: np.ndarray
    speed: float
    elements: tuple = ()
    moved_ends: dict = field(default_factory=dict)
    turning: frozenset = frozenset()

    @property
    def size(self):
        """Number of coordinates n."""
        return len(self.mass)

    @property
    def sliding_speed(self):
        """Sliding velocity (c,) of the contacts, m/s, signed."""
        return self.contacts.lever * self.speed

    def supporting(self, gyroscopic=True, centrifugal=True):
        """System of the bodies with their joints, contacts left out."""
        return self._sum(supporting_terms(self, gyroscopic, centrifugal))

    def supported(self, gyroscopic=True, centrifugal=True):
        """(M, C, K) of ``supporting``."""
        return self.supporting(gyroscopic, centrifugal).matrices()

    def frictionless(self, gyroscopic=True, centrifugal=True):
        """(M, C, K) with the normal stiffness and damping of the closed contacts, and no friction."""
        return self._sum(supporting_terms(self, gyroscopic, centrifugal) + pressing_terms(self)).matrices()

    def frictional(self, friction, friction_damping=True):
        """System of the linearised friction forces (2) and, if wanted, (3) alone.

        ``friction`` is a FrictionState or a plain coefficient. Raises ConfigError for friction-induced damping where a
        loaded contact does not slide.
        """
        state = friction if isinstance(friction, FrictionState) else FrictionState(friction)
        if friction_damping:
            self._refuse_rest(state.coefficient)
        return self._sum(friction_terms(self, state, friction_damping))

    def friction_matrices(self, friction, friction_damping=True):
        """(C_f, K_f), both (n, n), of ``frictional``."""
        return self.frictional(friction, friction_damping).matrices()[1:]

    def system(self, friction, friction_damping=True, gyroscopic=True, centrifugal=True):
        """System about steady sliding with friction; terms as in the methods above, and all at once."""
        about = self._sum(supporting_terms(self, gyroscopic, centrifugal) + pressing_terms(self))
        return about.and_(self.frictional(friction, friction_damping).terms)

    def linearised(self, friction, friction_damping=True, gyroscopic=True, centrifugal=True):
        """(M, C, K) of ``system``: K is unsymmetric through friction, C through friction and the gyroscopic terms."""
        return self.system(friction, friction_damping, gyroscopic, centrifugal).matrices()

    def _sum(self, terms):
        return System(terms, self.coordinate_body)

    def held(self, *bodies):
        """The model with the named bodies rigid and held: their coordinates are dropped."""
        unknown = set(bodies) - set(self.body_name)
        if unknown:
            raise ConfigError("sliding model: body", f"one of {', '.join(self.body_name)}", ", ".join(sorted(unknown)))
        gone = [self.body_name.index(b) for b in bodies]
        return self.restricted(np.flatnonzero(~np.isin(self.coordinate_body, gone)))

    def restricted(self, kept):
        """The model in the coordinates ``kept`` (indices) alone, the others held at zero."""
        changed = self.projected(np.eye(self.size)[:, kept])
        return replace(changed, coordinate_body=self.coordinate_body[kept])

    def projected(self, basis):
        """The model in coordinates r with q = ``basis`` r, (n, m); ``coordinate_body`` is -1 where bodies mix."""
        def on(rows):
            return rows @ basis

        parts = runs(self.coordinate_body)
        matrices = {name: congruent(getattr(self, name), basis, parts)
                    for name in ("mass", "damping", "gyroscopic", "stiffness", "centrifugal")}
        contacts = replace(self.contacts, normal=on(self.contacts.normal), tangent=on(self.contacts.tangent),
                           lateral=on(self.contacts.lateral))
        return replace(self, **matrices, joints=replace(self.joints, rows=on(self.joints.rows)), contacts=contacts,
                       input_rows=on(self.input_rows), sensor_rows=on(self.sensor_rows),
                       elements=tuple(replace(e, row=on(e.row)) for e in self.elements),
                       coordinate_body=np.full(basis.shape[1], -1))

    def with_joints_scaled(self, group, factor):
        """The model with stiffness and damping of all joints whose name contains ``group`` times ``factor``."""
        chosen = np.array([group in name for name in self.joints.name], bool)
        if not chosen.any():
            raise ConfigError("sliding model: joint", f"part of one of {', '.join(self.joints.name)}", repr(group))
        scale = np.where(chosen, factor, 1.0)
        return replace(self, joints=replace(self.joints, stiffness=self.joints.stiffness * scale,
                                            damping=self.joints.damping * scale))

    def at_speed(self, speed):
        """The model at another speed of its drive."""
        return replace(self, speed=float(speed))

    def direction(self):
        """Sign of sliding (c,); a drive at rest counts as about to turn forwards."""
        return np.where(self.sliding_speed < 0, -1.0, 1.0)

    def coupling(self, friction):
        """sgn(v) (mu + p dmu/dp) (c,) of equation (2) for a FrictionState."""
        return self.direction() * friction.load_slope(self.contacts.pressure)

    def turning_drag(self, coefficient):
        """mu N0 / |v| (c,) in N s/m of equation (3); 0 where a contact does not slide."""
        force, speed = coefficient * self.contacts.preload, abs(self.sliding_speed)
        return np.divide(force, speed, out=np.zeros(len(speed)), where=speed > 0)

    def _refuse_rest(self, coefficient):
        """ConfigError where a contact with friction that could move sideways does not slide."""
        sideways = np.asarray(abs(self.contacts.lateral).sum(axis=1)).ravel() > 0
        if np.any(sideways & (coefficient * self.contacts.preload != 0) & (self.sliding_speed == 0)):
            raise ConfigError("friction-induced damping", "every loaded contact to slide", "a sliding speed of 0",
                              "give a speed, or leave friction_damping out")


def sliding_model(reduced, state, speed):
    """The sliding model of a product ReducedModel (or any object with its fields).

    ``state`` is the row of its preload table, ``speed`` the speed of the drive in rad/s; a belt counts as a drum of
    radius 1 m. Loss factors join the damping of the bodies, by the real modes of that state (see
    ``structural_damping``).
    """
    reduced = at_state(reduced, state)
    joints = Joints(tuple(reduced.joint_name), reduced.joint_rows, reduced.joint_stiffness, reduced.joint_damping)
    loss = loss_stiffness(reduced)
    contacts = Contacts(
        normal=reduced.contact_normal, tangent=reduced.contact_tangent, lateral=reduced.contact_lateral,
        position=reduced.contact_position, area=reduced.contact_area,
        lever=reduced.contact_lever,
        preload=reduced.preload[state], stiffness=reduced.contact_stiffness[state],
        damping=np.zeros(len(reduced.contact_area)), gap=reduced.contact_gap)
    matrices = {name: getattr(reduced, name) for name in ("mass", "damping", "gyroscopic", "stiffness", "centrifugal")}
    model = SlidingModel(
        body_name=tuple(reduced.body_name), coordinate_body=reduced.coordinate_body, **matrices, joints=joints,
        contacts=contacts, input_name=tuple(reduced.input_name), input_rows=reduced.input_rows,
        sensor_name=tuple(reduced.sensor_name), sensor_rows=reduced.sensor_rows, speed=float(speed),
        moved_ends={n: j for n, j in zip(reduced.input_name, reduced.input_joint, strict=True) if j},
        turning=frozenset(map(str, reduced.turning)))
    if not loss.any():
        return model
    mass, _, stiffness = model.frictionless(gyroscopic=False, centrifugal=False)
    return replace(model, damping=model.damping + equivalent_damping(loss, stiffness, mass))


def at_state(reduced, state):
    """A product ReducedModel, or any object with its fields, with linings as stiff as at a row of its preload table;
    itself where pressure does not stiffen them."""
    return at_pressure(reduced, reduced.pressure[state]) if reduced.lining_exponent else reduced


def at_pressure(reduced, pressure):
    """The same at a nominal ``pressure`` Pa, which is that of its stiffness then."""
    times = (pressure / reduced.lining_pressure) ** reduced.lining_exponent
    more = (times - 1.0) * lining_part(reduced)
    return replace(reduced, stiffness=reduced.stiffness + more, loss=reduced.loss + reduced.lining_loss_factor * more,
                   lining_stiffness=times * reduced.lining_stiffness, lining_pressure=np.asarray(pressure, float))


def lining_part(reduced):
    """Stiffness (n, n) N/m of the linings alone in the coordinates of a product ReducedModel."""
    part = np.zeros_like(reduced.stiffness)
    part[np.ix_(reduced.lining_coordinate, reduced.lining_coordinate)] = reduced.lining_stiffness
    return part


def loss_stiffness(reduced):
    """Imaginary part (n, n) N/m of the stiffness of bodies and joints of a product ReducedModel, by loss factors."""
    rows = reduced.joint_rows
    return reduced.loss + spread(rows, reduced.joint_loss_factor * reduced.joint_stiffness, rows)


def congruent(matrix, basis, parts):
    """``basis``^T ``matrix`` ``basis``, (m, m), without those blocks of ``matrix`` (n, n), by slices, that are 0."""
    if np.iscomplexobj(matrix):
        return congruent(matrix.real, basis, parts) + 1j * congruent(matrix.imag, basis, parts)
    out = np.zeros((basis.shape[1],) * 2, np.result_type(matrix, basis))
    for a in parts:
        coupled = [b for b in parts if matrix[a, b].any()]
        if coupled:
            out += basis[a].T @ sum(matrix[a, b] @ basis[b] for b in coupled)
    return out

