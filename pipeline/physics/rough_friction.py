"""Friction of a rough pair over its sliding distance: normal contact, shear limit, wear and flash heat together.

One call of ``slide`` is one nominal pressure and one relative position of the two patches. Speed acts through the shear
limit alone, so the contact is solved once for all speeds and the shear once for each.
"""

from dataclasses import dataclass

import numpy as np

from pipeline.physics.flash_temperature import ThermalSolid, spot_heating
from pipeline.physics.layered_solid import SurfaceCompliance
from pipeline.physics.rough_contact import contact_area, interface_stiffness, solve_normal_contact
from pipeline.physics.shear_limit import full_slip_displacement, limit_at_speed, solve_shear_limit
from pipeline.physics.wear import run_in


@dataclass(frozen=True)
class RoughPair:
    """Two rough solids: heights (ny, nx) in m outwards, ``spacing`` (dy, dx) in m, ``compliance`` of both together."""

    pad_height: np.ndarray
    disc_height: np.ndarray
    spacing: tuple
    compliance: SurfaceCompliance


@dataclass(frozen=True)
class Wearing:
    """Cycles of ``distance`` m each, ``stroke`` in nodes, wear coefficients in m^2/N."""

    cycles: int
    distance: float
    stroke: int
    pad_coefficient: float
    disc_coefficient: float


@dataclass(frozen=True)
class Shearing:
    """Shear ``limit`` (Pa) at ``reference_speed`` (m/s), its rate and softening (1/K) coefficients, heat paths."""

    limit: float
    reference_speed: float
    rate: float
    softening: float
    pad: ThermalSolid
    disc: ThermalSolid


@dataclass(frozen=True)
class Solving:
    """Tolerance (share of the rms gap and of the largest limit) and iteration bound of the contact solves."""

    tolerance: float
    max_iterations: int


@dataclass(frozen=True)
class SlidingRecord:
    """What one run tells at each speed and recorded distance, arrays (speeds, records); maps (ny, nx) new and worn."""

    friction: np.ndarray
    real_area: np.ndarray
    approach: np.ndarray
    largest_wear: np.ndarray
    normal_stiffness: np.ndarray
    flash_temperature: np.ndarray
    full_slip_distance: np.ndarray
    limit_at_speed: np.ndarray
    contact_pressure_new: np.ndarray
    contact_pressure_worn: np.ndarray
    pad_wear: np.ndarray
    disc_wear: np.ndarray


#: fields of a SlidingRecord that vary over the recorded distances
RECORDED = ("friction", "real_area", "approach", "largest_wear", "normal_stiffness", "flash_temperature",
            "full_slip_distance", "limit_at_speed")

#: imposed displacement of steady sliding over that of full slip
FAR = 100.0


def slide(pair, mean_pressure, speeds, recorded, wearing, shearing, solving):
    """SlidingRecord under ``mean_pressure`` (Pa) at ``speeds`` (m/s) after each of the ``recorded`` cycles (rising)."""
    figures, pressures = [], []
    states = run_in(pair.pad_height, pair.disc_height, pair.compliance.normal, mean_pressure, **vars(wearing),
                    **vars(solving))
    for cycle, worn in enumerate(states):
        if cycle in recorded:
            record, pressure = _measure(worn, pair, mean_pressure, speeds, wearing.stroke, shearing, solving)
            figures.append(record)
            pressures.append(pressure)
    table = {name: np.stack([record[name] for record in figures], axis=-1) for name in RECORDED}
    return SlidingRecord(**table, contact_pressure_new=pressures[0], contact_pressure_worn=pressures[-1],
                         pad_wear=worn.pad_wear, disc_wear=worn.disc_wear)


def _measure(worn, pair, mean_pressure, speeds, stroke, shearing, solving):
    """Figures per speed of one state, mean over the slider's positions, and the contact pressure at the first.

    The interface stiffness is the mean over the first, the middle and the last position.
    """
    contacts = _pass(worn, pair, mean_pressure, stroke, solving)
    stiffness = np.mean([interface_stiffness(worn.gap(position), pair.compliance.normal, contacts[position],
                                             **vars(solving)) for position in {0, stroke // 2, stroke}])
    sheared = [[_shear(c.pressure, speed, pair, shearing, solving) for speed in speeds] for c in contacts]
    figures = {name: np.mean([[f[name] for f in row] for row in sheared], axis=0) for name in sheared[0][0]}
    same = {"approach": np.mean([c.approach for c in contacts]), "normal_stiffness": stiffness,
            "largest_wear": max(worn.pad_wear.max(), worn.disc_wear.max())}
    figures |= {name: np.full(len(speeds), value) for name, value in same.items()}
    return figures, contacts[0].pressure


def _pass(worn, pair, mean_pressure, stroke, solving):
    """Contact of the worn surfaces at every position of one pass of the slider."""
    contacts, pressure = [], None
    for position in range(stroke + 1):
        contact = solve_normal_contact(worn.gap(position), pair.compliance.normal, mean_pressure, pressure,
                                       **vars(solving))
        contacts.append(contact)
        pressure = contact.pressure
    return contacts


def _shear(pressure, speed, pair, shearing, solving):
    """Friction, real area and heat of one contact at one speed.

    The nodal limit carries the perimeter correction: limit * corrected area / counted area. The bases are displaced by
    ``FAR`` times what full slip takes, so that all slip is along x; that no node sticks is the solution's finding.
    """
    touching = pressure > 0.0
    counted, area = contact_area(touching)
    heating = area / counted * spot_heating(touching, pair.spacing, shearing.pad, shearing.disc, speed)
    limit = limit_at_speed(shearing.limit, speed, shearing.reference_speed, shearing.rate, shearing.softening, heating)
    nodal = np.where(touching, limit * area / counted, 0.0)
    slip = full_slip_displacement(nodal, pair.compliance)
    imposed = FAR * (slip + pair.compliance.along[0, 0] * nodal.mean())
    shear = solve_shear_limit(nodal, pair.compliance, imposed, **vars(solving))
    return {"friction": shear.traction[0].sum() / pressure.sum(), "real_area": area,
            "flash_temperature": heating * limit, "full_slip_distance": slip, "limit_at_speed": limit}
