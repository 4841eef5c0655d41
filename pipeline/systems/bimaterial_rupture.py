"""Two plates of unlike solids under pressure and shear, with a nucleation zone in the middle of their interface.

Meziane and Baillet, section 3: the lower plate (solid 2, the slower one) is shifted under the upper one (solid 1).
"""

from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.closed_form.wave_speeds import Solid, checked
from pipeline.physics.rupture.dynamics import Interface, pairing, positions
from pipeline.physics.rupture.plate_grid import ABSORBING, FIXED, FREE, Plate, plate
from pipeline.physics.rupture.preload import Preload, solve_preload

#: fewest elements on the nucleation zone
FEWEST = 2


@dataclass(frozen=True)
class Parameters:
    """All that defines a rupture, in SI units."""

    upper: Solid
    lower: Solid
    length: float
    height: float                   # of each plate
    upper_spacing: float
    lower_spacing: float
    damping_share: float            # stiffness damping over spacing / dilatational speed
    absorbing_sides: bool
    absorbing_far: bool             # False: the far edges are held
    static_friction: float
    dynamic_friction: float
    weakening_slip: float           # > 0
    memory_time: float              # 0 = none
    memory_slip: float              # 0 = none
    nucleation_length: float
    pressure: float
    ratio: float                    # shear over pressure
    solved_preload: bool            # False: uniform tractions
    ratio_of_forces: bool = False   # solved preload: the ratio of the forces, not of the tractions in the middle
    solver: str = "superlu"


@dataclass(frozen=True)
class Rupturing:
    """The built system."""

    lower: Plate
    upper: Plate
    interface: Interface
    x: np.ndarray                   # (s,) m, nodes of the interface
    centre: float                   # m
    half_width: float               # m, half of the nucleation zone
    preload: Preload | None


def build(parameters):
    """Rupturing; ConfigError for a pre-stress above slip, a nucleation zone too small, or no wave speeds."""
    p = parameters
    refuse(p)
    side, far = ABSORBING if p.absorbing_sides else FREE, ABSORBING if p.absorbing_far else FIXED
    sides, inner, outer = [(side, side)] * 2, (FREE, FREE), (far, far)
    lower, upper = (plate(solid, p.length, p.height, spacing, p.damping_share, [*sides, *rows], f"rupture.{name}")
                    for name, solid, spacing, rows in (("lower", p.lower, p.lower_spacing, (outer, inner)),
                                                       ("upper", p.upper, p.upper_spacing, (inner, outer))))
    master, weight, above, length = pairing(lower, upper)
    x, centre = positions(upper if above else lower), 0.5 * p.length
    half_width = 0.5 * p.nucleation_length * (1.0 + 1e-9)
    acting = np.abs(x - centre) > half_width
    preload = None
    pressure, shear, gap = np.full(x.size, p.pressure), np.full(x.size, p.ratio * p.pressure), np.zeros(x.size)
    if p.solved_preload:
        preload = solve_preload(lower, upper, p.static_friction, p.pressure, p.ratio, p.solver, p.ratio_of_forces)
        pressure, shear, gap = np.maximum(preload.pressure, 0.0), preload.shear, preload.gap
    interface = Interface(pressure, shear, gap, p.static_friction * acting, p.dynamic_friction * acting,
                          p.weakening_slip, p.memory_time, p.memory_slip, length, master, weight, above)
    return Rupturing(lower, upper, interface, x, centre, half_width, preload)


def refuse(parameters):
    """ConfigError for parameters from which nothing can be built; computes nothing."""
    p = parameters
    for name, solid in (("upper", p.upper), ("lower", p.lower)):
        checked(solid, f"rupture.{name}")
    if not 0.0 <= p.ratio < p.static_friction:
        raise ConfigError("rupture.stress_ratio", f"shear over pressure from 0 to below the static friction"
                          f" {p.static_friction:g}", f"{p.ratio:g}", "a pre-stress above slip has no static state")
    if p.damping_share < 0.0:
        raise ConfigError("rupture.damping_share", "zero or more", f"{p.damping_share:g}")
    if p.dynamic_friction > p.static_friction:
        raise ConfigError("rupture.friction.dynamic", f"at most the static friction {p.static_friction:g}",
                          f"{p.dynamic_friction:g}")
    if p.solved_preload and p.lower_spacing != p.upper_spacing:
        raise ConfigError("rupture.lower_spacing", "matched interface nodes for a solved preload",
                          f"{p.lower_spacing:g} m against {p.upper_spacing:g} m", "choose the uniform preload")
    coarsest = max(p.upper_spacing, p.lower_spacing)
    if p.nucleation_length < FEWEST * coarsest * (1.0 - 1e-9):
        raise ConfigError("rupture.nucleation_length", f"{FEWEST} or more elements of {coarsest:g} m",
                          f"{p.nucleation_length:g} m", "lengthen the zone or refine the mesh")
    if p.nucleation_length >= p.length:
        raise ConfigError("rupture.nucleation_length", f"less than the length {p.length:g} m",
                          f"{p.nucleation_length:g} m")
