"""The linear system of one draw of a Family about its sliding state: terms of steady sliding, with what scatters."""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.physics.sliding.equilibrium import model_about
from pipeline.physics.sliding.model import FrictionState
from pipeline.physics.stability.linearisation import beside_motion, element_rows, present
from pipeline.physics.system.forms import Array, Block, ByBody, Form, Rows
from pipeline.physics.system.system import System
from pipeline.physics.system.terms import Kind, Owner, Term, What


@dataclass(frozen=True)
class BodyLosses:
    """Imaginary stiffness N/m of the bodies by their loss factors, and stiffness N/m of the linings, of a Family: as
    whole matrices (n, n) with the ``body`` (n,) of each coordinate, or ``loss_of`` and ``lining_of`` (b, m, m) each
    body's on a basis. ``lining`` is None without linings."""

    loss: Array
    lining: Array | None
    body: Array | None = None
    loss_of: Array | None = None
    lining_of: Array | None = None

    @classmethod
    def whole(cls, family):
        """Of the whole model."""
        return cls(family.loss, family.lining, family.model.coordinate_body)

    @classmethod
    def on(cls, family, basis):
        """On a ``basis`` (n, m)."""
        loss, lining = (None if matrix is None else by_body(family.model, matrix, basis)
                        for matrix in (family.loss, family.lining))
        return cls(loss.sum(axis=0), None if lining is None else lining.sum(axis=0), None, loss, lining)

    def terms(self, factors, lining_loss_factor) -> tuple[Term, ...]:
        """Those of a draw with its Factors."""
        found = [self._loss(self.loss, self.loss_of, factors.body_loss)]
        if self.lining is not None:
            more, lossier = factors.lining - 1, lining_loss_factor * np.asarray(factors.body_loss)
            found += [Term.sliding(What.STRUCTURAL_STIFFNESS, Kind.STIFFNESS, Block(self.lining, more), Owner.BODY),
                      self._loss(self.lining, self.lining_of, more * lossier)]
        return tuple(found)

    def _loss(self, matrix, parts, weight) -> Term:
        form: Form = ByBody(parts, matrix, weight) if parts is not None else Block(
            matrix, weight if np.ndim(weight) == 0 else weight[self.body])
        return Term.sliding(What.HYSTERETIC_LOSS, Kind.LOSS, form, Owner.BODY)


def draw_system(family, model, factors, contact, losses: BodyLosses) -> System:
    """System of a draw of filled Factors in its sliding state, a Contact.

    ``model``: the SlidingModel of the Family at the speed of the draw, whole or on a basis, and ``losses`` in the same
    coordinates.
    """
    joints, rows = model.joints, element_rows(model)
    stiffness, damping = factors.joint_stiffness * joints.stiffness, factors.joint_stiffness * factors.joint_loss
    varied = replace(model, joints=replace(joints, stiffness=stiffness, damping=damping * joints.damping))
    model, friction, beside = about(family, varied, factors, contact)
    lossy = Rows(joints.rows, stiffness * factors.joint_loss * family.joint_loss_factor, joints.rows)
    terms = [Term.sliding(What.HYSTERETIC_LOSS, Kind.LOSS, lossy, Owner.JOINT),
             *losses.terms(factors, family.lining_loss_factor)]
    for slope, what, kind in zip(contact.slopes, (What.STRUCTURAL_STIFFNESS, What.STRUCTURAL_DAMPING),
                                 (Kind.STIFFNESS, Kind.DAMPING), strict=True):
        terms.append(Term.sliding(what, kind, Rows(rows, slope, rows), Owner.EFFECT))
    whole = model.system(friction, family.friction_damping, family.gyroscopic, family.centrifugal)
    return replace(whole.and_(terms), beside=beside)


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


def by_body(model, matrix, basis):
    """(b, m, m): the block of each body of a ``matrix`` (n, n) that couples none, on the ``basis`` (n, m)."""
    blocks = [np.flatnonzero(model.coordinate_body == b) for b in range(len(model.body_name))]
    return np.array([basis[b].T @ matrix[np.ix_(b, b)] @ basis[b] for b in blocks])
