"""What makes a mode grow: its growth rate as a sum over friction, contacts, bodies and joints; the bodies that move.

A root s = sigma + i w of M x'' + (C + W G) x' + K x = 0 and its vector x obey x^H (s^2 M + s (C + W G) + K) x = 0. With
x^H G x = i g of the gyroscopic matrix, which does no work, the growth rate is a sum over the parts C_j, K_j:

    sigma = - sum_j Im(s x^H C_j x + x^H K_j x) / (2 w x^H M x + W g).                                             (1)

Symmetric stiffnesses contribute nothing, dampers and imaginary stiffnesses (loss factors) what they dissipate, friction
what it feeds in.
"""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.physics.sliding.model import FrictionState
from pipeline.physics.sliding.sliding_terms import friction_terms, pressing_terms
from pipeline.physics.sliding.structural_damping import equivalent_motion
from pipeline.physics.system.forms import Block, Rows, spread
from pipeline.physics.system.terms import Kind, Owner, Term, What

#: terms beside those of the friction at the contacts of each body, in order
CONTACT, TURNING, SLIP = "contact damping", "friction turning with the slip", "friction over slip speed"
LOCAL = {What.CONTACT_DAMPING: CONTACT, What.FRICTION_TURNING: TURNING, What.FRICTION_OVER_SLIP: SLIP}
#: how the terms of the friction at a body, of what a body and of what a group of joints dissipates begin
FRICTION, BODY, JOINTS = "friction at ", "damping of ", "damping at "
#: names of a remainder: friction at contacts that do not yield, or the effects of a case
HARD, EFFECTS = "friction at hard contacts", "effects of the case"
#: words in the name of a joint from which on it says where, not what
_WHERE = {"leading", "trailing", "inner", "outer", "front", "rear", "left", "right", "upper", "lower", "normal",
          "tangential", "radial", "axial", "along", "across", "tilt"}


def joint_group(name):
    """What a joint is, without where: 'guide_pin' of 'guide_pin_leading_axial_front'."""
    first, *others = str(name).split("_")
    for count, word in enumerate(others):
        if word in _WHERE or word.isdigit():
            return "_".join([first, *others[:count]])
    return str(name)


@dataclass(frozen=True)
class Losses:
    """What bodies and joints dissipate, and the body of each contact (c,).

    ``damping`` N s/m and ``loss`` N/m (n, n) of the bodies, the latter the imaginary part of their stiffness; ``group``
    (j,) of the joints with ``rows`` (j, n), ``joint_damping`` (j,) N s/m and ``joint_loss`` (j,) N/m. Matrices and rows
    may be sparse, for ``parts`` alone.
    """

    contact_body: np.ndarray
    damping: np.ndarray
    loss: np.ndarray
    group: tuple
    rows: np.ndarray
    joint_damping: np.ndarray
    joint_loss: np.ndarray

    @classmethod
    def of(cls, reduced):
        """Of a product ReducedModel, or any object with its fields."""
        return cls(reduced.contact_body, reduced.damping, reduced.loss,
                   tuple(map(joint_group, reduced.joint_name)), reduced.joint_rows, reduced.joint_damping,
                   reduced.joint_loss_factor * reduced.joint_stiffness)

    @classmethod
    def within(cls, model, contact_body):
        """Of a SlidingModel, dense or sparse, whose loss factors are the imaginary parts of its stiffnesses."""
        return cls(contact_body, model.damping, model.stiffness.imag, tuple(map(joint_group, model.joints.name)),
                   model.joints.rows, model.joints.damping, np.imag(model.joints.stiffness))

    @property
    def total(self):
        """(n, n) N/m imaginary part of the stiffness of bodies and joints."""
        return self.loss + spread(self.rows, self.joint_loss, self.rows)

    def enlarged(self, size):
        """The same with further coordinates, such as effects add, behind those of the product: ``size`` in all."""
        more = size - len(self.damping)
        square, rows = ((0, more), (0, more)), ((0, 0), (0, more))
        return replace(self, damping=np.pad(self.damping, square), loss=np.pad(self.loss, square),
                       rows=np.pad(self.rows, rows))

    def change(self, model):
        """(damping, stiffness) that make loss factors hysteretic in a SlidingModel with their viscous equivalent, of
        the product alone; None without loss factors."""
        total = self.total
        if not total.any():
            return None
        damping, known = self.damping.copy(), slice(0, model.size)
        damping[known, known] -= model.damping
        return damping, 1j * total

    def viscous_motion(self, model, shape):
        """The motion whose loss in the imaginary stiffness is, times the angular frequency, that of ``shape`` (n,) in
        the equivalent damping of a SlidingModel, of the product alone."""
        if not self.total.any():
            return shape
        mass, _, stiffness = model.frictionless(gyroscopic=False, centrifugal=False)
        moved = np.zeros_like(shape)
        moved[:model.size] = equivalent_motion(shape[:model.size], stiffness, mass)
        return moved

    def parts(self, model, root, shape, viscous=None):
        """{term: Im(s x^H C x + x^H K x)} of each body and group of joints that dissipates.

        ``viscous``: motion as of ``viscous_motion`` where loss factors act by their viscous equivalent, else None.
        """
        moved, rate = (shape, 1.0) if viscous is None else (viscous, root.imag)
        bodies, joints = np.zeros(len(model.body_name)), np.zeros(len(self.group))
        for term in self.terms():
            motion, weight = (shape, root.imag) if term.kind is Kind.DAMPING else (moved, rate)
            lost = weight * term.form.shares(motion, motion).real
            if term.owner is Owner.BODY:
                bodies += np.bincount(model.coordinate_body, lost, len(bodies))
            else:
                joints += lost
        acts = np.bincount(model.coordinate_body, sum(np.ravel(abs(part).sum(axis=1)) for part in
                                                      (self.damping, self.loss)), len(model.body_name)) > 0
        terms = {f"{BODY}{name}": bodies[b] for b, name in enumerate(model.body_name) if acts[b]}
        for name in dict.fromkeys(self.group):
            members = np.array([group == name for group in self.group])
            if (self.joint_damping[members] + self.joint_loss[members]).any():
                terms[f"{JOINTS}{name}"] = joints[members].sum()
        return terms

    def terms(self):
        """Terms of a System: damping and loss of bodies and joints."""
        rows = self.rows
        return (Term.sliding(What.STRUCTURAL_DAMPING, Kind.DAMPING, Block(self.damping), Owner.BODY),
                Term.sliding(What.STRUCTURAL_DAMPING, Kind.DAMPING, Rows(rows, self.joint_damping, rows), Owner.JOINT),
                Term.sliding(What.HYSTERETIC_LOSS, Kind.LOSS, Block(self.loss), Owner.BODY),
                Term.sliding(What.HYSTERETIC_LOSS, Kind.LOSS, Rows(rows, self.joint_loss, rows), Owner.JOINT))


