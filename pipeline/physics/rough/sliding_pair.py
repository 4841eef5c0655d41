"""Friction of a rough pair over its sliding distance: normal contact, shear limit, wear and flash heat together.

One call of ``slide`` is one nominal pressure and one relative position of the two patches. Speed acts through the shear
limit alone, and full slip is in proportion to that: contact and shear are solved once for all speeds.
"""

from dataclasses import dataclass, replace

import numpy as np

from pipeline.physics.friction.state_variables import Film
from pipeline.physics.rough.archard_wear import run_in
from pipeline.physics.rough.contact.coupled_compliance import CoupledCompliance
from pipeline.physics.rough.contact.normal_contact import contact_area, interface_stiffness
from pipeline.physics.rough.contact.partial_slip import presliding
from pipeline.physics.rough.contact.shear_limit import (
    film_factor,
    full_slip_displacement,
    limit_at_speed,
    solve_shear_limit,
)
from pipeline.physics.rough.contact.yielding_contact import solve_yielding_contact
from pipeline.physics.rough.flash_temperature import ThermalSolid, spot_heating
from pipeline.physics.rough.layered_solid import SurfaceCompliance


@dataclass(frozen=True)
class RoughPair:
    """Two rough solids: heights (ny, nx) in m outwards, ``spacing`` (dy, dx) in m, ``compliance`` of both together.

    ``hardness`` in Pa of the softer one, the body ``yielding`` (pad or disc); infinite where both stay elastic. Of a
    pad of several materials ``shear_factor`` and ``wear_factor`` (ny, nx) multiply shear limit and wear of its nodes,
    and the normal compliance is a CompositeCompliance. ``coupled``: the shear of the spots lifts the surfaces.
    """

    pad_height: np.ndarray
    disc_height: np.ndarray
    spacing: tuple
    compliance: SurfaceCompliance
    hardness: float = np.inf
    yielding: str = "pad"
    shear_factor: np.ndarray | float = 1.0
    wear_factor: np.ndarray | float = 1.0
    coupled: bool = False

    def with_pad_at(self, offset):
        """The pair with its pad shifted by ``offset`` (y, x) in nodes."""
        return replace(self.with_particles_at(offset), pad_height=np.roll(self.pad_height, offset, (0, 1)))

    def with_particles_at(self, offset):
        """The pair with the particles of its pad alone shifted by ``offset`` (y, x) in nodes."""
        compliance, normal = self.compliance, self.compliance.normal
        if not isinstance(normal, np.ndarray):
            compliance = replace(compliance, normal=normal.shifted(offset))
        moved = {name: np.roll(getattr(self, name), offset, (0, 1)) for name in ("shear_factor", "wear_factor")
                 if isinstance(getattr(self, name), np.ndarray)}
        return replace(self, compliance=compliance, **moved)


@dataclass(frozen=True)
class Wearing:
    """Cycles of ``distance`` m each, ``stroke`` in nodes, wear coefficients in m^2/N; below 0 a surface grows.

    Both coefficients hold at ``reference_pressure`` (Pa) and go with the nominal pressure to the power ``exponent``.
    """

    cycles: int
    distance: float
    stroke: int
    pad_coefficient: float
    disc_coefficient: float
    exponent: float = 0.0
    reference_pressure: float = 1e6

    def under(self, mean_pressure):
        """Arguments of ``run_in`` under a nominal pressure."""
        factor = (mean_pressure / self.reference_pressure) ** self.exponent
        return {"cycles": self.cycles, "distance": self.distance, "stroke": self.stroke,
                "pad_coefficient": factor * self.pad_coefficient, "disc_coefficient": factor * self.disc_coefficient}


@dataclass(frozen=True)
class Shearing:
    """Shear ``limit`` (Pa) at ``reference_speed`` (m/s), its rate and softening (1/K) coefficients, heat paths.

    The limit of a node rises by ``pressure_coefficient`` times its contact pressure, that of all by a ``film``.
    """

    limit: float
    reference_speed: float
    rate: float
    softening: float
    pad: ThermalSolid
    disc: ThermalSolid
    pressure_coefficient: float = 0.0
    film: Film | None = None

    def after(self, mean_pressure, distance):
        """The same with the film that ``distance`` m of sliding under a nominal pressure have left."""
        if self.film is None:
            return self
        factor = film_factor(self.film, mean_pressure, distance)
        return replace(self, limit=factor * self.limit, pressure_coefficient=factor * self.pressure_coefficient)


