"""Running-in of a rough pair: Archard wear on both surfaces while the slider (disc) passes over the pad.

A cycle stands for ``distance`` of sliding at one position of the slider. The slider advances by one grid node per cycle
and returns to its start after ``stroke`` nodes, so that every position of the pass meets the same number of cycles.
What yields in a cycle stays flattened.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from pipeline.physics.rough.contact.yielding_contact import solve_yielding_contact


@dataclass(frozen=True)
class WornPair:
    """Worn surfaces after some cycles: heights (ny, nx) in m outwards of pad and disc, each on its own grid.

    Heights are without wear, which is told apart, and with what has yielded. ``met``: by position of the slider the
    last cycle there, the pressure (ny, nx) in Pa that it met and its change per cycle.
    """

    pad_height: np.ndarray
    disc_height: np.ndarray
    pad_wear: np.ndarray
    disc_wear: np.ndarray
    met: dict = field(default_factory=dict, compare=False, repr=False)

    def gap(self, position):
        """Distance (ny, nx) in m of the undeformed surfaces when the slider has moved by ``position`` nodes along x."""
        return -(self.pad_height - self.pad_wear) - np.roll(self.disc_height - self.disc_wear, position, axis=1)

    def expected(self, position):
        """Pressure (ny, nx) in Pa at a ``position`` where what was met there goes on to change as it did; None of a
        position that was not met."""
        if position not in self.met:
            return None
        cycle, pressure, change = self.met[position]
        now = 1 + max(last for last, *_ in self.met.values())
        return pressure + (now - cycle) * change

    def meeting(self, position, cycle, pressure):
        """``met`` with the ``pressure`` of a ``cycle``."""
        before, last, _ = self.met.get(position, (cycle - 1, pressure, None))
        return self.met | {position: (cycle, pressure, (pressure - last) / (cycle - before))}

    def after(self, contact, position, yielding):
        """The WornPair in which the body ``yielding`` (pad or disc) is flattened as by a YieldingContact there."""
        if not contact.flattened.any():
            return self
        if yielding == "pad":
            return replace(self, pad_height=self.pad_height - contact.flattened)
        return replace(self, disc_height=self.disc_height - np.roll(contact.flattened, -position, axis=1))


def archard(pressure, distance, coefficient):
    """Wear depth in m of each node: coefficient (m^2/N) * pressure (Pa) * sliding distance (m) (Archard 1953)."""
    return coefficient * pressure * distance


def run_in(pad_height, disc_height, compliance, mean_pressure, *, cycles, distance, stroke, pad_coefficient,
           disc_coefficient, tolerance, max_iterations, hardness=np.inf, yielding="pad"):
    """Yield the WornPair at the start and after each cycle: ``cycles`` + 1 states.

    ``compliance`` (ny, nx // 2 + 1) in m/Pa is the normal one of both solids; the pressure of a cycle is that at its
    start; the softer body, ``yielding``, has this ``hardness`` in Pa. ConvergenceError when a contact solve does not
    converge.
    """
    pair = WornPair(pad_height, disc_height, np.zeros_like(pad_height), np.zeros_like(disc_height))
    pressure = None
    yield pair
    for cycle in range(cycles):
        position = cycle % (stroke + 1)
        start = pair.expected(position)
        contact = solve_yielding_contact(pair.gap(position), compliance, mean_pressure,
                                         pressure if start is None else start, tolerance, max_iterations, hardness)
        pressure, pair = contact.pressure, pair.after(contact, position, yielding)
        pad_wear = pair.pad_wear + archard(pressure, distance, pad_coefficient)
        disc_wear = pair.disc_wear + archard(np.roll(pressure, -position, axis=1), distance, disc_coefficient)
        pair = replace(pair, pad_wear=pad_wear, disc_wear=disc_wear, met=pair.meeting(position, cycle, pressure))
        yield pair
