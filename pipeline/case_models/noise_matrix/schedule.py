"""Schedule of a noise matrix: modules of drags and stops, from the YAML to conditions and how often each occurs.

    noise_matrix:
      schedule: j2521                       # built in: j2521, j3211; or a file like theirs. Or modules of one's own:
      modules:
        - {module: drags, kind: drag, speeds: [3 km/h, 10 km/h], pressures: [5 bar, 10 bar], temperatures: [50 degC]}
        - {module: stops, kind: stop, speeds: [50 km/h], ends: 0 km/h, pressures: [20 bar], count: 10}
"""

from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Literal

import numpy as np

from pipeline.contract import ConfigError, NamedFile, Quantities, Quantity, Section, option
from pipeline.contract.documents import read_yaml
from pipeline.contract.settings import annotated, fill, without_origins

DRAG, STOP = "drag", "stop"
#: signs of the speed by the direction of a module
DIRECTIONS = {"forward": (1,), "reverse": (-1,), "both": (1, -1)}


class Module(Section):
    """One module of a schedule: every speed with every pressure, temperature and direction, ``count`` times."""

    module: str = option(..., "its name", min_length=1)
    kind: Literal["drag", "stop"] = option(..., "drag: at constant speed; stop: from a speed to that of its end")
    direction: Literal["forward", "reverse", "both"] = option("forward", "direction in which the wheel turns")
    speeds: Quantities("m/s", gt=0) = option(..., "speeds of the vehicle; of stops those at which they begin")
    ends: Quantity("m/s", ge=0) = option("0 m/s", "speed at which a stop ends")
    pressures: Quantities("Pa", gt=0) = option(..., "pressures in the brake line")
    temperatures: Quantities("K", gt=0) = option(
        ("100 degC",), "temperatures of the disc at the begin; they act where friction_map.bulk_temperatures"
        " are stated")
    count: int = option(1, "applications of each combination", ge=1)

    @property
    def applications(self):
        """Number of brake applications."""
        several = len(self.speeds) * len(self.pressures) * len(self.temperatures)
        return several * len(DIRECTIONS[self.direction]) * self.count


#: type of a setting that names a built-in schedule, or a file like theirs
NamedSchedule = NamedFile(Path(__file__).parent)


class Published(Section):
    """What is publicly known of a test procedure."""

    sections: int = option(0, "number of its sections; 0 = not known", ge=0)
    applications: int = option(0, "number of its brake applications; 0 = not known", ge=0)
    source: str = option("", "where that is stated")


class ScheduleFile(Section):
    """A file with a schedule."""

    title: str = option(..., "its title")
    published: Published = option({}, "what is publicly known of the procedure")
    not_available: str = option("", "what of the procedure was not available")
    modules: tuple[Module, ...] = option(..., "its modules", min_length=1)


@dataclass(frozen=True)
class Condition:
    """What a brake application is to the model: ``kind``, ``pressure`` Pa in the line, ``speed`` and ``end`` m/s of the
    vehicle, negative in reverse; a drag ends at its speed. ``temperature`` K, 0 where it does not act."""

    kind: str
    pressure: float
    speed: float
    end: float
    temperature: float = 0.0

    def speeds(self, points):
        """(p,) m/s at which it is solved: of a drag its speed, of a stop the middles of ``points`` equal steps."""
        if self.kind == DRAG:
            return np.array([self.speed])
        return self.speed + (np.arange(points) + 0.5) / points * (self.end - self.speed)


@dataclass(frozen=True)
class Schedule:
    """A schedule: ``title``, ``modules``, ``published``, what was ``not_available``, ``origins`` (module, setting,
    value, origin, source) of its values where it states them, and c ``conditions`` with the ``applications`` (m, c) of
    each in every module."""

    title: str
    modules: tuple
    published: Published
    not_available: str
    origins: tuple
    conditions: tuple
    applications: np.ndarray


def schedule(file, modules=(), temperature_acts=False):
    """Schedule of the ``modules``, or else of a ``file``; temperatures make conditions of their own where they act.

    ConfigError for a file that is none, modules of one name, and stops that do not slow down.
    """
    told, origins = (ScheduleFile(title="of this case", modules=modules), ()) if modules else _file(file)
    names = [module.module for module in told.modules]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise ConfigError("noise_matrix.schedule", "modules of different names", ", ".join(twice))
    for module in told.modules:
        if module.kind == STOP and module.ends >= min(module.speeds):
            raise ConfigError(f"noise_matrix.schedule: {module.module}.ends", "less than its speeds",
                              f"{module.ends:g} m/s")
    counts = [_conditions(module, temperature_acts) for module in told.modules]
    conditions = sorted({c for one in counts for c in one}, key=_order)
    table = np.array([[one.get(condition, 0) for condition in conditions] for one in counts])
    return Schedule(told.title, told.modules, told.published, told.not_available, origins, tuple(conditions), table)


def _file(path):
    """(ScheduleFile, origins) of a file."""
    document = read_yaml(path)
    filled = fill(ScheduleFile, without_origins(document, str(path)), str(path))
    modules = document.get("modules")
    origins = tuple((str(module.get("module", "")), key, str(value["value"]).strip("[]"), value.get("origin", ""),
                     value.get("source", ""))
                    for module in (modules if isinstance(modules, list) else ()) if isinstance(module, dict)
                    for key, value in module.items() if annotated(value))
    return filled, origins


def _order(condition):
    return (condition.kind, -np.sign(condition.speed), abs(condition.speed), condition.pressure, abs(condition.end),
            condition.temperature)


def _conditions(module, temperature_acts):
    """{Condition: number of applications} of a Module."""
    found = {}
    for sign, speed, pressure, temperature in product(DIRECTIONS[module.direction], module.speeds, module.pressures,
                                                      module.temperatures):
        end = speed if module.kind == DRAG else module.ends
        condition = Condition(module.kind, pressure, sign * speed, sign * end,
                              temperature if temperature_acts else 0.0)
        found[condition] = found.get(condition, 0) + module.count
    return found