def growth_terms(model, friction, root, shape, losses, friction_damping=True, gyroscopic=True, viscous=None,
                 remainder=None):
    """({term: part of the growth rate in 1/s}, parts (c,) of the contacts) of a root of a SlidingModel.

    ``friction``: FrictionState or coefficient of steady sliding, ``shape`` (n,) complex, ``losses``: its Losses.
    ``viscous``: see ``Losses.parts``. The friction of the contacts of each body is a term, 'friction at <body>'; the
    part of a contact is that of its friction of all kinds and of its damping. Terms add up to the growth rate, by what
    is left of it if that has the name ``remainder``. Of a real root, where nothing oscillates, the others are 0.
    """
    state = friction if isinstance(friction, FrictionState) else FrictionState(friction)
    inertia = 2 * root.imag * (shape.conj() @ model.mass @ shape).real
    if gyroscopic:
        inertia += model.speed * (shape.conj() @ model.gyroscopic @ shape).imag
    inertia = inertia or np.inf
    fed = dict.fromkeys((What.CIRCULATORY, What.FRICTION_DAMPING, *LOCAL), 0.0)
    for term in (*pressing_terms(model), *friction_terms(model, state, friction_damping)):
        if term.name in fed:
            fed[term.name] = -(term.kind.factor(root) * term.form.shares(shape, shape)).imag / inertia
    drawn = fed[What.CIRCULATORY] + fed[What.FRICTION_DAMPING]
    terms = {f"{FRICTION}{model.body_name[body]}": drawn[losses.contact_body == body].sum()
             for body in np.unique(losses.contact_body)}
    terms |= {name: np.sum(fed[what]) for what, name in LOCAL.items()}
    terms |= {name: -lost / inertia for name, lost in losses.parts(model, root, shape, viscous).items()}
    if remainder is not None:
        terms[remainder] = root.real - sum(terms.values())
    return {name: float(value) for name, value in terms.items()}, sum(fed.values())


def body_shares(model, shape):
    """(b,) share of the kinetic energy of the motion ``shape`` (n,) in each body of a SlidingModel or ReducedModel."""
    moved = (shape.conj() * (model.mass @ shape)).real
    energy = np.bincount(model.coordinate_body, moved, len(model.body_name))
    return energy / energy.sum()