@dataclass(frozen=True)
class Solving:
    """Tolerance (share of the rms gap and of the largest limit) and iteration bound of the contact solves."""

    tolerance: float
    max_iterations: int


@dataclass(frozen=True)
class Rubbing:
    """A rough pair with its laws of wear and shear: what physics on the scale of the roughness changes."""

    pair: RoughPair
    wearing: Wearing
    shearing: Shearing
    solving: Solving


@dataclass(frozen=True)
class Drag:
    """A run on a rubbing bench: one nominal ``pressure`` (Pa), speeds (n,) in m/s and ways (n,) in m of its points."""

    pressure: float
    speed: np.ndarray
    distance: np.ndarray


@dataclass(frozen=True)
class Maps:
    """Maps (records, ny, nx) of one run: ``contact_pressure`` in Pa where the slider starts, heights in m outwards of
    the worn surfaces, and their wear in m."""

    contact_pressure: np.ndarray
    pad_height: np.ndarray
    disc_height: np.ndarray
    pad_wear: np.ndarray
    disc_wear: np.ndarray


@dataclass(frozen=True)
class SlidingRecord:
    """What one run tells at each speed and recorded distance, arrays (speeds, records); ``maps`` of each record."""

    friction: np.ndarray
    real_area: np.ndarray
    approach: np.ndarray
    largest_wear: np.ndarray
    normal_stiffness: np.ndarray
    flash_temperature: np.ndarray
    full_slip_distance: np.ndarray
    limit_at_speed: np.ndarray
    yielding_area: np.ndarray
    maps: Maps | None


#: fields of a SlidingRecord that vary over the recorded distances
RECORDED = ("friction", "real_area", "approach", "largest_wear", "normal_stiffness", "flash_temperature",
            "full_slip_distance", "limit_at_speed", "yielding_area")

#: imposed displacement of steady sliding over that of full slip
FAR = 100.0


def slide(rubbing, mean_pressure, speeds, recorded):
    """SlidingRecord of a Rubbing under ``mean_pressure`` (Pa) at ``speeds`` (m/s) after the ``recorded`` cycles."""
    figures, maps = [], []
    for cycle, worn in enumerate(states(rubbing, mean_pressure)):
        if cycle in recorded:
            shearing = rubbing.shearing.after(mean_pressure, cycle * rubbing.wearing.distance)
            record, pressure = _measure(worn, replace(rubbing, shearing=shearing), mean_pressure, speeds)
            figures.append(record)
            maps.append((pressure, worn.pad_height - worn.pad_wear, worn.disc_height - worn.disc_wear, worn.pad_wear,
                         worn.disc_wear))
    table = {name: np.stack([record[name] for record in figures], axis=-1) for name in RECORDED}
    return SlidingRecord(**table, maps=Maps(*map(np.array, zip(*maps, strict=True))))


def states(rubbing, mean_pressure):
    """WornPairs of a Rubbing under ``mean_pressure`` (Pa): at the start and after each cycle."""
    pair, wearing = rubbing.pair, rubbing.wearing.under(mean_pressure)
    wearing["pad_coefficient"] = wearing["pad_coefficient"] * pair.wear_factor
    return run_in(pair.pad_height, pair.disc_height, _normal(rubbing), mean_pressure, **wearing,
                  **vars(rubbing.solving), hardness=pair.hardness, yielding=pair.yielding)


def from_rest(rubbing, mean_pressure, speed, shares):
    """Presliding of new surfaces at ``shares`` of the displacement of full slip, the limit as at a ``speed`` (m/s)."""
    pair, shearing = rubbing.pair, rubbing.shearing
    gap = -pair.pad_height - pair.disc_height
    pressure = solve_yielding_contact(gap, _normal(rubbing), mean_pressure, **vars(rubbing.solving),
                                      hardness=pair.hardness).pressure
    area, _, heating = spots(pressure, pair, shearing, [speed])
    limit = nodal_limit(pressure, rubbing, spot_limit(shearing, mean_pressure, area, speed, heating[0]))
    return presliding(limit, pair.compliance, shares, **vars(rubbing.solving))


def _normal(rubbing):
    """Normal compliance of a Rubbing; of a coupled pair under the shear of its spots at the reference speed."""
    compliance, shearing = rubbing.pair.compliance, rubbing.shearing
    if not rubbing.pair.coupled:
        return compliance.normal

    def sheared(pressure):
        area = contact_area(pressure > 0.0)[1]
        return nodal_limit(pressure, rubbing, shearing.limit + shearing.pressure_coefficient * pressure.mean() / area)

    return CoupledCompliance(compliance.normal, compliance.lift, sheared)


