"""Preloaded modes of the pads and caliper on the rigid disc, with static responses to the contact forces.

Friction makes the stiffness unsymmetric, and the real modes below a limit alone then converge slowly (static
corrections: see ``friction_corrections``): the rest of the structure answers statically to each contact force. These
responses are added, orthogonal to the modes. Their own frequencies mean nothing; undamped, they would flutter among
themselves, so they get a damping ratio of their own.
"""

import numpy as np
import scipy

from pipeline.physics.pads.pad_system import PadSystem
from pipeline.physics.pads.sliding_pads import linearised

#: directions with a smaller share of the largest mass are not independent
INDEPENDENT = 1e-10


def preloaded_modes(system, start, highest_frequency=np.inf, correction_damping=0.3):
    """(system in modal coordinates, basis (n, m)): q = start + basis @ coordinates, unit masses.

    The basis holds the modes, below ``highest_frequency`` in Hz, of the frictionless ``system`` linearised about its
    static state ``start`` (n,), and the static responses to the normal and friction force of every contact, with the
    damping ratio ``correction_damping``. The static state is exact whatever is left out, and the contact law stays
    nonlinear.
    """
    stiffness, _ = linearised(system, start, friction=False)
    stiffness = (stiffness + stiffness.T) / 2
    square, modes = scipy.linalg.eigh(stiffness, system.mass)
    kept = square <= (2 * np.pi * highest_frequency) ** 2
    corrections, pace = _corrections(system, stiffness, modes[:, kept])
    basis = np.ascontiguousarray(np.hstack((modes[:, kept], corrections)))
    extra = np.diag(np.concatenate((np.zeros(kept.sum()), 2 * correction_damping * pace)))
    law = system.contact.law
    contact = system.contact._replace(rows=system.contact.rows @ basis,
                                      law=law._replace(gap=law.gap + system.contact.rows[0] @ start))
    return PadSystem(
        mass=np.eye(basis.shape[1]), damping=basis.T @ system.damping @ basis + extra,
        stiffness=basis.T @ system.stiffness @ basis, load=basis.T @ (system.load - system.stiffness @ start),
        contact=contact, elements=_projected(system.elements, basis, start)), basis


def _projected(elements, basis, start):
    """PadElements in the coordinates of ``basis`` about ``start``."""
    if not elements.offset.size:
        return elements
    return elements._replace(rows=elements.rows @ basis, offset=elements.offset + elements.rows @ start)


def _corrections(system, stiffness, modes):
    """(vectors (n, k), angular frequencies (k,)): static responses to contact forces, orthogonal to the modes."""
    forces = np.vstack(system.contact.rows[:2]).T
    answer = np.linalg.solve(stiffness, forces)
    answer = answer / np.linalg.norm(answer, axis=0)
    answer = answer - modes @ (modes.T @ (system.mass @ answer))
    weight, mix = np.linalg.eigh(answer.T @ system.mass @ answer)
    if modes.shape[1] == len(stiffness):
        return answer[:, :0], np.empty(0)
    independent = weight > INDEPENDENT * np.abs(np.diag(system.mass)).max()
    vectors = answer @ (mix[:, independent] / np.sqrt(weight[independent]))
    square, turn = np.linalg.eigh(vectors.T @ stiffness @ vectors)
    return vectors @ turn, np.sqrt(square)
