"""Small motions of a bench about steady sliding: its matrices and complex roots, for hammer records and growth rates.

Contacts count with the slope of their law under the steady load, friction with its slopes over pressure and slip speed,
elements with the slope of their force where they stand; excitations and the shapes of surfaces drop out. The waveform
of a squeal is not compared with anything, its growth rate and frequency are.
"""

from dataclasses import replace

import numpy as np

from pipeline.physics.bench import run_drive, run_inputs
from pipeline.physics.contact_groups import parts
from pipeline.physics.element_forces import DRY, element_force
from pipeline.physics.elements import alone
from pipeline.physics.friction_law import friction_at
from pipeline.physics.normal_law import tangent
from pipeline.physics.sliding_model import FrictionState, spread
from pipeline.physics.time_stepping_elements import no_memory
from pipeline.physics.time_stepping_start import steady_start


def roots(bench, run):
    """Complex roots (2 n,) in rad/s, by rising frequency: growth rate and angular frequency of each motion."""
    mass, damping, stiffness = linearised(bench, run)
    count = len(mass)
    state = np.block([[np.zeros((count, count)), np.eye(count)],
                      [-np.linalg.solve(mass, stiffness), -np.linalg.solve(mass, damping)]])
    found = np.linalg.eigvals(state)
    return found[np.lexsort((found.imag, abs(found.imag)))]


def linearised(bench, run):
    """(M, C, K), each (n, n), about steady sliding under the first inputs and drive speed of ``run``.

    Friction turns in its plane with the motion only where friction-induced damping is a term of the simulation; here it
    is left out as there. Raises ConfigError for contacts that do not yield, and what ``steady_start`` raises.
    """
    model = bench.model.at_speed(float(np.ravel(run_drive(bench, run))[0]))
    inputs = np.array([float(np.ravel(i)[0]) for i in run_inputs(bench, run)])
    start = steady_start(model, bench.law, bench.friction, inputs)
    contacts = model.contacts
    stiffness, damping = tangent(bench.law, np.where(contacts.fixed, 0.0, start.normal), contacts.area)
    contacts = replace(contacts, preload=start.normal, stiffness=stiffness, damping=damping)
    moving = replace(model, contacts=contacts)
    state = _friction_state(bench.friction, model.sliding_speed, start.normal / contacts.area)
    mass, drag, spring = moving.linearised(state, friction_damping=False)
    rows, slope, loss = _elements(model, start)
    return mass, drag + spread(rows, loss, rows), spring + spread(rows, slope, rows)


def _friction_state(friction, speed, pressure):
    """FrictionState (c,) at signed sliding speeds (c,) and pressures (c,)."""
    found = np.empty((3, len(speed)))
    for law, own in parts(friction, len(speed)):
        for i in own:
            factor = law.backward if speed[i] < 0 else 1.0
            found[:, i] = factor * np.array(friction_at(pressure[i], abs(speed[i]), law.distance, *law.law.table)[:3])
    return FrictionState(*found)


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
