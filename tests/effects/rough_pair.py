"""A small rough pair, on which every effect of the micro scale can be seen."""

from functools import cache

import numpy as np

from pipeline.physics.rough.flash_temperature import ThermalSolid
from pipeline.physics.rough.generator import self_affine
from pipeline.physics.rough.layered_solid import graded_depth, layered_compliance
from pipeline.physics.rough.sliding_pair import Drag, RoughPair, Rubbing, Shearing, Solving, Wearing, slide

NODES, LENGTH, CYCLES = 24, 1e-3, 4
PAD, DISC = 4e-12, 4e-13        # m^2/N
LIMIT = 13.5e6                  # Pa
SPEEDS = np.array([1.0, 1.6])
#: what the effects are sized for
DRAG = Drag(2e6, SPEEDS, np.array([0.0, CYCLES * 2e-3]))


@cache
def rubbing(rate=0.015, softening=5e-4):
    """The Rubbing; without ``rate`` and ``softening`` its friction is limit times area over pressure."""
    spacing = (LENGTH / NODES,) * 2
    pad, disc = (3e-6 * self_affine(np.random.default_rng(s), NODES, LENGTH, 2.5e-4, 5e-4, 0.8) for s in (1, 2))
    solids = [layered_compliance((NODES, NODES), spacing, graded_depth(spacing[0], LENGTH, 1.5), *data)
              for data in ((0.3e9, 0.25), (110e9, 0.26))]
    shearing = Shearing(LIMIT, 1.3, rate, softening, ThermalSolid(1.0, 2200.0, 1000.0),
                        ThermalSolid(50.0, 7200.0, 500.0))
    return Rubbing(RoughPair(pad, disc, spacing, solids[0] + solids[1]), Wearing(CYCLES, 2e-3, 1, PAD, DISC), shearing,
                   Solving(1e-5, 2000))


def rubbed(pair, pressure=2e6):
    """SlidingRecord of a Rubbing at the begin and at the end."""
    return slide(pair, pressure, SPEEDS, [0, CYCLES])
