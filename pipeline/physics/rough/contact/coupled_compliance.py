"""Normal compliance of a pair that slides: the shear of its spots lifts the surfaces in front of them and lowers them
behind where the two bodies differ (Dundurs' second constant), which changes where they touch.

The shear follows from the pressure; what it closes of the gap gives the next pressure, until that stays.
"""

from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.rough.contact.normal_contact import apply, uniform

#: most rounds, and those after which the shear of a round is the mean of all since: nodes that touch and open in turn
_ROUNDS, _PLAIN = 100, 12


@dataclass(frozen=True, eq=False)
class CoupledCompliance:
    """``normal`` (ny, nx // 2 + 1) in m/Pa or a CompositeCompliance; ``lift`` of the pair's SurfaceCompliance;
    ``sheared(pressure)``: traction (ny, nx) in Pa along x on the first body. Takes the place of an array of compliance
    in a contact."""

    normal: object
    lift: np.ndarray
    sheared: object

    @property
    def whole(self):
        """The normal compliance of bodies of one modulus each."""
        return self.normal if isinstance(self.normal, np.ndarray) else self.normal.whole

    @property
    def uniform(self):
        """Mean displacement in m by a pressure of 1 Pa all over."""
        return uniform(self.normal)

    def settled(self, solve, gap, start, tolerance):
        """The contact ``solve(gap, compliance, start)`` on the ``gap`` (ny, nx) m of the sliding pair: what shear
        closes changes by less than ``tolerance`` times the rms of the gap, root mean square. Raises ConvergenceError.
        """
        scale, shear = gap.std(), None
        closed = np.zeros_like(gap)
        for turn in range(_ROUNDS):
            contact = solve(gap - closed, self.normal, start)
            new, kept = self.sheared(contact.pressure), max(turn + 1 - _PLAIN, 1)
            shear = new if kept == 1 else shear + (new - shear) / kept
            closer = apply(self.lift, shear)
            change, closed, start = np.sqrt(np.mean((closer - closed) ** 2)), closer, contact.pressure
            if change <= tolerance * scale:
                return contact
        raise ConvergenceError("normal contact under shear", f"a gap that settles to {tolerance:g} rms within {_ROUNDS}"
                               " rounds", f"{change / scale:.2g}", "raise tolerance, or leave out coupling")
