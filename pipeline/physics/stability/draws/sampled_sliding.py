"""Steady sliding of many draws of a Family, on a Galerkin basis of static answers.

The equations are those of ``sliding.equilibrium``, for the motion q = S a,

    S^T (K q + F(q) - f - sum_i n_i N_i - t_i s_i mu_i N_i) = 0,    N_i = A_i p(-n_i q - g_i),

F being what elements of effects rest on. S begins with the answers to the inputs, the joints and the elements. While
the balance of a training draw leaves a residual in the whole model, the answer to it joins S.
"""

from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np
import scipy

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.numerics.damped_newton import damped_newton
from pipeline.physics.sliding.equilibrium import model_about
from pipeline.physics.sliding.model import FrictionState, SlidingModel
from pipeline.physics.stability.draws.added_physics import resting, slopes_of_elements
from pipeline.physics.stability.draws.scatter import NOMINAL, Family, changed_friction
from pipeline.physics.stability.linearisation import with_slopes

_ITERATIONS, _HALVINGS = 60, 12
#: imbalance of a contact force, as a share of the largest, that ends Newton's method
_BALANCED = 1e-7
#: the same, in the whole model, up to which a training draw is served by the basis
_SERVED = 1e-3
_ROUNDS = 12
#: static answers that the others hold to this share are left out
_DEPENDENT, _TINY = 1e-12, np.finfo(float).tiny


@dataclass(frozen=True)
class Contact:
    """``force`` (c,) N and ``stiffness`` (c,) N/m in steady sliding, and the FrictionState there.

    ``damping`` (c,) N s/m by a law of effects, None without one; ``slopes`` (2, e) N/m and N s/m of the elements.
    """

    force: np.ndarray
    stiffness: np.ndarray
    friction: FrictionState
    damping: np.ndarray | None = None
    slopes: np.ndarray = field(default_factory=lambda: np.zeros((2, 0)))


