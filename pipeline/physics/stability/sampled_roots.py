"""Unstable roots of many draws of a Family, on bases that serve all of them.

Real modes of the nominal brake below a limit, with corrections for everything that a draw changes (``friction_basis``),
are one basis V (n, m) for all draws of one load. On it a draw at an operating point is its sliding state
(``sampled_sliding``), and the roots about it that grow, or nearly do (``growing_roots``).

For some draws of the same scatter, the training, what V leaves out of the growing modes is computed from their residual
in the whole model, and joins V.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError
from pipeline.physics.modal.growing_roots import growing_roots
from pipeline.physics.modal.natural_modes import all_modes
from pipeline.physics.sliding.equilibrium import model_about
from pipeline.physics.sliding.model import FrictionState, SlidingModel, spread
from pipeline.physics.stability.friction_basis import friction_basis
from pipeline.physics.stability.sampled_sliding import GivenSliding, SlidingBasis, sliding_basis
from pipeline.physics.stability.scatter import NOMINAL

#: what joins the basis for the training: amplitudes above this share of the mode
_JOINING = 1e-4


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
        return self.modes(factors, speed)[0]

    def modes(self, factors, speed):
        """(``roots``, their shapes (m, r) on the basis)."""
        return growing_roots(*self._matrices(factors, speed, self.sliding.slide(factors, speed)),
                             2 * np.pi * self.below)

    def _matrices(self, factors, speed, contact):
        """(C, K without friction and losses, what these add to it) of a draw, each (m, m), the last complex."""
        body, imaginary = self._bodies(factors, speed)
        normal = self.small.contacts.normal
        drawn, damping = self._friction(factors, speed, contact)
        joints = self.small.joints
        damping = damping + self.small.damping
        if joints.damping.any():
            viscous = joints.damping * factors.joint_stiffness * factors.joint_loss
            damping = damping + spread(joints.rows, viscous, joints.rows)
        if self.family.gyroscopic:
            damping = damping + speed * self.small.gyroscopic
        return damping, body + spread(normal, contact.stiffness, normal), drawn + 1j * imaginary

    def _bodies(self, factors, speed):
        """(real, imaginary) stiffness (m, m) N/m of bodies and joints of a draw."""
        joints, family = self.small.joints, self.family
        weight = np.broadcast_to(factors.joint_stiffness, len(joints.name)) * joints.stiffness
        lossy = weight * factors.joint_loss * family.joint_loss_factor
        lost = np.broadcast_to(factors.body_loss, len(self.loss))
        stiffness = self.small.stiffness + spread(joints.rows, weight, joints.rows)
        imaginary = np.tensordot(lost, self.loss, 1) + spread(joints.rows, lossy, joints.rows)
        if family.centrifugal:
            stiffness = stiffness + speed**2 * self.small.centrifugal
        if self.lining is not None:
            more = factors.lining - 1
            stiffness = stiffness + more * self.lining.sum(axis=0)
            imaginary = imaginary + np.tensordot(more * family.lining_loss_factor * lost, self.lining, 1)
        return stiffness, imaginary

    def _friction(self, factors, speed, contact):
        """(K_f, C_f) (m, m) of friction and contact damping of a draw, as of ``SlidingModel.linearised``."""
        model, state = _about(self.family, self.small.at_speed(speed), factors, contact)
        contacts, coupling = model.contacts, model.coupling(state)
        drag = (contacts.normal.T + contacts.tangent.T * coupling) * contacts.damping @ contacts.normal
        if np.any(state.speed_slope):
            drag += spread(contacts.tangent, contacts.preload * state.speed_slope, contacts.tangent)
        if self.family.friction_damping:
            drag += spread(contacts.lateral, model.turning_drag(state.coefficient), contacts.lateral)
        return spread(contacts.tangent, coupling * contacts.stiffness, contacts.normal), drag


def sampled(family, speeds, below, training=(NOMINAL,), smallest=1e-2):
    """Sampled of a Family at the ``speeds`` (v,) rad/s, for roots ``below`` a frequency in Hz.

    ``training``: Factors that its bases are made to serve; corrections up to ``smallest`` per unit of modal amplitude
    are left out. Raises ConfigError for a speed of 0 with friction that turns with the slip.
    """
    middle = float(np.mean(speeds))
    if family.friction_damping and not np.all(speeds):
        raise ConfigError("probability: speeds", "speeds other than 0, with friction damping", "0 rad/s",
                          "leave it out, or set friction_damping to false")
    sliding = sliding_basis(family, speeds, training)
    about, _ = _about(family, family.model.at_speed(middle), NOMINAL, sliding.slide(NOMINAL, middle))
    basis = friction_basis(about, below, family.friction_damping, smallest, about.contacts.stiffness,
                           family.centrifugal, _scattered(family)).shape
    first = _on(sliding, basis, below)
    return _on(sliding, _joined(family.model.mass, basis, _missing(first, about, training, middle)), below)


def _on(sliding, basis, below):
    """Sampled on a basis."""
    family = sliding.family
    lining = None if family.lining is None else _by_body(family, family.lining, basis)
    return Sampled(sliding, basis, family.model.projected(basis), _by_body(family, family.loss, basis), lining, below)


def _about(family, model, factors, contact):
    """(SlidingModel about a sliding state, FrictionState of its linearisation) of a draw."""
    friction = contact.friction if family.friction_slopes else FrictionState(contact.friction.coefficient)
    return model_about(model, contact, factors.damping_speed * family.damping_speed), friction


def _scattered(family):
    """(k, n, n) N/m: what else a draw changes: losses, linings, joints by the first part of their name."""
    joints = family.model.joints
    others = [family.imaginary_stiffness()] + ([] if family.lining is None else [family.lining])
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
        roots, shapes = first.modes(factors, speed)
        contact = first.sliding.slide(factors, speed)
        for root, shape in zip(roots, (first.basis @ shapes).T, strict=True):
            force = modes[:, high].T @ _residual(family, factors, speed, contact, root, shape)
            answer = modes[:, high] @ (force / (square[high] - abs(root) ** 2)) / np.linalg.norm(shape @ mass)
            answers.append(np.column_stack((answer.real, answer.imag)))
    return np.hstack(answers)


def _residual(family, factors, speed, contact, root, shape):
    """(n,) T(s) x in the whole model of a draw, for a root s and a shape x (n,)."""
    model, state = _about(family, family.model.at_speed(speed), factors, contact)
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
