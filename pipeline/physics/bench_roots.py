"""Small motions of a bench about steady sliding: its matrices and complex roots, for hammer records and growth rates.

Contacts count with the slope of their law under the steady load, friction with its slopes over pressure and slip speed,
elements with the slope of their force where they stand, Maxwell branches with a state of their own; excitations, wear
and the shapes of surfaces drop out. The waveform of a squeal is not compared with anything, its growth rate and
frequency are.
"""

from dataclasses import replace

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.bench import run_drive, run_inputs
from pipeline.physics.element_forces import DRY, element_force
from pipeline.physics.elements import Maxwell, alone
from pipeline.physics.friction_law import friction_at
from pipeline.physics.sliding_model import FrictionState, spread
from pipeline.physics.time_stepping import Penalty, Table
from pipeline.physics.time_stepping_elements import no_memory
from pipeline.physics.time_stepping_start import steady_start


def roots(bench, run):
    """Complex roots (2 n + b,) in rad/s, by rising frequency: growth rate and angular frequency of each motion.

    Each of the b Maxwell branches of elements adds one, F' = k v - F / tau.
    """
    mass, damping, stiffness = linearised(bench, run)
    rows, springs, times = _branches(bench.model)
    count, hidden = len(mass), len(rows)
    state = np.block([[np.zeros((count, count)), np.eye(count), np.zeros((count, hidden))],
                      [-np.linalg.solve(mass, part) for part in (stiffness, damping, rows.T)],
                      [np.zeros((hidden, count)), springs[:, None] * rows, -np.diag(1 / times)]])
    found = np.linalg.eigvals(state)
    return found[np.lexsort((found.imag, abs(found.imag)))]


def linearised(bench, run):
    """(M, C, K), each (n, n), about steady sliding under the first inputs and drive speed of ``run``.

    Maxwell branches are left out, as in a motion so slow that they relax.
    Friction turns in its plane with the motion only where friction-induced damping is a term of the simulation; here it
    is left out as there. Raises ConfigError for contacts that do not yield, and what ``steady_start`` raises.
    """
    model = bench.model.at_speed(float(np.ravel(run_drive(bench, run))[0]))
    inputs = np.array([float(np.ravel(i)[0]) for i in run_inputs(bench, run)])
    start = steady_start(model, bench.law, bench.friction, inputs)
    contacts = model.contacts
    stiffness, damping = _tangent(bench.law, contacts, start.normal)
    pressure, slip = start.normal / contacts.area, abs(model.sliding_speed)
    law = bench.friction.law
    read = np.array([friction_at(p, s, bench.friction.distance, *law.table)[:3]
                     for p, s in zip(pressure, slip, strict=True)]).reshape(-1, 3)
    contacts = replace(contacts, preload=start.normal, stiffness=stiffness, damping=damping)
    moving = replace(model, contacts=contacts)
    mass, drag, spring = moving.linearised(FrictionState(*read.T), friction_damping=False)
    rows, slope, loss = _elements(model, start)
    return mass, drag + spread(rows, loss, rows), spring + spread(rows, slope, rows)


def _tangent(law, contacts, normal):
    """Normal stiffness and damping (c,) of the law under the forces ``normal``; 0 for open contacts."""
    shut = (normal > 0) & ~contacts.fixed
    if isinstance(law, Penalty):
        return tuple(np.where(shut, value, 0.0) for value in (law.stiffness, law.damping))
    if not isinstance(law, Table):
        if shut.any():
            raise ConfigError("roots of a bench", "contacts that yield", type(law).__name__, "give them a stiffness")
        return np.zeros(len(normal)), np.zeros(len(normal))
    closure, pressure = np.asarray(law.closure, float), np.asarray(law.pressure, float)
    k = np.clip(np.searchsorted(pressure, normal / contacts.area, side="right") - 1, 0, len(pressure) - 2)
    slope = (pressure[k + 1] - pressure[k]) / (closure[k + 1] - closure[k])
    return np.where(shut, contacts.area * slope, 0.0), np.where(shut, normal / law.damping_speed, 0.0)


def _branches(model):
    """(rows (b, n), stiffness (b,), time (b,)) of the Maxwell branches of all elements."""
    laws = [(e.row, k, t) for e in model.elements if isinstance(e.law, Maxwell)
            for k, t in zip(e.law.stiffness, e.law.time, strict=True)]
    rows, springs, times = zip(*laws, strict=True) if laws else ((), (), ())
    return np.array(rows, float).reshape(-1, model.size), np.array(springs, float), np.array(times, float)


def _elements(model, start):
    """(rows (e, n), stiffness (e,), damping (e,)) of the elements about the start; dry friction sticks or slides
    through zero, which no matrix says, and counts as nothing."""
    kernel, rows = alone(model.elements), np.array([e.row for e in model.elements]).reshape(-1, model.size)
    memory = no_memory(kernel) if start.memory is None else start.memory
    slopes = np.zeros((2, len(rows)))
    for k, row in enumerate(rows):
        if kernel.kind[k] != DRY:
            place = float(row @ start.displacement)
            slopes[:, k] = element_force(kernel, k, place, 0.0, place, memory, memory.copy(),
                                         (0.0, 0.0, model.speed))[1:]
    return rows, *slopes
