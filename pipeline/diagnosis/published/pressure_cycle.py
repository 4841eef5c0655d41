"""A bench's cycle of pressure at constant power: which modes grow in it, when, and whether they have time to be heard.

Roots are those of steady sliding at the pressure, speed and temperature of each instant: the load changes slowly beside
a squeal. From one instant at which a mode begins to grow to the one at which it ceases, its amplitude rises by

    ln(a_1 / a_0) = int growth rate dt.

Friction at a temperature T is that of the friction map over 1 + d (T - T_0), thermal fade in a steady state
(``effects/friction/thermal_fade.py``).
"""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from pipeline.contract import Quantities, Quantity, Section, option
from pipeline.diagnosis.published.line_tests import grouped
from pipeline.physics.sliding.model import FrictionState
from pipeline.physics.stability.draws.whole_roots import whole_roots

_TWO_PI = 2 * np.pi
_FIELDS = ("cycle_time", "cycle_pressure", "cycle_speed", "cycle_hypothesis", "cycle_draw", "cycle_temperature",
           "cycle_friction", "cycle_root", "cycle_root_cycle", "cycle_root_phase", "still_pressure", "still_root",
           "still_root_cycle", "still_root_pressure", "swell_cycle", "swell_frequency", "swell_growth", "swell_phase",
           "swell_phases", "swell")


class Cycle(Section):
    """A cycle of pressure p = middle + amplitude sin(2 pi f t) at constant power."""

    frequency: Quantity("Hz", gt=0) = option("0.5 Hz", "frequency of the pressure")
    low: Quantity("Pa", gt=0) = option("1 MPa", "lowest pressure")
    high: Quantity("Pa", gt=0) = option("3 MPa", "highest pressure")
    speed: Quantity("rad/s", gt=0) = option("8.5 rad/s", "speed at the highest pressure")
    phases: int = option(16, "instants of a cycle, an even number", ge=8, multiple_of=2)
    temperatures: Quantities("K", gt=0) = option(("423 K", "523 K"), "temperatures of the disc")
    reference_temperature: Quantity("K", gt=0) = option("293 K", "temperature of the friction map")
    fade: Quantity("1/K", ge=0) = option("5e-4 1/K", "d above: as the shear limit falls in micro_friction.softening")
    audible: float = option(60.0, "rise of a vibration from noise to audible squeal, dB", gt=0)

    @property
    def time(self):
        """(phases,) s: the middles of equal parts of a cycle."""
        return (np.arange(self.phases) + 0.5) / self.phases / self.frequency

    @property
    def pressure(self):
        """(phases,) Pa at these instants."""
        middle, amplitude = (self.high + self.low) / 2, (self.high - self.low) / 2
        return middle + amplitude * np.sin(_TWO_PI * self.frequency * self.time)

    def share(self, temperature):
        """Friction at a temperature in K over that of the map."""
        return 1 / (1 + self.fade * (temperature - self.reference_temperature))


@dataclass(frozen=True)
class Swelling:
    """A mode that grows without break from the phase ``first`` over so many ``phases``: its mean ``frequency`` Hz, its
    largest growth rate ``growth`` 1/s and the ``rise`` of its amplitude, ln(a_1 / a_0)."""

    frequency: float
    growth: float
    first: int
    phases: int
    rise: float


def faded(family, load, share):
    """Family under other forces of its inputs, ``load`` (i,) N, with a ``share`` of its friction."""
    return replace(family, input_force=load, friction=partial(_shared, family.friction, share))


def _shared(law, share, pressure, speed):
    state = law(pressure, speed)
    return FrictionState(*(share * part for part in (state.coefficient, state.pressure_slope, state.speed_slope)))


def no_cycle():
    """Fields of LineEvidence where no cycle is asked for."""
    return {name: np.empty(0, complex if name.endswith("root") else float) for name in _FIELDS} | {"cycle_audible": 0.0}


