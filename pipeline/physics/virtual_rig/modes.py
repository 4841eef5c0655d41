"""Modes of small motions of a bench as its sensors see them, and what turns with the drive, slowly.

A contact that does not slide holds on: where the drive rests, its tangential stiffness takes the place of friction.
"""

from dataclasses import replace
from functools import lru_cache

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.modal.quadratic_eigenproblem import by_frequency
from pipeline.physics.sliding.model import Joints
from pipeline.physics.time_stepping.initial_state import steady_start
from pipeline.physics.virtual_rig.response import at_begin, run_friction
from pipeline.physics.virtual_rig.roots import small_motion

#: angles of the drive at which order-locked forces are read
_ANGLES = 16


def modes(bench, run):
    """(root (p,) rad/s, shape (p, c)) of the oscillating motions, by rising frequency.

    Shapes are velocities that the motion channels (c,) of the bench write, gain and delay included; accelerations and
    displacements count by their velocity. Raises what ``small_motion`` raises.
    """
    held = sticking(bench, run)
    matrix = small_motion(held, run).matrix()
    values, vectors = _eigen(matrix.tobytes(), len(matrix))
    kept = np.flatnonzero(values.imag > 0)
    kept = kept[by_frequency(values[kept])]
    root, shape = values[kept], vectors[:held.model.size, kept].T
    shown = [root * (shape @ held.sensor(c.source, f"channel {c.name}: sensor")) * c.gain * np.exp(-root * c.delay)
             for c in motions(bench)]
    return root, np.reshape(shown, (-1, len(root))).T


@lru_cache(maxsize=16)
def _eigen(matrix, size):
    """Eigenvalues and vectors of the bytes of a matrix: runs that differ in what does not act share them."""
    return np.linalg.eig(np.frombuffer(matrix).reshape(size, size))


def motions(bench):
    """Sensors of the bench that measure a motion."""
    return tuple(c for c in bench.channels if c.moves)


def sticking(bench, run):
    """The bench as ``run`` finds it: with its contacts held along sliding where the drive rests, and as it is else.

    Where nothing presses either they are lifted, clear of the waves of the surface.
    """
    friction, model = bench.friction, bench.model
    speed, inputs = at_begin(bench, run)
    if speed != 0:
        return bench
    if not np.any(inputs):
        return replace(bench, model=replace(model, contacts=replace(model.contacts, waviness=())))
    stiffness = np.broadcast_to(np.asarray(friction.stiffness, float), len(model.contacts.area))
    if friction.description == "rigid" or not (stiffness > 0).all():
        raise ConfigError(f"run {run.name}", "contacts with a tangential stiffness, because the drive rests",
                          f"the {friction.description} description", "set bench.description and tangential_stiffness")
    names = tuple(f"stuck contact {k + 1}" for k in range(len(stiffness)))
    joints = Joints((*model.joints.name, *names), np.vstack((model.joints.rows, model.contacts.tangent)),
                    np.append(model.joints.stiffness, stiffness), np.append(model.joints.damping, 0 * stiffness))
    return replace(bench, model=replace(model, joints=joints), friction=constant(0.0))


def order_locked(bench, run, joint, orders):
    """(order,) complex amplitudes F of the force of a ``joint``, Re F exp(-i order angle), turned so slowly that
    nothing swings; 0 where no surface is wavy."""
    speed, inputs = at_begin(bench, run)
    model = bench.model.at_speed(speed)
    if not model.contacts.waviness:
        return np.zeros(len(orders), complex)
    row, stiffness, _ = bench.joint(joint)
    angle = 2 * np.pi * np.arange(_ANGLES) / _ANGLES
    force = []
    for turned in angle:
        waves = tuple(replace(w, phase=w.phase - w.order * turned) for w in model.contacts.waviness)
        there = replace(model, contacts=replace(model.contacts, waviness=waves))
        start = steady_start(there, bench.law, run_friction(bench, run), inputs)
        force.append(stiffness * (row @ start.displacement))
    return np.array([2 * np.mean(np.array(force) * np.exp(1j * order * angle)) for order in orders])
