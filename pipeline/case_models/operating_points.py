"""Operating points that a stage takes out of those of complex_modes: all of them, or those of the middle speed; and how
variants of a case are computed there."""

from typing import Literal

import numpy as np

#: settings of variants that compare modes at operating points: the reduced model alone, no sweep over friction
MODES_ALONE = {"complex_modes.friction_steps": 2, "complex_modes.residual_tolerance": None,
               "complex_modes.followed": 0}
#: type of the setting ``speeds`` of such a stage
Speeds = Literal["all", "middle"]


def middle_speed(speeds):
    """Middle one of ``speeds``, each of which may occur more than once; the faster of two."""
    different = np.unique(speeds)
    return float(different[len(different) // 2])


def selected_speeds(which, speeds):
    """[speed] of ``speeds`` that the setting ``which`` names."""
    return [middle_speed(speeds)] if which == "middle" else list(speeds)