@dataclass(frozen=True)
class SlidingBasis:
    """A Family on s static answers ``shape`` (n, s): ``small`` is its SlidingModel, ``lining`` (s, s) N/m or None.

    ``start`` (s,): where Newton's method sets out. ``residual``: largest change of a contact force, as a share of the
    largest, that the whole model would still make to a training draw.
    """

    family: Family
    shape: np.ndarray
    small: SlidingModel
    lining: np.ndarray | None
    start: np.ndarray
    residual: float = np.inf

    def compact(self, family):
        """The same without the whole model, of a Family that lacks it."""
        return replace(self, family=family, shape=self.shape[:0])

    def slide(self, factors, speed):
        """Contact of a draw at ``speed`` rad/s. Raises ConvergenceError where no sliding state is found."""
        return self._contact_in(self.solve(factors, speed), factors, speed)

    def _contact_in(self, state, factors, speed):
        """Contact of a draw in its sliding state (s,)."""
        family, small, (force, slope), damping = self.family, self.small.at_speed(speed), self._contact(
            factors, state), None
        friction = _friction(family, factors, small, force)
        if family.law_added:
            slope, damping = family.added.tangent(small.contacts.area, np.where(small.contacts.fixed, 0.0, force),
                                                  factors)
        drawn = small.direction() * friction.coefficient * force
        return Contact(force, slope, friction, damping, slopes_of_elements(small, state, force, drawn))

    def solve(self, factors, speed):
        """Coordinates (s,) of the sliding state of a draw, by Newton's method."""
        small = self.small.at_speed(speed)

        def imbalance(step, force, slope):
            change = abs(slope * (small.contacts.normal @ step)).max(initial=0.0)
            return change / max(force.max(initial=0.0), _TINY)

        reached = damped_newton(partial(self._miss, factors, small, self._stiffness(factors, speed)), self.start,
                                imbalance, _BALANCED, _ITERATIONS, _HALVINGS)
        if reached.error <= _BALANCED:
            return reached.unknown - reached.step
        raise ConvergenceError("steady sliding of a draw", f"contact forces that balance within {_BALANCED:g}",
                               f"changes of {reached.error:.3g} of the largest",
                               "narrow the scatter of friction or stiffness in probability.sources")

    def residual_of(self, factors, speed):
        """(n,) N: imbalance of the sliding state of a draw in the whole model."""
        family, model, state = self.family, self.family.model.at_speed(speed), self.solve(factors, speed)
        contact, motion = self._contact_in(state, factors, speed), self.shape @ state
        drawn = model.direction() * contact.friction.coefficient * contact.force
        held = model.stiffness @ motion + _joint_force(model.joints, factors, motion)
        if self.lining is not None:
            held = held + (factors.lining - 1) * (family.lining @ motion)
        if family.centrifugal:
            held = held + speed**2 * (model.centrifugal @ motion)
        held = held + resting(model, motion)[0]
        pushed = contact.force @ model.contacts.normal + drawn @ model.contacts.tangent
        return family.input_force @ model.input_rows + pushed - held

    def _stiffness(self, factors, speed):
        """(s, s) N/m of bodies and joints."""
        stiffness = self.small.stiffness + _joint_force(self.small.joints, factors, np.eye(len(self.start)))
        if self.lining is not None:
            stiffness = stiffness + (factors.lining - 1) * self.lining
        return stiffness + speed**2 * self.small.centrifugal if self.family.centrifugal else stiffness

    def _contact(self, factors, state):
        """(force (c,) N, stiffness (c,) N/m) of the contacts."""
        contacts = self.small.contacts
        return self.family.pressed(contacts, factors, -(contacts.normal @ state + contacts.gap))

    def _miss(self, factors, small, stiffness, state):
        """(imbalance (s,), its derivative (s, s), contact forces (c,) and their slopes (c,))."""
        contacts, sign = small.contacts, small.direction()
        force, slope = self._contact(factors, state)
        friction = _friction(self.family, factors, small, force)
        coupling = sign * friction.load_slope(force / contacts.area)
        load = self.family.input_force @ small.input_rows + force @ contacts.normal
        load = load + (sign * friction.coefficient * force) @ contacts.tangent
        pulled = (contacts.normal.T * slope + contacts.tangent.T * (coupling * slope)) @ contacts.normal
        held, more = resting(small, state)
        return stiffness @ state + held - load, stiffness + more + pulled, force, slope


@dataclass(frozen=True)
class GivenSliding:
    """Contacts without a normal law: each keeps preload and stiffness of the model."""

    family: Family
    residual: float = 0.0

    def compact(self, family):
        """The same of a Family that lacks the whole model."""
        return replace(self, family=family)

    def slide(self, factors, speed):
        """Contact of a draw at ``speed`` rad/s."""
        model = self.family.model.at_speed(speed)
        contacts, friction = model.contacts, _friction(self.family, factors, model, model.contacts.preload)
        drawn = model.direction() * friction.coefficient * contacts.preload
        return Contact(contacts.preload, factors.contact_stiffness * contacts.stiffness, friction, None,
                       slopes_of_elements(model, np.zeros(model.size), contacts.preload, drawn))


