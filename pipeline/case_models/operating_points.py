"""Operating points of complex_modes and what the system is linearised with there, as later stages go on from them; and
how variants of a case are computed there."""

import json
from dataclasses import dataclass, fields
from typing import Literal, Self

import numpy as np

from pipeline.products import ComplexModes

#: settings of variants that compare modes at operating points: the reduced model alone, no sweep over friction
MODES_ALONE = {"complex_modes.friction_steps": 2, "complex_modes.residual_tolerance": None,
               "complex_modes.followed": 0}
#: slip speed over which stated friction falls, where a case does not say
DECAY_SPEED = "10 mm/s"
#: type of the setting ``speeds`` of such a stage
Speeds = Literal["all", "middle"]


@dataclass(frozen=True)
class StabilitySettings:
    """The section ``complex_modes`` that a product ComplexModes was computed with, in SI units: ``speeds`` rad/s,
    ``decay_speed`` and ``damping_speed`` m/s, ``sliding_distance`` m, ``frequency_max`` and ``squeal_from`` Hz."""

    speeds: tuple[float, ...]
    friction: float | None
    friction_at_rest: float | None
    decay_speed: float
    friction_max: float
    friction_steps: int
    frequency_max: float
    smallest_correction: float
    sliding_distance: float
    friction_slopes: bool
    friction_damping: bool
    damping_speed: float
    hysteretic: bool
    gyroscopic: bool
    centrifugal: bool
    residual_tolerance: float | None
    followed: int
    squeal_from: float
    neutral: float

    @classmethod
    def of(cls, modes: ComplexModes) -> Self:
        """Of a product ComplexModes."""
        given = json.loads(str(modes.settings))
        given["speeds"] = tuple(given["speeds"])
        return cls(**{field.name: given[field.name] for field in fields(cls)})


def middle_speed(speeds):
    """Middle one of ``speeds``, each of which may occur more than once; the faster of two."""
    different = np.unique(speeds)
    return float(different[len(different) // 2])


def selected_speeds(which, speeds):
    """[speed] of ``speeds`` that the setting ``which`` names."""
    return [middle_speed(speeds)] if which == "middle" else list(speeds)
