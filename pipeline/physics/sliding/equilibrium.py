"""Steady sliding of a SlidingModel: its equilibrium under the input forces f with friction on every patch.

Patch i of area A_i carries N_i = A_i p(c_i) at its closure c_i = -n_i q, and its friction T_i = s_i mu_i N_i, s_i the
sign of sliding, loads the bodies as well. With springs k on the patches, which cancel and only hold loose bodies,

    (K + sum_i k_i n_i n_i^T) q = f + sum_i n_i (N_i - k_i c_i) + t_i s_i mu_i N_i,

and the bodies are condensed to the closures, G_n, G_t and G_f being their answers to unit forces and g the gaps:

    c = G_f f - g + G_n (N - k (c + g)) + G_t s mu N.                                                              (1)

Newton's method of the static preload, which is (1) without friction, solves it for the closures. Friction rises from
nothing in as few steps as converge, so that the state found is the one which the static start leads to. Nonlinear
springs join as contacts without friction, whose force may pull. Complex modes, draws in the whole model and the pads of
the multibody simulation find their sliding state here. Two other places remain: ``sampled_sliding`` projects the same
equations on a basis that thousands of draws share, and ``time_stepping.initial_state`` serves contacts that do not
yield, which have no closure to solve for.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.contact.closure_law import damping_at_rest, force_at_rest
from pipeline.physics.contact.static_preload import BALANCED, Preload, balance, first_slope
from pipeline.physics.numerics.damped_newton import LowRank
from pipeline.physics.sliding.model import FrictionState, SlidingModel

#: contacts for each coordinate from which on Newton's method is quicker in the coordinates
_FEW = 1.8
#: shortest step of the rising friction, as a share of the whole
_SMALLEST_RISE = 1 / 64


@dataclass(frozen=True)
class ClosureResponse:
    """Closures per force on the bodies with springs ``stiffness`` (c,) N/m on the patches.

    ``normal`` and ``tangent`` (c, c) m/N per force along the normal and tangent rows; ``inputs`` (c, i) m/N.
    """

    normal: np.ndarray
    tangent: np.ndarray
    inputs: np.ndarray
    stiffness: np.ndarray

    def closed(self, normal, tangent):
        """Closures (c,) m by forces ``normal`` and ``tangent`` (c,) N."""
        return self.normal @ normal + self.tangent @ tangent

    def derivative(self, normal, tangent):
        """Of closures less those by forces that rise by ``normal`` and ``tangent`` (c,) N/m with them."""
        return np.eye(len(normal)) - self.normal * normal - self.tangent * tangent


@dataclass(frozen=True)
class _OfFewCoordinates:
    """A ClosureResponse of more contacts than coordinates r: closures are ``rows`` (c, r) times what ``normal`` and
    ``tangent`` (r, c) per force make of these."""

    rows: np.ndarray
    normal: np.ndarray
    tangent: np.ndarray
    inputs: np.ndarray
    stiffness: np.ndarray

    def closed(self, normal, tangent):
        return self.rows @ (self.normal @ normal + self.tangent @ tangent)

    def derivative(self, normal, tangent):
        return LowRank(self.rows, self.normal * normal + self.tangent * tangent)


@dataclass(frozen=True)
class SlidingState:
    """Forces, stiffnesses and closures of the patches in steady sliding, and the friction there."""

    contact: Preload
    friction: FrictionState


def closure_response(model, centrifugal=True):
    """ClosureResponse of a SlidingModel. Raises ConfigError where joints and contacts do not hold the bodies."""
    contacts = model.contacts
    rows = np.vstack((contacts.normal, contacts.tangent, model.input_rows))
    try:
        moved = np.linalg.solve(model.frictionless(centrifugal=centrifugal)[2], rows.T)
    except np.linalg.LinAlgError:
        raise ConfigError("steady sliding", "joints and contacts that hold every body",
                          "a singular stiffness") from None
    count = len(contacts.area)
    if count > _FEW * len(moved):
        normal, tangent, inputs = np.split(moved, [count, 2 * count], axis=1)
        return _OfFewCoordinates(-contacts.normal, normal, tangent, -contacts.normal @ inputs, contacts.stiffness)
    return ClosureResponse(*np.split(-contacts.normal @ moved, [count, 2 * count], axis=1), contacts.stiffness)


def steady_sliding(model, response, input_force, law_closure, law_pressure, friction):
    """SlidingState of a SlidingModel under ``input_force`` (i,) N.

    ``law_closure`` (k,) m and ``law_pressure`` (k,) Pa: normal law, from 0; ``friction`` is a coefficient or a function
    of pressure and sliding speed (c,) that gives a FrictionState. The preload of the model is the first guess. Friction
    joints keep their preload. Errors as of ``settled``.
    """
    contacts = model.contacts

    def law(closure):
        force, slope = force_at_rest(closure, contacts.area, law_closure, law_pressure)
        return np.where(contacts.fixed, contacts.preload, force), np.where(contacts.fixed, 0.0, slope)

    first = np.where(contacts.fixed, 0.0, first_slope(contacts.area, law_closure, law_pressure))
    return settled(model, response, input_force, law, first, friction,
                   np.interp(contacts.pressure, law_pressure, law_closure))


def settled(model, response, input_force, law, first, friction, guess=None, where="steady sliding"):
    """SlidingState of a SlidingModel whose contacts obey ``law(closure)``: force (c,) N and its slope (c,) N/m at rest.

    ``first`` (c,) N/m: slope where a contact has just closed; ``guess`` (c,) m: closures to begin with, by default
    those of the springs of the ``response``; ``where`` is said in errors; the rest as of ``steady_sliding``. Raises
    ConvergenceError where no state is found without friction, or where friction cannot rise to its full value, as where
    pads would tip or lock.
    """
    gap, springs = model.contacts.gap, response.stiffness
    free = response.inputs @ input_force - gap - response.closed(springs * gap, 0 * springs)
    equilibrium = _Equilibrium(model, response, free, law, first,
                               friction if callable(friction) else lambda *_: FrictionState(friction))
    closure = equilibrium.solve(free if guess is None else guess, 0.0)
    if closure is None:
        raise ConvergenceError(where, f"contact forces that balance within {BALANCED:g}", "none without friction",
                               "check that joints hold every body and that the load presses the contacts")
    reached, rise = 0.0, 1.0
    while reached < 1:
        solution = equilibrium.solve(closure, min(reached + rise, 1.0))
        if solution is not None:
            closure, reached = solution, min(reached + rise, 1.0)
        elif rise > _SMALLEST_RISE:
            rise /= 2
        else:
            break
    if reached < 1:
        raise ConvergenceError(where, f"contact forces that balance within {BALANCED:g}",
                               f"none beyond {reached:.3g} of the friction", "lower friction, or raise the load")
    force, stiffness = law(closure)
    return SlidingState(Preload(force, stiffness, closure), equilibrium.friction_state(force))


def displacement(model, contact, friction, input_force, centrifugal=True):
    """(n,) m of the bodies of a SlidingModel under ``input_force`` (i,) N and the forces of a ``contact``, a Preload,
    with a ``friction`` coefficient, () or (c,)."""
    contacts, springs = model.contacts, model.contacts.stiffness
    held = contact.force - springs * (contact.closure + contacts.gap)
    force = input_force @ model.input_rows + held @ contacts.normal
    force = force + (model.direction() * friction * contact.force) @ contacts.tangent
    return np.linalg.solve(model.frictionless(centrifugal=centrifugal)[2], force)


def given_state(model, friction):
    """SlidingState of contacts without a normal law: each keeps the preload and the stiffness of the model.

    ``friction`` as for ``steady_sliding``; closures are those of the stiffness, 0 where there is none.
    """
    force, stiffness = model.contacts.preload, model.contacts.stiffness
    closure = np.divide(force, stiffness, out=np.zeros(len(force)), where=stiffness > 0)
    state = friction(model.contacts.pressure, abs(model.sliding_speed)) if callable(friction) else friction
    state = state if isinstance(state, FrictionState) else FrictionState(state)
    return SlidingState(Preload(force, stiffness, closure), state)


def from_map(law, distance, pressure, speed):
    """FrictionState of a FrictionLaw at a sliding ``distance`` (m), ``pressure`` (c,) Pa and ``speed`` (c,) m/s."""
    return FrictionState(*law.states(pressure, speed, distance))


def falling_with_speed(coefficient, static, decay_speed, pressure, speed):
    """FrictionState (c,) of mu = coefficient + (static - coefficient) exp(-speed / decay_speed), speeds in m/s."""
    more = (static - coefficient) * np.exp(-speed / decay_speed)
    return FrictionState(coefficient + more, 0 * pressure, -more / decay_speed)


def model_about(model, contact, damping_speed=np.inf):
    """The model with its contacts linearised about ``contact``, a Preload or another with its force and stiffness.

    ``damping_speed`` in m/s: the closing speed that doubles the contact force, infinite for no damping.
    """
    return replace(model, contacts=replace(model.contacts, preload=contact.force, stiffness=contact.stiffness,
                                           damping=damping_at_rest(contact.force, damping_speed)))


@dataclass(frozen=True)
class _Equilibrium:
    """Equation (1) of one model under one load; ``free`` (c,) m are the closures by inputs and gaps alone."""

    model: SlidingModel
    response: ClosureResponse
    free: np.ndarray
    law: Callable
    first: np.ndarray
    friction: Callable

    def friction_state(self, force):
        return self.friction(force / self.model.contacts.area, abs(self.model.sliding_speed))

    def solve(self, closure, share):
        """Closures (c,) with a ``share`` of the friction, or None where Newton's method does not get there."""
        closure, imbalance = balance(partial(self._miss, share=share), closure, self.first,
                                     (self.first * np.abs(self.free)).max())
        return closure if imbalance <= BALANCED else None

    def _miss(self, closure, share):
        """(c less the right side of (1), its derivative, N, dN/dc) at ``closure``."""
        response, springs = self.response, self.response.stiffness
        force, slope = self.law(closure)
        state = self.friction_state(force)
        sign = share * self.model.direction()
        coupling = sign * state.load_slope(force / self.model.contacts.area)
        reached = self.free + response.closed(force - springs * closure, sign * state.coefficient * force)
        return closure - reached, response.derivative(slope - springs, coupling * slope), force, slope
