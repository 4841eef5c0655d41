"""Steady sliding as the start of a transient: equilibrium under input forces with friction on every closed contact.

Contact i closes by c_i(N_i) under the force N_i: 0 for contacts that do not yield, N / k, or the inverse of a table.
With s_i the sign of sliding, the closed contacts C obey

    K q - sum_C (n_i + s_i mu_i t_i) N_i = f,      n_i q + gap_i + c_i(N_i) = 0,

mu_i with what the states of friction make of it, solved together, so that contacts may be what holds a body. Contacts
that would pull are opened, gaps that would be negative are closed, until neither is left. Friction joints add
s_i mu_i N_i t_i to f, nonlinear elements their forces at rest by Newton's method: those with memory as if loaded for
the first time, dry friction none. This serves every law of a transient; ``sliding.equilibrium`` solves for closures,
which contacts that do not yield do not have. With a table both have the same state (tested).
"""

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.contact.groups import read
from pipeline.physics.friction.dry_friction import coefficients
from pipeline.physics.friction.state_variables import factors, started, state_kernel
from pipeline.physics.time_stepping.coupled_solver import no_memory, surface_shift
from pipeline.physics.time_stepping.element_forces import FRICTION, element_force
from pipeline.physics.time_stepping.elements import alone, wave_table
from pipeline.physics.time_stepping.normal_laws import closing
from pipeline.physics.time_stepping.simulate import Start

_ROUNDS = 200
_TOLERANCE = 1e-10
#: rounds of Newton's method before elements are read halfway, as it may go to and fro over a slider that sticks; from
#: then on every so many rounds are whole again
_PLAIN, _WHOLE = 50, 8


def steady_start(model, law, friction, inputs):
    """Start of a SlidingModel at its speed, under ``inputs`` (i,) N, with the ``law`` and Friction of the transient.

    A drive at rest gives equilibrium without friction. Raises ConfigError where joints and closed contacts do not hold
    the bodies, ConvergenceError where no equilibrium is found, as where friction locks.
    """
    contacts = model.contacts
    load, stiffness = np.asarray(inputs, float) @ model.input_rows, model.supported()[2]
    gap = read(law, "gap", len(contacts.area)) + _waves(contacts)
    elements, memory, rest, slope = alone(model.elements), None, 0.0, 0.0
    states, fixed = state_kernel(friction, contacts.area), contacts.fixed
    sign, closed, force = np.sign(model.sliding_speed), ~fixed, contacts.preload
    place = np.zeros(model.size)
    for number in range(_ROUNDS):
        whole = number < _PLAIN or number % _WHOLE == 0
        grown = factors(states, started(states, force, model.sliding_speed), 0.0)
        ratio = sign * grown * coefficients(friction, model.sliding_speed, force / contacts.area)
        give, offset = closing(law, force, contacts.area)
        held = load + (ratio * force)[fixed] @ contacts.tangent[fixed] - rest
        pushed = contacts.normal + ratio[:, None] * contacts.tangent
        displacement, solved = _solve(stiffness + slope, held, contacts.normal, pushed, gap + offset, give, closed)
        solved = np.where(fixed, force, solved)
        wanted = np.where(closed, solved > 0, gap + contacts.normal @ displacement < 0) & ~fixed
        settled = abs(solved - force).max(initial=0.0) <= _TOLERANCE * abs(solved).max(initial=0.0)
        if model.elements:
            counted = rest + slope @ displacement if np.ndim(slope) else np.zeros(model.size)
            place = displacement if whole else (place + displacement) / 2
            rest, slope, memory = _drawn(elements, model, place)
            error = rest + slope @ displacement - counted
            scale = max(abs(held).max(), abs(stiffness @ displacement).max())
            settled = settled and whole and abs(error).max() <= _TOLERANCE * scale
        if settled and np.array_equal(wanted, closed | ((solved > 0) & ~fixed)):
            return Start(displacement, np.zeros(model.size), solved, ratio * solved, memory)
        closed, force = wanted, np.where(wanted | fixed, solved, 0.0)
    raise ConvergenceError("steady sliding", "forces that press on every closed contact", "none",
                           "lower friction or change the tilt (friction that locks has no steady sliding), or start at"
                           " rest")


