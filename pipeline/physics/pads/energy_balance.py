"""Energy balance of the pads along a computed motion, whichever code has integrated it.

    stored - stored(0) = work of load, normal forces, friction and elements - loss in dampers

Powers are integrated by the trapezoidal rule over the samples, so that what is missing falls with the square of their
interval where steps were solved, and does not where forces are wrong.
"""

from typing import NamedTuple

import numpy as np
import scipy

from pipeline.physics.numerics.compiled import njit
from pipeline.physics.pads.memory import accept_elements, begun
from pipeline.physics.pads.pad_system import element_at


class EnergyBalance(NamedTuple):
    """Energies (m,) in J since the static start."""

    stored: np.ndarray          # kinetic energy and strain energy, less that of the static start
    input_work: np.ndarray      # of the load, on the pads, as the next three
    normal_work: np.ndarray
    friction_work: np.ndarray
    element_work: np.ndarray    # of nonlinear elements
    sliding_loss: np.ndarray    # of friction, on the slip
    damping_loss: np.ndarray    # in bodies, joints and static answers
    added_loss: np.ndarray      # the part of it in the damping of static answers

    @property
    def imbalance(self):
        """Largest error of the balance over the largest energy that has passed through the pads; 0 without any."""
        given = self.input_work + self.normal_work + self.friction_work + self.element_work - self.damping_loss
        passed = max(abs(each).max() for each in (self.stored, self.input_work, self.normal_work, self.friction_work,
                                                  self.element_work, self.damping_loss))
        return float(abs(self.stored - given).max() / passed) if passed else 0.0


def energy_balance(system, modal, start, basis, history, time, displacement, velocity):
    """EnergyBalance of a motion ``displacement``, ``velocity`` (m, k) of ``modal`` at ``time`` (m,).

    ``modal``: PadSystem in the coordinates of ``basis`` (n, k) about ``start`` (n,) of ``system``, as of
    ``preloaded_modes``; ``history``: ContactHistory of the motion. Elements that remember need every step.
    """
    held = basis.T @ (system.stiffness @ start)
    structural = basis.T @ system.damping @ basis
    kinetic, strain = _form(modal.mass, velocity) / 2, _form(modal.stiffness, displacement) / 2
    powers = (*history.power[:2], _element_power(modal, time, displacement, velocity), history.power[2],
              _form(modal.damping, velocity), _form(modal.damping - structural, velocity))
    passed = [scipy.integrate.cumulative_trapezoid(power, time, initial=0) for power in powers]
    return EnergyBalance(kinetic + strain + displacement @ held, displacement @ (basis.T @ system.load), *passed)


def _form(matrix, motion):
    """(m,): x^T A x of the rows of ``motion`` (m, k)."""
    return ((motion @ matrix) * motion).sum(axis=1)


def _element_power(system, time, displacement, velocity):
    """(m,) W of the elements of a PadSystem on its coordinates."""
    if not system.elements.offset.size:
        return np.zeros(len(time))
    step = float(time[1] - time[0]) if len(time) > 1 else 0.0
    return _along(begun(system, displacement[0], step)[0], time, displacement, velocity)


@njit
def _along(system, time, displacement, velocity):
    power = np.zeros(time.size)
    for k in range(time.size):
        for e in range(system.elements.offset.size):
            force = element_at(system, e, time[k], displacement[k], velocity[k])[0]
            power[k] -= force * (system.elements.rows[e] @ velocity[k])
        if k > 0:
            accept_elements(system, time[k], displacement[k], velocity[k])
    return power
