"""Normal contact of rough solids of which one yields: the pressure of a node is capped at its hardness.

Elastic, perfectly plastic: where nodes at the hardness overlap, the overlap is flattened for good (Almqvist et al.,
Wear 262 (2007) 1350). The flattened surfaces carry the same pressures elastically.
"""

from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import ConfigError, ConvergenceError
from pipeline.physics.numerics.accelerated_gradients import ahead_of
from pipeline.physics.rough.contact.normal_contact import NormalContact, apply, solve_normal_contact

#: most steps to the level of the pressures, and the error of their mean at which they end
_LEVELS, _EXACT = 100, 1e-14


@dataclass(frozen=True)
class YieldingContact(NormalContact):
    """The NormalContact with ``flattened`` (ny, nx) in m: by how much nodes at the hardness yielded."""

    flattened: np.ndarray


def solve_yielding_contact(gap, compliance, mean_pressure, start=None, tolerance=1e-6, max_iterations=2000,
                           hardness=np.inf):
    """YieldingContact under ``mean_pressure`` with no pressure above ``hardness``, both in Pa.

    Minimises p C p / 2 + g p over maps 0 <= p <= hardness of this mean: accelerated projected gradients from the
    elastic solution, which ends it where that nowhere yields. The remaining gap of bearing nodes, overlap of open ones
    and gap of yielding ones are below ``tolerance`` times the rms of ``gap``; otherwise ConvergenceError. Other
    arguments and errors as of ``solve_normal_contact``.
    """
    if mean_pressure >= hardness:
        raise ConfigError("normal contact: hardness", f"more than the pressure, {mean_pressure:g} Pa",
                          f"{hardness:g} Pa", "lower the pressure; a softer body is pressed flat")
    if not isinstance(compliance, np.ndarray):
        return compliance.settled(lambda gap, alike, start: solve_yielding_contact(
            gap, alike, mean_pressure, start, tolerance, max_iterations, hardness), gap, start, tolerance)
    elastic = solve_normal_contact(gap, compliance, mean_pressure, start, tolerance, max_iterations)
    if elastic.pressure.max() <= hardness:
        return YieldingContact(**vars(elastic), flattened=np.zeros_like(gap))
    bend, scale = 1.0 / compliance.ravel()[1:].max(), gap.std()
    pressure = _projected(elastic.pressure, mean_pressure, hardness)
    ahead, momentum = pressure, 1.0
    for iteration in range(max_iterations):
        new = _projected(ahead - bend * (gap + apply(compliance, ahead)), mean_pressure, hardness)
        distance = gap + apply(compliance, new)
        approach, error = _judged(distance, new, hardness)
        if error < tolerance * scale:
            return YieldingContact(new, approach, elastic.iterations + iteration,
                                   np.where(new >= hardness, np.maximum(approach - distance, 0.0), 0.0))
        ahead, momentum = ahead_of(new, pressure, ahead, momentum)
        pressure = new
    raise ConvergenceError("normal contact", f"a gap error of {tolerance:g} rms within {max_iterations} iterations",
                           f"{error / scale:.2g}", "raise max_iterations or tolerance")


def _projected(pressure, mean, hardness):
    """The nearest map between 0 and the hardness with this ``mean``: shifted by one level, and cut.

    The mean rises with the level along a piecewise straight line: Newton's rule, kept within what encloses the level.
    """
    low, high, level = -pressure.max(), hardness - pressure.min(), 0.0
    for _ in range(_LEVELS):
        shifted = pressure + level
        cut = np.clip(shifted, 0.0, hardness)
        missing = mean - cut.mean()
        if abs(missing) <= _EXACT * mean:
            break
        low, high = (level, high) if missing > 0.0 else (low, level)
        slope = np.count_nonzero((shifted > 0.0) & (shifted < hardness)) / pressure.size
        level = level + missing / slope if slope else low
        if not low < level < high:
            level = (low + high) / 2.0
    return cut


def _judged(distance, pressure, hardness):
    """(approach, largest violation in m) of a pressure map with the ``distance`` (ny, nx) that it leaves."""
    yields, opened = pressure >= hardness, pressure <= 0.0
    bears = ~yields & ~opened
    approach = distance[bears].mean() if bears.any() else distance[yields].max()
    left = distance - approach
    return approach, max(np.abs(left[bears]).max(initial=0.0), -left[opened].min(initial=0.0),
                         left[yields].max(initial=0.0))