def passed(rubbing, worn, mean_pressure):
    """YieldingContacts of a WornPair at every position of one pass of the slider."""
    contacts, pressure, normal = [], None, _normal(rubbing)
    for position in range(rubbing.wearing.stroke + 1):
        start = worn.expected(position)
        contact = solve_yielding_contact(worn.gap(position), normal, mean_pressure,
                                         pressure if start is None else start, **vars(rubbing.solving),
                                         hardness=rubbing.pair.hardness)
        contacts.append(contact)
        pressure = contact.pressure
    return contacts


def spots(pressure, pair, shearing, speeds):
    """(real area share, corrected for its perimeter; counted share; heating of the spots (speeds,) in K/Pa)."""
    touching = pressure > 0.0
    counted, area = contact_area(touching)
    heating = spot_heating(touching, pair.spacing, shearing.pad, shearing.disc, speeds)
    return area, counted, area / counted * heating


def spot_limit(shearing, mean_pressure, area, speed, heating):
    """Mean shear limit in Pa of spots that share ``mean_pressure`` (Pa) at ``speed`` (m/s); arrays are welcome."""
    pressed = shearing.limit + shearing.pressure_coefficient * mean_pressure / area
    return limit_at_speed(pressed, speed, shearing.reference_speed, shearing.rate, shearing.softening, heating)


def _measure(worn, rubbing, mean_pressure, speeds):
    """Figures per speed of one state, mean over the slider's positions, and the contact pressure at the first.

    The interface stiffness is the mean over the first, the middle and the last position, elastic where nodes yielded.
    """
    contacts, stroke = passed(rubbing, worn, mean_pressure), rubbing.wearing.stroke
    stiffness = np.mean([interface_stiffness(
        worn.gap(position) + contacts[position].flattened, _normal(rubbing), contacts[position],
        **vars(rubbing.solving)) for position in {0, stroke // 2, stroke}])
    sheared = [_sheared(c.pressure, speeds, rubbing) for c in contacts]
    figures = {name: np.mean([of[name] for of in sheared], axis=0) for name in sheared[0]}
    same = {"approach": np.mean([c.approach for c in contacts]), "normal_stiffness": stiffness,
            "largest_wear": max(worn.pad_wear.max(), worn.disc_wear.max()),
            "yielding_area": np.mean([np.mean(c.pressure >= rubbing.pair.hardness) for c in contacts])}
    figures |= {name: np.full(len(speeds), value) for name, value in same.items()}
    return figures, contacts[0].pressure


def _sheared(pressure, speeds, rubbing):
    """Friction, real area and heat of one contact, arrays (speeds,).

    The bases are displaced by ``FAR`` times what full slip takes, so that all slip is along x; that no node sticks is
    the solution's finding. Shear and displacement go in proportion to the limit, and are those of 1 Pa times that of
    each speed.
    """
    shearing, compliance = rubbing.shearing, rubbing.pair.compliance
    area, _, heating = spots(pressure, rubbing.pair, shearing, speeds)
    limit = spot_limit(shearing, pressure.mean(), area, np.asarray(speeds), heating)
    nodal = nodal_limit(pressure, rubbing, 1.0)
    slip = full_slip_displacement(nodal, compliance)
    imposed = FAR * (slip + compliance.along[0, 0] * nodal.mean())
    shear = solve_shear_limit(nodal, compliance, imposed, **vars(rubbing.solving))
    return {"friction": limit * (shear.traction[0].sum() / pressure.sum()), "real_area": np.full_like(limit, area),
            "flash_temperature": heating * limit, "full_slip_distance": limit * slip, "limit_at_speed": limit}


def nodal_limit(pressure, rubbing, limit):
    """Shear limit (ny, nx) in Pa of the nodes under a contact ``pressure`` whose spots have the mean ``limit``.

    It carries the perimeter correction: limit * corrected area / counted area. A node that is pressed harder bears more
    (``pressure_coefficient``); that needs no correction, because its sum is that of the pressures.
    """
    counted, area = contact_area(pressure > 0.0)
    shearing, share = rubbing.shearing, 1.0
    if shearing.pressure_coefficient != 0.0:
        rise = shearing.pressure_coefficient * pressure
        share = (shearing.limit + rise * counted / area) / (shearing.limit + rise.mean() / area)
    return np.where(pressure > 0.0, share * limit * area / counted, 0.0) * rubbing.pair.shear_factor