def _waves(contacts):
    """Height (c,) of the surfaces at time 0."""
    shift = np.zeros((2, len(contacts.area)))
    surface_shift(wave_table(contacts.waviness), (0.0, 0.0, 0.0), shift)
    return shift[0]


def _drawn(elements, model, displacement):
    """(F - S q (n,), S (n, n), memory) of the elements at rest at ``displacement`` (n,), S the slope of F there."""
    rows, force, slope, memory = forces_at_rest(elements, model, displacement)
    return rows.T @ (force - slope * (rows @ displacement)), (rows.T * slope) @ rows, memory


def forces_at_rest(elements, model, displacement):
    """(rows (e, n), forces (e,) N, their slopes (e,) N/m, memory) of the ``elements`` of a SlidingModel, an
    ElementKernel, at rest at ``displacement`` (n,) m; dry friction has none there."""
    rows = np.array([e.row for e in model.elements])
    memory, none = no_memory(elements), no_memory(elements)
    force, slope = np.zeros((2, len(rows)))
    for k, row in enumerate(rows):
        if elements.kind[k] not in FRICTION:
            force[k], slope[k], _ = element_force(elements, k, float(row @ displacement), 0.0, 0.0, none, memory,
                                                  (0.0, 0.0, model.speed))
    return rows, force, slope, memory


def random_kick(system, sensor_rows, velocity, seed):
    """Random velocity (n,) of a ModalSystem, all modes alike, whose effective value at the sensors is ``velocity`` m/s.

    ``sensor_rows`` (s, n); nothing where the sensors see nothing.
    """
    kick = system.shape @ np.random.default_rng(seed).standard_normal(len(system.squared))
    seen = np.sqrt(np.mean((sensor_rows @ kick) ** 2)) if len(sensor_rows) else 0.0
    return kick * (velocity / seen if seen else 0.0)


def _solve(stiffness, load, normal, pushed, gap, give, closed):
    """(displacement, forces) with the contacts ``closed``; 0 N on the others."""
    size, active = len(load), np.flatnonzero(closed)
    matrix = np.zeros((size + len(active),) * 2)
    matrix[:size, :size], matrix[:size, size:] = stiffness, -pushed[active].T
    matrix[size:, :size], matrix[size:, size:] = normal[active], np.diag(give[active])
    weight = _weights(stiffness, normal[active], give[active])
    scaled = weight[:, None] * matrix * weight
    factors, pivots, singular = scipy.linalg.lapack.dgetrf(scaled)
    if singular or scipy.linalg.lapack.dgecon(factors, abs(scaled).sum(axis=0).max())[0] < np.finfo(float).eps:
        raise ConfigError("steady sliding", "joints and closed contacts that hold every body", "a body that is free",
                          "support it, press it on, or start at rest")
    solution = weight * scipy.linalg.lapack.dgetrs(factors, pivots, weight * np.r_[load, -gap[active]])[0]
    force = np.zeros(len(closed))
    force[active] = solution[size:]
    return solution[:size], force


def _weights(stiffness, normal, give):
    """(n + a,) weights that give every coordinate, and every closed contact, an entry of about one on the diagonal.

    Coordinates count with the contacts that yield on them: stiffnesses of the vibration modes of a body exceed those of
    its soft joints by many powers of ten, and one weight for all would make a body on soft joints look free.
    """
    yields = give > 0
    held = abs(np.diag(stiffness)) + (normal[yields] ** 2 / give[yields, None]).sum(axis=0)
    coordinates = 1 / np.sqrt(np.where(held > 0, held, held.max(initial=0.0) or 1.0))
    reach = give + ((normal * coordinates) ** 2).sum(axis=1)
    return np.r_[coordinates, 1 / np.sqrt(np.where(reach > 0, reach, 1.0))]
