"""A coarse pin on disc for stage tests, from given summits to the reduced model."""

from functools import cache

from pipeline.contract import Context
from pipeline.physics.numerics.sparse_solver import available
from stages.interface_law import Settings as LawSettings
from stages.interface_law import interface_law
from stages.pin_on_disc import Settings as PinSettings
from stages.pin_on_disc import pin_on_disc
from stages.reduced_model import Settings as ModelSettings
from stages.reduced_model import reduced_model

CONTEXT = Context(solver=available()[0])
SUMMITS = {"kind": "given", "density": "2.5e9 1/m^2", "mean": "0.4 um", "spread": "0.5 um", "curvature": "2.2e4 1/m",
           "curvature_spread": 0.4, "correlation": 0.3}
COARSE = {"disc": {"radial_cells": 5, "angular_cells": 24, "axial_cells": 1}, "pin": {"axial_cells": 12},
          "frequency_max": "6 kHz", "lengths": ["146.5 mm"]}


@cache
def small_law():
    """InterfaceLaw of given summits."""
    return interface_law(None, LawSettings(summits=SUMMITS, pressure_steps=8), context=CONTEXT)


def small_pin(**changes):
    """PinOnDisc of a coarse mesh; ``changes`` replace sections or join them."""
    merged = {**COARSE, **{k: {**COARSE.get(k, {}), **v} if isinstance(v, dict) else v for k, v in changes.items()}}
    return pin_on_disc(small_law(), PinSettings(**merged), context=CONTEXT)


@cache
def small_system():
    """(PinOnDisc, ReducedModel) of the coarse mesh."""
    system = small_pin()
    return system, reduced_model(system, ModelSettings(fixed_below="6 kHz", residual_below="100 kHz"), context=CONTEXT)
