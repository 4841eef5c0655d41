"""Small ruptures for tests: two plates of the paper's solids under uniform pre-stress."""

import numpy as np

from pipeline.physics.closed_form.wave_speeds import Solid
from pipeline.physics.rupture.dynamics import Interface, pairing, positions
from pipeline.physics.rupture.plate_grid import ABSORBING, FIXED, FREE, plate

STIFF, SOFT = Solid(5.3e9, 0.25, 1246.0), Solid(3.392e9, 0.25, 1246.0)


def plates(spacing=5e-5, lower_spacing=None, length=8e-3, height=2.5e-3, damping=0.1, solids=(SOFT, STIFF),
           absorbing=False):
    """(lower, upper), far edges held and side edges free, or all of them absorbing."""
    side, far = ((ABSORBING,) * 2,) * 2 if absorbing else ((FREE, FREE), (FIXED, FIXED))
    inner = FREE, FREE
    return (plate(solids[0], length, height, lower_spacing or spacing, damping, [side, side, far, inner]),
            plate(solids[1], length, height, spacing, damping, [side, side, inner, far]))


def interface(lower, upper, ratio=0.94, friction=1.0, half_width=6.25e-5, pressure=1e6, memory_time=0.0, dynamic=None,
              weakening=1.0):
    """Uniform pre-stress, friction zero within ``half_width`` of the middle; (Interface, x)."""
    master, weight, above, length = pairing(lower, upper)
    x = positions(upper if above else lower)
    acting = np.abs(x - 0.5 * x[-1]) > half_width * (1 + 1e-9)
    uniform = np.full(x.size, pressure)
    return Interface(uniform, ratio * uniform, 0.0 * uniform, friction * acting,
                     (friction if dynamic is None else dynamic) * acting, weakening, memory_time, 0.0, length, master,
                     weight, above), x