def cycle_fields(cycle, family, area, tried, still, highest, apart, spread):
    """Fields of LineEvidence of a Cycle.

    ``family``: Family of the brake under any load, whose inputs have the ``area`` (i,) m^2; ``tried``: [(row of a
    hypothesis, draw, Factors)]; ``still``: (pressures Pa, speeds rad/s) of the test at constant load; ``highest`` Hz
    limits the modes, modes within the share ``apart`` of their frequency are one; ``spread``: as ``Context.map``.
    """
    cycles = [(row, draw, factors, kelvin) for row, draw, factors in tried for kelvin in cycle.temperatures]
    points = np.unique(cycle.pressure.round(3))
    levels, phase_level = np.append(points, still[0]), np.searchsorted(points, cycle.pressure.round(3))
    speeds = np.append(cycle.speed * cycle.high / points, still[1])
    tasks = [(faded(family, p * area, cycle.share(kelvin)), factors, speed) for *_, factors, kelvin in cycles
             for p, speed in zip(levels, speeds, strict=True)]
    solved = spread(partial(_growing, highest), tasks, "cycle of pressure")
    by_level = [solved[k:k + len(levels)] for k in range(0, len(solved), len(levels))]
    phases = [[of[k] for k in phase_level] for of in by_level]
    constant = [of[len(points):] for of in by_level]
    swells = [(k, s) for k, of in enumerate(phases) for s in swellings(of, 1 / cycle.frequency, apart)]
    return {
        "cycle_time": cycle.time, "cycle_pressure": cycle.pressure,
        "cycle_speed": cycle.speed * cycle.high / cycle.pressure,
        "cycle_audible": cycle.audible * np.log(10) / 20, "cycle_hypothesis": [c[0] for c in cycles],
        "cycle_draw": [c[1] for c in cycles], "cycle_temperature": [c[3] for c in cycles],
        "cycle_friction": [cycle.share(c[3]) for c in cycles], **_listed("cycle_root", "phase", phases),
        "still_pressure": still[0], **_listed("still_root", "pressure", constant),
        "swell_cycle": [k for k, _ in swells], "swell_frequency": [s.frequency for _, s in swells],
        "swell_growth": [s.growth for _, s in swells], "swell_phase": [s.first for _, s in swells],
        "swell_phases": [s.phases for _, s in swells], "swell": [s.rise for _, s in swells]}


def _listed(name, axis, roots):
    """Fields of ``roots`` [cycle][point] (r,), end to end."""
    sizes = np.array([[len(r) for r in of] for of in roots])
    cycle, point = np.indices(sizes.shape)
    return {name: np.concatenate([np.empty(0, complex), *(r for of in roots for r in of)]),
            f"{name}_cycle": np.repeat(cycle.ravel(), sizes.ravel()),
            f"{name}_{axis}": np.repeat(point.ravel(), sizes.ravel())}


def _growing(highest, task):
    """Growing roots (r,) 1/s of (Family, Factors, speed rad/s) in the whole reduced model."""
    root = whole_roots(*task, highest)
    return root[root.real > 0]


def swellings(roots, period, apart):
    """[Swelling] of growing ``roots`` [(r,)] of the phases of a cycle of ``period`` s, by falling rise.

    Roots closer than the share ``apart`` of their frequency are one mode; without a phase in which it does not grow, it
    grows for one period.
    """
    count = len(roots)
    phase = np.repeat(np.arange(count), [len(r) for r in roots])
    root = np.concatenate([np.empty(0, complex), *roots])
    frequency, swells = abs(root.imag) / _TWO_PI, []
    for group in grouped(frequency, apart):
        growth = np.zeros(count)
        np.maximum.at(growth, phase[group], root.real[group])
        for first, length in _stretches(growth > 0):
            within = (first + np.arange(length)) % count
            members = group[np.isin(phase[group], within)]
            swells.append(Swelling(float(frequency[members].mean()), float(growth[within].max()), first, length,
                                   float(growth[within].sum() * period / count)))
    return sorted(swells, key=lambda s: -s.rise)


def _stretches(grows):
    """[(first, length)] of unbroken stretches of True in (n,), which closes on itself."""
    if grows.all():
        return [(0, len(grows))]
    first = np.flatnonzero(grows & ~np.roll(grows, 1))
    return [(int(k), int(np.argmin(np.roll(grows, -k)))) for k in first]
