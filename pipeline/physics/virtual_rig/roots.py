"""Small motions of a bench about steady sliding: its matrices and complex roots, for hammer records and growth rates.

    M q'' + C q' + K q = B z,      z' = P q + V q' - R z

Contacts count with the slope of their law under the steady load, friction with its slopes over pressure and slip speed,
elements with the slope of their force where they stand; z are the Maxwell branches of elements and the states of
friction that settle in steady sliding, R diagonal. Excitations, wear, the shapes of surfaces and friction that varies
around the drive drop out; states that drift (heat, films, distance) stay where a run begins. The waveform of a squeal
is not compared with anything, its growth rate and frequency are.
"""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.friction.state_variables import shapeless
from pipeline.physics.modal.quadratic_eigenproblem import by_frequency
from pipeline.physics.stability.linearisation import (
    Settling,
    element_slopes,
    friction_about,
    maxwell_branches,
    present,
    settling,
)
from pipeline.physics.system.forms import spread
from pipeline.physics.time_stepping.initial_state import steady_start
from pipeline.physics.time_stepping.normal_laws import tangent
from pipeline.physics.virtual_rig.response import at_begin, run_friction


@dataclass(frozen=True)
class SmallMotion:
    """The matrices above: ``mass``, ``damping``, ``stiffness`` (n, n), and the k branches and states that settle."""

    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    settling: Settling

    def matrix(self):
        """State matrix (2 n + k, 2 n + k) of (q, q', z)."""
        beside = self.settling
        size, states = beside.push.shape
        whole = np.zeros((2 * size + states,) * 2)
        whole[:size, size:2 * size] = np.eye(size)
        whole[size:2 * size] = np.linalg.solve(self.mass, np.hstack((-self.stiffness, -self.damping, beside.push)))
        whole[2 * size:] = np.hstack((beside.by_place, beside.by_speed, -np.diag(beside.decay)))
        return whole


def roots(bench, run):
    """Complex roots (2 n + k,) in rad/s, by rising frequency: growth rate and angular frequency of each motion.

    Each of the k Maxwell branches, F' = k v - F / tau, and states of friction adds one.
    """
    values = np.linalg.eigvals(small_motion(bench, run).matrix())
    values = values[np.argsort(values.imag, kind="stable")]
    return values[by_frequency(values.real + 1j * abs(values.imag))]


def linearised(bench, run):
    """(M, C, K), each (n, n), of ``small_motion``, without Maxwell branches, as in a motion so slow that they relax.

    ConfigError where friction has states that settle, which no such three hold.
    """
    motion = small_motion(bench, run)
    states = len(motion.settling.decay) - len(maxwell_branches(bench.model)[2])
    if states:
        raise ConfigError("matrices of a bench", "friction without states", f"{states} states",
                          "take small_motion, whose matrix holds them")
    return motion.mass, motion.damping, motion.stiffness


def small_motion(bench, run):
    """SmallMotion about steady sliding under the first inputs and drive speed of ``run``.

    Friction turns in its plane with the motion only where an element says so, as in the simulation. Raises ConfigError
    for contacts that do not yield, and what ``steady_start`` raises.
    """
    speed, inputs = at_begin(bench, run)
    model = bench.model.at_speed(speed)
    friction = shapeless(run_friction(bench, run))
    start = steady_start(model, bench.law, friction, inputs)
    contacts, slip = model.contacts, model.sliding_speed
    stiffness, damping = tangent(bench.law, np.where(contacts.fixed, 0.0, start.normal), contacts.area)
    model = replace(model, contacts=replace(contacts, preload=start.normal, stiffness=stiffness, damping=damping))
    state, states = friction_about(friction, slip, start.normal, contacts.area)
    mass, drag, spring = model.linearised(present(state, states), friction_damping=False)
    rows, slope, loss = element_slopes(model, start, slip)
    return SmallMotion(mass, drag + spread(rows, loss, rows), spring + spread(rows, slope, rows),
                       settling(model, state, states))
