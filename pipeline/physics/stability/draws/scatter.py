"""A sliding model whose values scatter: what a draw of them changes.

A draw multiplies stiffnesses, loss factors and the closing speed of the contact damping, and adds to the coefficient of
friction, with pivots p0 and v0,

    mu(p, v) = mu_map(p, v) + a + b ln(p / p0) + c ln(v / v0),    never below 0.

Beyond the range of the map both logarithms stay what they are at its end, as the map does.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from pipeline.physics.contact.closure_law import force_at_rest
from pipeline.physics.sliding.model import FrictionState, SlidingModel
from pipeline.physics.stability.draws.added_physics import AddedPhysics
from pipeline.physics.system.forms import spread


@dataclass(frozen=True)
class Factors:
    """One draw: factors on nominal values, 1 leaving them as they are, and additions to friction, 0 likewise.

    ``joint_stiffness``, ``joint_loss`` (j,) on stiffness and loss factor of each joint, viscous damping following both;
    ``body_loss`` (b,) on the loss factors of each body; ``lining`` on the moduli of the linings; ``contact_stiffness``
    on the slope of the normal law at a given pressure; ``damping_speed``; ``friction``, ``pressure_slope``,
    ``speed_slope`` a, b and c above.
    """

    joint_stiffness: np.ndarray | float = 1.0
    joint_loss: np.ndarray | float = 1.0
    body_loss: np.ndarray | float = 1.0
    lining: float = 1.0
    contact_stiffness: float = 1.0
    damping_speed: float = 1.0
    friction: float = 0.0
    pressure_slope: float = 0.0
    speed_slope: float = 0.0

    def filled(self, joints, bodies):
        """The same for as many ``joints`` and ``bodies``, the first of which are its own; others stay as they are."""
        def longer(values, count):
            return values if np.ndim(values) == 0 or len(values) == count else np.append(
                values, np.ones(count - len(values)))

        return replace(self, joint_stiffness=longer(self.joint_stiffness, joints),
                       joint_loss=longer(self.joint_loss, joints), body_loss=longer(self.body_loss, bodies))


NOMINAL = Factors()


@dataclass(frozen=True)
class Pivot:
    """Where friction is known best: ``pressure`` Pa, ``speed`` m/s; ``pressures`` and ``speeds``: ends of its range."""

    pressure: float = 1.0
    speed: float = 1.0
    pressures: tuple = (0.0, np.inf)
    speeds: tuple = (0.0, np.inf)


@dataclass(frozen=True)
class Family:
    """A SlidingModel under one load, and what scatters in it.

    ``model``: bodies without the viscous equivalent of loss factors; ``loss`` (n, n) N/m imaginary stiffness of the
    bodies, ``joint_loss_factor`` (j,), ``lining`` (n, n) N/m the part of the stiffness that scales with the linings'
    moduli (None: no lining), ``lining_loss_factor`` theirs; ``law_closure`` m and ``law_pressure`` Pa (k,) the normal
    law, none (k = 0) where contacts keep preload and stiffness of the model; ``friction``: function of pressure Pa and
    sliding speed m/s, each (c,), that gives a FrictionState; ``input_force`` (i,) N; ``damping_speed`` m/s. Switches as
    those of ``complex_modes``. ``added``: what effects add beside the matrices, None without any.
    """

    model: SlidingModel
    friction: Callable
    input_force: np.ndarray
    damping_speed: float
    loss: np.ndarray
    joint_loss_factor: np.ndarray
    lining: np.ndarray | None = None
    lining_loss_factor: float = 0.0
    law_closure: np.ndarray = ()
    law_pressure: np.ndarray = ()
    pivot: Pivot = Pivot()
    friction_slopes: bool = True
    friction_damping: bool = True
    gyroscopic: bool = True
    centrifugal: bool = True
    added: AddedPhysics | None = None

    @property
    def has_law(self):
        """Whether contact forces follow from a normal law."""
        return self.law_added or len(self.law_closure) > 0

    @property
    def law_added(self):
        """Whether contacts follow a law of effects."""
        return self.added is not None and self.added.law is not None

    def pressed(self, contacts, factors, closure):
        """(force (c,) N, slope (c,) N/m) of Contacts by their law at ``closure`` (c,) m in a draw."""
        if self.law_added:
            force, slope = self.added.pressed(contacts.area, closure, factors.contact_stiffness)
        else:
            force, slope = force_at_rest(closure, contacts.area, self.law_closure / factors.contact_stiffness,
                                         self.law_pressure)
        return np.where(contacts.fixed, contacts.preload, force), np.where(contacts.fixed, 0.0, slope)

    def filled(self, factors):
        """The Factors of a draw for the joints and bodies of the model, of which effects may add some."""
        return factors.filled(len(self.model.joints.name), len(self.model.body_name))

    def at_speed(self, speed):
        """The same at another speed of the drive, rad/s."""
        return replace(self, model=self.model.at_speed(speed))

    def varied(self, factors):
        """The Family with the Factors of a draw, its friction with what they add: what is sampled, without a basis."""
        joints, body = self.model.joints, self.model.coordinate_body
        stiffer = np.broadcast_to(factors.joint_stiffness, len(joints.name))
        lossier = np.broadcast_to(factors.joint_loss, len(joints.name))
        joints = replace(joints, stiffness=stiffer * joints.stiffness, damping=stiffer * lossier * joints.damping)
        contacts = replace(self.model.contacts, stiffness=factors.contact_stiffness * self.model.contacts.stiffness)
        model, loss, lining = replace(self.model, joints=joints, contacts=contacts), self.loss, self.lining
        if lining is not None and factors.lining != 1:
            model = replace(model, stiffness=model.stiffness + (factors.lining - 1) * lining)
            loss, lining = loss + (factors.lining - 1) * self.lining_loss_factor * lining, factors.lining * lining
        if np.any(np.not_equal(factors.body_loss, 1)):
            scale = np.sqrt(np.broadcast_to(factors.body_loss, len(self.model.body_name)))[body]
            loss = scale[:, None] * loss * scale
        return replace(self, model=model, loss=loss, lining=lining,
                       joint_loss_factor=lossier * self.joint_loss_factor,
                       law_closure=np.asarray(self.law_closure) / factors.contact_stiffness,
                       damping_speed=factors.damping_speed * self.damping_speed,
                       added=self.added and self.added.varied(factors),
                       friction=partial(changed_friction, self.friction, self.pivot, factors))

    def imaginary_stiffness(self):
        """(n, n) N/m by the loss factors of bodies and joints."""
        rows = self.model.joints.rows
        return self.loss + spread(rows, self.joint_loss_factor * self.model.joints.stiffness, rows)


def changed_friction(law, pivot, factors, pressure, speed):
    """FrictionState (c,) of ``law`` at ``pressure`` Pa and ``speed`` m/s, with what the Factors add to it."""
    state = law(pressure, speed)
    if not (factors.friction or factors.pressure_slope or factors.speed_slope):
        return state
    coefficient, slopes = state.coefficient + factors.friction, []
    for slope, added, value, middle, ends in (
            (state.pressure_slope, factors.pressure_slope, pressure, pivot.pressure, pivot.pressures),
            (state.speed_slope, factors.speed_slope, speed, pivot.speed, pivot.speeds)):
        inside = (value > ends[0]) & (value < ends[1])
        value = np.clip(value, max(ends[0], np.finfo(float).tiny), ends[1])
        coefficient = coefficient + (added * np.log(value / middle) if added else 0.0)
        slopes.append(slope + np.where(inside, added / value, 0.0))
    holds = coefficient > 0
    return FrictionState(np.where(holds, coefficient, 0.0), *(np.where(holds, slope, 0.0) for slope in slopes))
