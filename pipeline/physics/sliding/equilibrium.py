"""Steady sliding of a SlidingModel: its equilibrium under the input forces f with friction on every patch.

Patch i of area A_i carries N_i = A_i p(c_i) at its closure c_i = -n_i q, and its friction T_i = s_i mu_i N_i, s_i the
sign of sliding, loads the bodies as well. With springs k on the patches, which cancel and only hold loose bodies,

    (K + sum_i k_i n_i n_i^T) q = f + sum_i n_i (N_i - k_i c_i) + t_i s_i mu_i N_i,

and the bodies are condensed to the closures, G_n, G_t and G_f being their answers to unit forces and g the gaps:

    c = G_f f - g + G_n (N - k (c + g)) + G_t s mu N.                                                              (1)

Newton's method of the static preload, which is (1) without friction, solves it for the closures. Friction rises from
nothing in as few steps as converge, so that the state found is the one which the static start leads to.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.contact.closure_law import force_at_rest
from pipeline.physics.contact.static_preload import BALANCED, Preload, balance, first_slope
from pipeline.physics.sliding.model import FrictionState, SlidingModel

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
    return ClosureResponse(*np.split(-contacts.normal @ moved, [count, 2 * count], axis=1), contacts.stiffness)


def steady_sliding(model, response, input_force, law_closure, law_pressure, friction):
    """SlidingState of a SlidingModel under ``input_force`` (i,) N.

    ``law_closure`` (k,) m and ``law_pressure`` (k,) Pa: normal law, from 0; ``friction`` is a coefficient or a function
    of pressure and sliding speed (c,) that gives a FrictionState. The preload of the model is the first guess. Raises
    ConvergenceError where friction cannot rise to its full value, as where the pads would tip or lock. Friction joints
    keep their preload.
    """
    gap, springs = model.contacts.gap, response.stiffness
    free = response.inputs @ input_force - gap - response.normal @ (springs * gap)
    equilibrium = _Equilibrium(model, response, free, law_closure, law_pressure,
                               friction if callable(friction) else lambda *_: FrictionState(friction))
    closure = equilibrium.solve(np.interp(model.contacts.pressure, law_pressure, law_closure), 0.0)
    reached, rise = 0.0, 1.0
    while closure is not None and reached < 1:
        solution = equilibrium.solve(closure, min(reached + rise, 1.0))
        if solution is not None:
            closure, reached = solution, min(reached + rise, 1.0)
        elif rise > _SMALLEST_RISE:
            rise /= 2
        else:
            break
    if reached < 1:
        raise ConvergenceError("steady sliding", f"contact forces that balance within {BALANCED:g}",
                               f"none beyond {reached:.3g} of the friction", "lower friction, or raise the load")
    force, stiffness = equilibrium.contact(closure)
    return SlidingState(Preload(force, stiffness, closure), equilibrium.friction_state(force))


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
    """The model with its contacts linearised about ``contact``, a Preload.

    ``damping_speed`` in m/s is the closing speed that doubles the contact force (Hunt & Crossley, J. Appl. Mech. 42
    (1975) 440): normal damping N / damping_speed.
    """
    return replace(model, contacts=replace(model.contacts, preload=contact.force, stiffness=contact.stiffness,
                                           damping=contact.force / damping_speed))


@dataclass(frozen=True)
class _Equilibrium:
    """Equation (1) of one model under one load; ``free`` (c,) m are the closures by inputs and gaps alone."""

    model: SlidingModel
    response: ClosureResponse
    free: np.ndarray
    law_closure: np.ndarray
    law_pressure: np.ndarray
    friction: Callable

    def contact(self, closure):
        """Force (c,) N and its slope (c,) N/m at ``closure``."""
        contacts = self.model.contacts
        force, slope = force_at_rest(closure, contacts.area, self.law_closure, self.law_pressure)
        return np.where(contacts.fixed, contacts.preload, force), np.where(contacts.fixed, 0.0, slope)

    def friction_state(self, force):
        return self.friction(force / self.model.contacts.area, abs(self.model.sliding_speed))

    def solve(self, closure, share):
        """Closures (c,) with a ``share`` of the friction, or None where Newton's method does not get there."""
        contacts = self.model.contacts
        first = np.where(contacts.fixed, 0.0, first_slope(contacts.area, self.law_closure, self.law_pressure))
        closure, imbalance = balance(partial(self._miss, share=share), closure, first,
                                     (first * np.abs(self.free)).max())
        return closure if imbalance <= BALANCED else None

    def _miss(self, closure, share):
        """(c less the right side of (1), N, dN/dc, derivative of the first) at ``closure``."""
        response, springs = self.response, self.response.stiffness
        force, slope = self.contact(closure)
        state = self.friction_state(force)
        sign = share * self.model.direction()
        coupling = sign * (state.coefficient + force / self.model.contacts.area * state.pressure_slope)
        reached = (self.free + response.normal @ (force - springs * closure)
                 + response.tangent @ (sign * state.coefficient * force))
        tangent = np.eye(len(closure)) - response.normal * (slope - springs) - response.tangent * (coupling * slope)
        return closure - reached, force, slope, tangent