def sliding_basis(family, speeds, training=(NOMINAL,)):
    """SlidingBasis of a Family that serves the ``speeds`` (v,) rad/s and the Factors ``training``; GivenSliding without
    a normal law.

    Raises ConvergenceError where a draw has no sliding state, or where the basis does not come to serve the training.
    """
    if not family.has_law:
        return GivenSliding(family)
    model, contacts = family.model, family.model.contacts
    springs, (factor, first) = model.frictionless(centrifugal=False)[2], _first(family)
    rows = [model.input_rows, model.joints.rows, *(e.row[None] for e in model.elements)]
    answers = scipy.linalg.cho_solve(factor, np.vstack(rows).T)
    basis = _extended(family, springs, np.empty((model.size, 0)), np.column_stack((first, answers)), first)
    states, middle = [(factors, speed) for speed in speeds for factors in training], float(np.mean(speeds))
    for _ in range(_ROUNDS):
        basis = replace(basis, start=basis.solve(NOMINAL, middle))
        contact, residuals = basis.slide(NOMINAL, middle), np.array([basis.residual_of(*state) for state in states]).T
        answers = scipy.linalg.lu_solve(scipy.linalg.lu_factor(_tangent(family, contact, middle)), residuals)
        change = contact.stiffness[:, None] * abs(contacts.normal @ answers) / max(contact.force.max(), _TINY)
        change = change.max(axis=0, initial=0.0)
        if change.max() <= _SERVED:
            return replace(basis, residual=float(change.max()))
        basis = _extended(family, springs, basis.shape, answers[:, change > _SERVED], basis.shape @ basis.start)
    raise ConvergenceError("steady sliding of draws", f"changes of contact forces below {_SERVED:g} of the largest",
                           f"{change.max():.2g} after {_ROUNDS} rounds", "narrow the scatter in probability.sources")


def whole_sliding(family):
    """SlidingBasis of a Family in its whole model, for a draw or two; GivenSliding without a normal law."""
    if not family.has_law:
        return GivenSliding(family)
    model = family.model
    _, first = _first(family)
    return SlidingBasis(family, np.eye(model.size), model, family.lining, first)


def _first(family):
    """(Cholesky factor of the springs of a Family, its motion (n,) m with contact springs in place of their law)."""
    model, contacts = family.model, family.model.contacts
    factor = scipy.linalg.cho_factor(model.frictionless(centrifugal=False)[2])
    pressed = contacts.stiffness * (_closure(family, contacts) + contacts.gap)
    load = family.input_force @ model.input_rows
    return factor, scipy.linalg.cho_solve(factor, load + (contacts.preload - pressed) @ contacts.normal)


def _closure(family, contacts):
    """(c,) m to begin with: closures of Contacts under their preload, by the table, or by their stiffness."""
    if len(family.law_closure):
        return np.interp(contacts.pressure, family.law_pressure, family.law_closure)
    return np.divide(contacts.preload, contacts.stiffness, out=np.zeros(len(contacts.area)),
                     where=contacts.stiffness > 0)


def _tangent(family, contact, speed):
    """(n, n) N/m: stiffness of the nominal model about its sliding state, with friction."""
    model = with_slopes(model_about(family.model.at_speed(speed), contact), contact.slopes)
    return model.frictionless(centrifugal=family.centrifugal)[2] + model.friction_matrices(contact.friction, False)[1]


def _extended(family, springs, shape, answers, start):
    """SlidingBasis on ``shape`` (n, s) and ``answers`` (n, a), orthonormal in the energy of ``springs`` (n, n) N/m."""
    for _ in range(2):
        answers = answers - shape @ (shape.T @ (springs @ answers))
        size = np.sqrt(np.einsum("na,na->a", answers, springs @ answers))
        answers = answers[:, size > 0] / size[size > 0]
    square, direction = scipy.linalg.eigh(answers.T @ springs @ answers)
    kept = square > _DEPENDENT * square[-1]
    shape = np.hstack((shape, answers @ (direction[:, kept] / np.sqrt(square[kept]))))
    lining = None if family.lining is None else shape.T @ family.lining @ shape
    return SlidingBasis(family, shape, family.model.projected(shape), lining, shape.T @ (springs @ start))


def _joint_force(joints, factors, motion):
    """Force of the joints of a draw on the coordinates, (n,) or (n, m), that ``motion`` of the same shape makes."""
    weight = np.broadcast_to(factors.joint_stiffness, len(joints.name)) * joints.stiffness
    return (joints.rows.T * weight) @ (joints.rows @ motion)


def _friction(family, factors, model, force):
    """FrictionState (c,) of a draw under the contact ``force`` (c,) N."""
    return changed_friction(family.friction, family.pivot, factors, force / model.contacts.area,
                            abs(model.sliding_speed))
