"""Running-in of a rough pair: Archard wear on both surfaces while the slider (disc) passes over the pad.

A cycle stands for ``distance`` of sliding at one position of the slider. The slider advances by one grid node per cycle
and returns to its start after ``stroke`` nodes, so that every position of the pass meets the same number of cycles.
"""

from dataclasses import dataclass

import numpy as np

from pipeline.physics.rough_contact import NormalContact, solve_normal_contact


@dataclass(frozen=True)
class WearState:
    """The pair at the start of one cycle, everything on the pad's grid (ny, nx).

    ``gap`` of the undeformed worn surfaces in m, its ``contact`` solution, wear of both in m (``disc_wear`` on the disc's
    own grid) and the ``position`` of the slider in nodes.
    """

    cycle: int
    position: int
    gap: np.ndarray
    contact: NormalContact
    pad_wear: np.ndarray
    disc_wear: np.ndarray


def archard(pressure, distance, coefficient):
    """Wear depth in m of each node: coefficient (m^2/N) * pressure (Pa) * sliding distance (m) (Archard 1953)."""
    return coefficient * pressure * distance


def run_in(pad_height, disc_height, compliance, mean_pressure, *, cycles, distance, stroke, pad_coefficient,
           disc_coefficient, tolerance, max_iterations):
    """Yield a WearState at the start of each cycle and after the last: ``cycles`` + 1 states.

    Heights (ny, nx) in m point out of their solids; ``compliance`` (ny, nx // 2 + 1) is the normal one of both solids.
    The pressure of a cycle is that at its start. ConvergenceError when a contact solve does not converge.
    """
    pad_wear, disc_wear = np.zeros_like(pad_height), np.zeros_like(disc_height)
    start = None
    for cycle in range(cycles + 1):
        position = cycle % (stroke + 1)
        gap = -(pad_height - pad_wear) - np.roll(disc_height - disc_wear, position, axis=1)
        contact = solve_normal_contact(gap, compliance, mean_pressure, start, tolerance, max_iterations)
        yield WearState(cycle, position, gap, contact, pad_wear, disc_wear)
        start = contact.pressure
        pad_wear = pad_wear + archard(start, distance, pad_coefficient)
        disc_wear = disc_wear + archard(np.roll(start, -position, axis=1), distance, disc_coefficient)
