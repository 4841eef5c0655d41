"""Terms of a linear system about a state of motion: what each is, how it stands with s and with speed, whose it is.

    T(s) x = sum_j f_j(s) A_j x,    f = s^2 of a mass, s of a damping, 1 of a stiffness, i of a loss
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import Self

from pipeline.physics.system.forms import Array, Block, Form


class Kind(StrEnum):
    """How a term stands with s."""

    MASS = "mass"
    DAMPING = "damping"
    STIFFNESS = "stiffness"
    LOSS = "loss"

    @property
    def order(self) -> int:
        """Power of s."""
        return {Kind.MASS: 2, Kind.DAMPING: 1}.get(self, 0)

    def factor(self, s: complex) -> complex:
        """f(s)."""
        return 1j if self is Kind.LOSS else s**self.order


class What(StrEnum):
    """What a term of steady sliding stands for."""

    MASS = "mass"
    STRUCTURAL_DAMPING = "structural_damping"
    CONTACT_DAMPING = "contact_damping"
    GYROSCOPIC = "gyroscopic"
    FRICTION_DAMPING = "friction_damping"
    FRICTION_OVER_SLIP = "friction_over_slip"
    FRICTION_TURNING = "friction_turning"
    STRUCTURAL_STIFFNESS = "structural_stiffness"
    CONTACT_STIFFNESS = "contact_stiffness"
    CENTRIFUGAL = "centrifugal"
    CIRCULATORY = "circulatory"
    HYSTERETIC_LOSS = "hysteretic_loss"


class Owner(StrEnum):
    """What the shares of a term belong to, one by one: coordinates of bodies, joints, contacts, elements of effects."""

    BODY = "body"
    JOINT = "joint"
    CONTACT = "contact"
    EFFECT = "effect"


#: what changes with the speed of the drive and with friction -> how, contacts and their forces being the same
TIMES = {What.GYROSCOPIC: "speed", What.CENTRIFUGAL: "speed^2", What.CIRCULATORY: "friction",
         What.FRICTION_DAMPING: "friction", What.FRICTION_OVER_SLIP: "friction",
         What.FRICTION_TURNING: "friction/speed"}


@dataclass(frozen=True)
class Term:
    """A ``form`` (n, n) of a Kind; ``name``: a What, or that of a system that was read; ``times``: what it is
    multiplied by as speed and friction change, in words of ``case_models.matrices.dependence``."""

    name: str
    kind: Kind
    form: Form
    owner: Owner | None = None
    times: str = "1"

    @classmethod
    def sliding(cls, what: What, kind: Kind, form: Form, owner: Owner) -> Self:
        """Of steady sliding, which says how it changes."""
        return cls(what, kind, form, owner, TIMES.get(what, "1"))

    @classmethod
    def whole(cls, name: str, kind: str, matrix: Array, times: str = "1") -> Self:
        """Of a matrix (n, n), dense or sparse."""
        return cls(name, Kind(kind), Block(matrix), None, times)

    @property
    def matrix(self):
        """A (n, n), dense or sparse."""
        return self.form.matrix()
