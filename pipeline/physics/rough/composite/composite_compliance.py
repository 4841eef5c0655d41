"""Normal compliance of a pair of which one body is a composite block: contact solved by correction of one modulus.

What the composite gives more than a block of one modulus under the same pressure, w = (S - S_1) p, is added to the
gap; the contact of bodies of one modulus there gives the pressure again, until w stays. The steps are those of Anderson
(D. G. Anderson, J. ACM 12 (1965) 547).
"""

from dataclasses import dataclass, field, replace

import numpy as np
import scipy

from pipeline.contract.errors import ConvergenceError
from pipeline.physics.rough.composite.composite_block import CompositeBlock
from pipeline.physics.rough.contact.normal_contact import apply

#: earlier steps that the next one draws on, and most of them
_MEMORY, _STEPS = 6, 60
#: error of a displacement of the block over that of the correction
_FINER = 0.1


@dataclass(frozen=True, eq=False)
class CompositeCompliance:
    """``whole`` (ny, nx // 2 + 1) in m/Pa: normal compliance of both bodies, the composite one as of one modulus,
    ``alike``; ``block``: that body as it is. Takes the place of an array of compliance in a contact."""

    whole: np.ndarray
    alike: np.ndarray
    block: CompositeBlock
    last: dict = field(default_factory=dict, compare=False, repr=False)      # where the next solution begins

    @property
    def uniform(self):
        """Mean displacement in m by a pressure of 1 Pa all over."""
        if "uniform" not in self.last:
            self.last["uniform"] = float(self.whole[0, 0] + self.correction(np.ones(self.block.factor.shape[1:]), 1e-5,
                                                                            None)[0].mean())
        return self.last["uniform"]

    def correction(self, pressure, tolerance, start):
        """(w (ny, nx) in m, displacement of the block) under a ``pressure`` in Pa."""
        moved = self.block.under(pressure, start, tolerance)
        return moved[0, ..., 2] - apply(self.alike, pressure), moved

    def settled(self, solve, gap, start, tolerance):
        """The contact ``solve(gap, compliance, start)`` on the ``gap`` (ny, nx) m of the composite pair: the correction
        changes by less than ``tolerance`` times the rms of the gap. Raises ConvergenceError."""
        scale, found = gap.std(), {"pressure": start, "moved": self.last.get("moved"), "error": 1.0}

        def change(correction):
            contact = solve(gap + correction, self.whole, found["pressure"])
            finer = _FINER * max(tolerance, min(found["error"], _FINER))
            new, moved = self.correction(contact.pressure, finer, found["moved"])
            found.update(pressure=contact.pressure, moved=moved, contact=contact,
                         error=np.abs(new - correction).max() / scale)
            return new - correction

        begin = self.last.get("correction", np.zeros_like(gap))
        if np.abs(change(begin)).max() > tolerance * scale:
            try:
                begin = scipy.optimize.anderson(change, begin, M=_MEMORY, maxiter=_STEPS, alpha=1.0,
                                                f_tol=tolerance * scale, line_search=None)
            except scipy.optimize.NoConvergence as error:
                raise ConvergenceError("normal contact of a composite",
                                       f"a correction that settles within {_STEPS} steps", "none",
                                       "lower the contrast of the moduli, or raise tolerance") from error
        self.last.update(correction=begin, moved=found["moved"])
        return found["contact"]

    def shifted(self, offset):
        """The compliance with the composite block shifted by ``offset`` (y, x) in nodes."""
        return replace(self, block=self.block.shifted(offset), last={})
