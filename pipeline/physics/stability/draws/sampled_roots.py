"""Unstable roots of many draws of a Family, on bases that serve all of them.

Real modes of the nominal brake below a limit, with corrections for everything that a draw changes (``friction_basis``),
are one basis V (n, m) for all draws of one load. On it a draw at an operating point is its sliding state
(``sampled_sliding``), and the roots about it that grow, or nearly do (``growing_roots``).

For some draws of the same scatter, the training, what V leaves out of the growing modes is computed from their residual
in the whole model, and joins V.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.modal.growing_roots import growing_roots, spectrum_roots
from pipeline.physics.modal.natural_modes import all_modes
from pipeline.physics.sliding.equilibrium import model_about
from pipeline.physics.sliding.model import FrictionState, SlidingModel, spread
from pipeline.physics.stability.draws.sampled_sliding import GivenSliding, SlidingBasis, sliding_basis
from pipeline.physics.stability.draws.scatter import NOMINAL
from pipeline.physics.stability.friction_basis import friction_basis
from pipeline.physics.stability.linearisation import beside_motion, element_rows, maxwell_branches, present, with_slopes

#: what joins the basis for the training: amplitudes above this share of the mode
_JOINING = 1e-4
#: growth rate in 1/s from which on roots are compared, and the share of them within which they are the same
_GROWS, _SAME = 1e-2, 1e-6


@dataclass(frozen=True)
class Sampled:
    """A Family on its bases: what the roots of a draw need.

    ``sliding``: basis of its sliding states; ``basis`` (n, m) mass-orthonormal and ``small``, the SlidingModel on it;
    ``loss`` and ``lining`` (b, m, m) N/m of each body, the latter None without linings; ``below`` Hz limits the modes.
    """

    sliding: SlidingBasis | GivenSliding
    basis: np.ndarray
    small: SlidingModel
    loss: np.ndarray
    lining: np.ndarray | None
    below: float

    @property
    def family(self):
        """The Family."""
        return self.sliding.family

    def compact(self):
        """The same without what only the whole model needs: for tasks in other processes."""
        family = replace(self.family, model=self.small, loss=self.small.mass[:0], lining=None)
        sliding = self.sliding.compact(family)
        return replace(self, sliding=sliding, basis=self.basis[:0])

    def roots(self, factors, speed):
        """Roots (r,) 1/s of a draw at ``speed`` rad/s by falling growth rate: all that grow, and the least stable one.

        Only those below the frequency limit. Raises ConvergenceError where a draw has no sliding state.
        """
        return self.modes(factors, speed).value

    def modes(self, factors, speed):
        """Growing: ``roots``, their shapes (m, r) on the basis and their residuals."""
        matrices, beside = self.system(factors, speed)
        return growing_roots(*matrices, 2 * np.pi * self.below, beside)

    def spectrum(self, factors, speed):
        """Growing of a draw as of ``modes``, from all its roots on the basis."""
        matrices, beside = self.system(factors, speed)
        return spectrum_roots(*matrices, 2 * np.pi * self.below, beside)

    def missed(self, factors, speed):
        """Number of growing roots of a draw that only one of ``modes`` and ``spectrum`` has."""
        some, every = (each.value[each.value.real > _GROWS]
                       for each in (self.modes(factors, speed), self.spectrum(factors, speed)))
        same = abs(some[:, None] - every) <= _SAME * abs(every)
        return int(np.sum(~same.any(axis=0)) + np.sum(~same.any(axis=1)))

    def system(self, factors, speed):
        """((C, K without friction and losses, what these add to it) of a draw about its sliding state, each (m, m), the
        last complex, what settles beside it or None)."""
        factors = self.family.filled(factors)
        contact = self.sliding.slide(factors, speed)
        stiffness, imaginary = self._bodies(factors, speed)
        (pressed, drawn, drag), beside = self._contacts(factors, speed, contact)
        if contact.slopes.size:
            rows = element_rows(self.small)
            pressed = pressed + spread(rows, contact.slopes[0], rows)
            drag = drag + spread(rows, contact.slopes[1], rows)
        joints = self.small.joints
        damping = drag + self.small.damping
        if joints.damping.any():
            viscous = joints.damping * factors.joint_stiffness * factors.joint_loss
            damping = damping + spread(joints.rows, viscous, joints.rows)
        if self.family.gyroscopic:
            damping = damping + speed * self.small.gyroscopic
        return (damping, stiffness + pressed, drawn + 1j * imaginary), beside

    def _bodies(self, factors, speed):
        """(real, imaginary) stiffness (m, m) N/m of bodies and joints of a draw."""
        joints, family = self.small.joints, self.family
        weight = np.broadcast_to(factors.joint_stiffness, len(joints.name)) * joints.stiffness
        lossy = weight * factors.joint_loss * family.joint_loss_factor
        lost = np.broadcast_to(factors.body_loss, len(self.loss))
        stiffness = self.small.stiffness + spread(joints.rows, weight, joints.rows)
        imaginary = _weighted(lost, self.loss, self._all_loss) + spread(joints.rows, lossy, joints.rows)
        if family.centrifugal:
            stiffness = stiffness + speed**2 * self.small.centrifugal
        if self.lining is not None:
            more = factors.lining - 1
            stiffness = stiffness + more * self._all_lining
            imaginary = imaginary + more * family.lining_loss_factor * _weighted(lost, self.lining, self._all_lining)
        return stiffness, imaginary

    @cached_property
    def _all_loss(self):
        return self.loss.sum(axis=0)

    @cached_property
    def _all_lining(self):
        return self.lining.sum(axis=0)

    def _contacts(self, factors, speed, contact):
        """((K without friction, K_f, C) (m, m) of the contacts of a draw, as of ``SlidingModel.linearised``, what
        settles beside them or None)."""
        model, state, beside = about(self.family, self.small.at_speed(speed), factors, contact)
        contacts, coupling = model.contacts, model.coupling(state)
        along = (coupling * contacts.damping)[:, None] * contacts.normal
        if np.any(state.speed_slope):
            along += (contacts.preload * state.speed_slope)[:, None] * contacts.tangent
        drag = _squared(contacts.normal, contacts.damping) + contacts.tangent.T @ along
        if self.family.friction_damping:
            drag += _squared(contacts.lateral, model.turning_drag(state.coefficient))
        return (_squared(contacts.normal, contact.stiffness),
                spread(contacts.tangent, coupling * contact.stiffness, contacts.normal), drag), beside


def sampled(family, speeds, below, training=(NOMINAL,), smallest=1e-2):
    """Sampled of a Family at the ``speeds`` (v,) rad/s, for roots ``below`` a frequency in Hz.

    ``training``: Factors that its bases are made to serve; corrections up to ``smallest`` per unit of modal amplitude
    are left out. Raises ConfigError for a speed of 0 with friction that turns with the slip.
    """
    middle = float(np.mean(speeds))
    if family.friction_damping and not np.all(speeds):
        raise ConfigError("probability: speeds", "speeds other than 0, with friction damping", "0 rad/s",
                          "leave it out, or set friction_damping to false")
    training = [family.filled(factors) for factors in training]
    sliding = sliding_basis(family, speeds, training)
    contact = sliding.slide(NOMINAL, middle)
    model = with_slopes(about(family, family.model.at_speed(middle), NOMINAL, contact)[0], contact.slopes)
    basis = friction_basis(model, below, family.friction_damping, smallest, model.contacts.stiffness,
                           family.centrifugal, _scattered(family)).shape
    first = _on(sliding, basis, below)
    return _on(sliding, _joined(family.model.mass, basis, _missing(first, model, training, middle)), below)


def _on(sliding, basis, below):
    """Sampled on a basis."""
    family = sliding.family
    lining = None if family.lining is None else _by_body(family, family.lining, basis)
    return Sampled(sliding, basis, family.model.projected(basis), _by_body(family, family.loss, basis), lining, below)


def _weighted(weight, parts, whole):
    """Sum (m, m) of the ``parts`` (b, m, m), which make the ``whole``, each with its ``weight`` (b,)."""
    return weight[0] * whole if len(weight) and (weight == weight[0]).all() else np.tensordot(weight, parts, 1)


def _squared(rows, weight):
    """``spread`` of ``rows`` (c, m) with themselves, half the work where no ``weight`` (c,) is negative."""
    if np.any(weight < 0):
        return spread(rows, weight, rows)
    half = np.sqrt(weight)[:, None] * rows
    return half.T @ half


def about(family, model, factors, contact):
    """(SlidingModel about a sliding state, elements apart, FrictionState that acts at once, what settles beside it or
    None) of a draw."""
    friction = contact.friction if family.friction_slopes else FrictionState(contact.friction.coefficient)
    model = model_about(model, contact, factors.damping_speed * family.damping_speed)
    if family.added is None:
        return model, friction, None
    if contact.damping is not None:
        model = replace(model, contacts=replace(model.contacts, damping=contact.damping))
    states = family.added.states(model, contact.force)
    return model, present(friction, states), beside_motion(model, friction, states)


def _scattered(family):
    """(k, n, n) N/m: what else a draw changes: losses, linings, joints by the first part of their name."""
    joints = family.model.joints
    others = [family.imaginary_stiffness()] + ([] if family.lining is None else [family.lining])
    branches, springs, _ = maxwell_branches(family.model)
    others += [spread(branches, springs, branches)] * (len(springs) > 0)
    groups = np.array([name.split("_")[0] for name in joints.name])
    for group in dict.fromkeys(groups):
        rows = joints.rows[groups == group]
        others.append(spread(rows, joints.stiffness[groups == group], rows))
    return np.array(others)


def _missing(first, about, training, speed):
    """(n, 2 g): what the basis of ``first`` leaves out of the growing modes of the ``training``, real and imaginary.

    Answers of the modes of the nominal brake ``about`` to the residuals, at the frequency of each root.
    """
    family = first.family
    mass, _, stiffness = about.frictionless(gyroscopic=False, centrifugal=family.centrifugal)
    square, modes = all_modes(stiffness, mass)
    high = square > (2 * np.pi * first.below) ** 2
    answers = [np.empty((family.model.size, 0))]
    for factors in training:
        growing, contact = first.modes(factors, speed), first.sliding.slide(factors, speed)
        for root, shape in zip(growing.value, (first.basis @ growing.shape).T, strict=True):
            force = modes[:, high].T @ _residual(family, factors, speed, contact, root, shape)
            answer = modes[:, high] @ (force / (square[high] - abs(root) ** 2)) / np.linalg.norm(shape @ mass)
            answers.append(np.column_stack((answer.real, answer.imag)))
    return np.hstack(answers)


def _residual(family, factors, speed, contact, root, shape):
    """(n,) T(s) x in the whole model of a draw, for a root s and a shape x (n,)."""
    model, state, beside = about(family, family.model.at_speed(speed), factors, contact)
    contacts, joints = model.contacts, model.joints
    normal, tangent, lateral = (rows @ shape for rows in (contacts.normal, contacts.tangent, contacts.lateral))
    pressed = (contacts.stiffness + root * contacts.damping) * normal
    along = model.coupling(state) * pressed + root * contacts.preload * state.speed_slope * tangent
    force = pressed @ contacts.normal + along @ contacts.tangent
    if family.friction_damping:
        force += (root * model.turning_drag(state.coefficient) * lateral) @ contacts.lateral
    elastic = factors.joint_stiffness * joints.stiffness * (1 + 1j * factors.joint_loss * family.joint_loss_factor)
    viscous = factors.joint_stiffness * factors.joint_loss * joints.damping
    force += ((elastic + root * viscous) * (joints.rows @ shape)) @ joints.rows
    lost = np.broadcast_to(factors.body_loss, len(model.body_name))[model.coordinate_body]
    force += root**2 * (model.mass @ shape) + root * (model.damping @ shape) + model.stiffness @ shape
    force += 1j * lost * (family.loss @ shape)
    if family.gyroscopic:
        force += root * speed * (model.gyroscopic @ shape)
    if family.centrifugal:
        force += speed**2 * (model.centrifugal @ shape)
    if family.lining is not None:
        force += (factors.lining - 1) * (1 + 1j * lost * family.lining_loss_factor) * (family.lining @ shape)
    if contact.slopes.size:
        rows = element_rows(model)
        force += ((contact.slopes[0] + root * contact.slopes[1]) * (rows @ shape)) @ rows
    if beside is not None:
        force -= beside.answers(root, shape)[0]
    return force


def _joined(mass, basis, more):
    """(n, m + k) mass-orthonormal: the basis, and what ``more`` (n, g) adds to it."""
    for _ in range(2):
        more = more - basis @ (basis.T @ (mass @ more))
    square, direction = scipy.linalg.eigh(more.T @ mass @ more)
    kept = square > _JOINING**2
    return np.hstack((basis, more @ (direction[:, kept] / np.sqrt(square[kept]))))


def _by_body(family, matrix, basis):
    """(b, m, m): the block of each body of a ``matrix`` (n, n) that couples none, on the basis."""
    body = family.model.coordinate_body
    blocks = [np.flatnonzero(body == b) for b in range(len(family.model.body_name))]
    return np.array([basis[b].T @ matrix[np.ix_(b, b)] @ basis[b] for b in blocks])
